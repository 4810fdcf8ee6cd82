// Errors of C libraries that leave through longjmp (libpng, libjpeg).
#pragma once

#include <image/formats.hpp>

#include <csetjmp>
#include <string>

namespace postfx::formats {

/// Where the library's error handler jumps to, and what it wanted to say.
struct JumpTarget {
    std::jmp_buf place;
    std::string message{};
};

/// Do `work`, which calls the library; false if its error handler jumped. Nothing that `work` itself makes may have a
/// destructor: it would not be run.
template<class Work>
bool done_without_jump(JumpTarget& target, Work work) {
    if (setjmp(target.place)) return false;
    work();
    return true;
}

} // namespace postfx::formats
