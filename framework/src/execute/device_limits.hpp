// What a device can do, as far as plans depend on it.
#pragma once

#include <postfx/plan.hpp>

#include <cstddef>

namespace postfx {

struct DeviceLimits {
    int texture_side = 0;                        ///< pixels
    int viewport_width = 0, viewport_height = 0; ///< pixels
    std::size_t textures = 0;                    ///< that one pass may read
    std::size_t outputs = 0;                     ///< that one pass may write
    std::size_t uniform_bytes = 0;               ///< of one pass
};

/// Of the current context.
DeviceLimits device_limits();

/// Throws Error with the first pass that the device can't draw, what it wants and what the device has at most.
void check_limits(const Plan& plan, const DeviceLimits& limits);

} // namespace postfx
