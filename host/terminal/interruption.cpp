#include "interruption.hpp"

namespace postfx::host {
namespace {

volatile std::sig_atomic_t asked_to_stop = 0;

} // namespace

StopOnInterrupt::StopOnInterrupt() {
    asked_to_stop = 0;
    struct sigaction action = {};
    action.sa_handler = [](int) { asked_to_stop = 1; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, &before_);
}

StopOnInterrupt::~StopOnInterrupt() {
    sigaction(SIGINT, &before_, nullptr);
}

bool StopOnInterrupt::asked() {
    return asked_to_stop != 0;
}

void StopOnInterrupt::check() {
    if (asked()) throw Interrupted();
}

} // namespace postfx::host
