// Checks of numbers on the command line.
#pragma once

#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace postfx::host {

/// Neither NaN nor infinite, which CLI11's own ranges let through.
inline CLI::Validator finite() {
    return {[](std::string& text) -> std::string {
                double value = 0;
                const bool read = CLI::detail::lexical_cast(text, value);
                return read && !std::isfinite(value) ? text + " is no finite number" : std::string();
            },
            ""};
}

} // namespace postfx::host
