#include "progress_bar.hpp"

#include <gl/clock.hpp>

#include <fmt/format.h>

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace postfx::host {

ProgressBar::ProgressBar(std::string what, int total)
    : what_(std::move(what)), total_(total), start_seconds_(gl::HostTime::now().wall_ms / 1000),
      terminal_(isatty(fileno(stderr)) != 0) {
    draw();
}

ProgressBar::~ProgressBar() {
    if (terminal_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::advance() {
    ++done_;
    draw();
}

void ProgressBar::draw() const {
    if (!terminal_) return;
    constexpr int width = 32;
    const int filled = total_ > 0 ? width * done_ / total_ : 0;
    const double elapsed = gl::HostTime::now().wall_ms / 1000 - start_seconds_;
    const std::string left =
        done_ > 0 ? fmt::format("{:.0f} s left", elapsed / done_ * (total_ - done_)) : std::string("...");
    fmt::print(stderr, "\r\033[K{} [{:#<{}}{:.<{}}] {}/{}  {}", what_, "", filled, "", width - filled, done_,
               total_, left);
    std::fflush(stderr);
}

} // namespace postfx::host
