#include "warnings.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace postfx::host {

void tell_lines(const std::string& file, const std::vector<std::string>& lines, bool quiet) {
    if (quiet) return;
    for (const std::string& line : lines)
        fmt::print(stderr, "postfx: {}: {}\n", file, line);
}

void tell_or_refuse(const std::string& file, const std::vector<std::string>& warnings, bool strict) {
    if (strict && !warnings.empty())
        throw Error(Place{.file = file}, warnings.front() + " (refused: --strict)");
    tell_lines(file, warnings, false);
}

} // namespace postfx::host
