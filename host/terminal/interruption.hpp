// Ctrl-C as a wish: long work is stopped where it can go on later.
#pragma once

#include <csignal>

namespace postfx::host {

/// Thrown by StopOnInterrupt::check().
struct Interrupted {};

/// While it lives, the first interruption only asks to stop; a second one ends the program as ever. One at a time.
class StopOnInterrupt {
public:
    StopOnInterrupt();
    ~StopOnInterrupt();
    StopOnInterrupt(const StopOnInterrupt&) = delete;
    StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

    /// Has the last one to live been asked?
    static bool asked();
    /// Throws Interrupted if so.
    static void check();

private:
    struct sigaction before_ = {};
};

} // namespace postfx::host
