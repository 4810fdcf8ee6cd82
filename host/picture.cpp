#include "picture.hpp"

#include "resources.hpp"

#include <gl/clock.hpp>
#include <gl/objects.hpp>
#include <image/alpha.hpp>
#include <image/files.hpp>

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace postfx::host {
namespace {

/// The first `channels` of each pixel.
Image first_channels(const Image& image, int channels) {
    if (image.channels == channels) return image;
    Image result(image.width, image.height, channels);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        std::copy_n(&image.values[image.channels * i], channels, &result.values[channels * i]);
    }
    return result;
}

std::filesystem::path program_cache() {
    const std::filesystem::path cache = cache_directory();
    return cache.empty() ? cache : cache / "programs";
}

} // namespace

ChainRunner::ChainRunner(Chain chain, Facts facts, const std::map<std::string, Format>& formats)
    : chain_(std::move(chain)), facts_(std::move(facts)), plan_(planner_.plan(chain_, facts_)),
      executor_(program_cache()) {
    std::vector<Format> of_attachments;
    if (!formats.empty()) {
        for (const std::string& name : plan_.attachments)
            of_attachments.push_back(formats.at(name));
    }
    executor_.prepare(plan_, of_attachments);
}

void ChainRunner::replan(const Facts& facts) {
    Plan plan = planner_.plan(chain_, facts);
    executor_.prepare(plan);
    plan_ = std::move(plan);
    facts_ = facts;
}

std::uint32_t ChainRunner::run(const Textures& textures, const FrameInputs& frame, Timing timing,
                               Watch watch) {
    inputs_.textures.clear();
    for (const std::string& name : plan_.attachments)
        inputs_.textures.push_back(textures.at(name));
    inputs_.camera = frame.camera;
    inputs_.time = frame.time;
    inputs_.frame = frame.frame;
    inputs_.seed = frame.seed;
    return executor_.run(inputs_, timing, watch);
}

Output output_for(const PictureFile& file) {
    check_writable_kind(file.path, file.kind);
    // 16 bits are encoded on the CPU, from floats: they need no dither.
    return is_display_kind(file.path, file.kind) && file.bits == 8 ? Output::display : Output::linear;
}

bool divides_by_alpha(const PictureFile& file, const Written& written) {
    return output_for(file) == Output::display && written.alpha_of_chain == Coding::Alpha::premultiplied
           && written.alpha_of_file == Coding::Alpha::straight;
}

std::vector<std::string> write_picture(ChainRunner& runner, const PictureFile& file, const Written& written) {
    const bool keeps_alpha =
        written.alpha_of_chain != Coding::Alpha::none && written.alpha_of_file != Coding::Alpha::none;
    Image picture = first_channels(runner.executor().read_picture(), keeps_alpha ? 4 : 3);
    WriteOptions options;
    options.kind = file.kind;
    options.bits = file.bits;
    options.quality = file.quality;
    if (written.origin.source) options.origin = &written.origin;
    if (runner.facts().output == Output::linear) {
        if (keeps_alpha)
            picture = with_alpha(std::move(picture), written.alpha_of_chain, written.alpha_of_file);
        return write_image(file.path, picture, options);
    }
    BasicImage<std::uint8_t> codes(picture.width, picture.height, picture.channels);
    std::transform(picture.values.begin(), picture.values.end(), codes.values.begin(),
                   [](float code) { return static_cast<std::uint8_t>(std::lround(code * 255.0f)); });
    write_codes(file.path, codes, options);
    return {};
}

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
