// Tests that can't run here.
#include <testing.hpp>

#include <fmt/format.h>

#include <cstdlib>

namespace postfx::testing {

bool requires_gl() {
    const char* required = std::getenv("POSTFX_REQUIRE_GL");
    return required && std::string(required) == "1";
}

int skipped(const std::string& why) {
    constexpr int skip_return_code = 77; // of the tests' CMake property
    if (requires_gl()) {
        fmt::print("failed, POSTFX_REQUIRE_GL is 1: {}\n", why);
        return 1;
    }
    fmt::print("skipped: {}\n", why);
    return skip_return_code;
}

} // namespace postfx::testing
