// Reckoning with when passes are drawn.
#pragma once

#include <postfx/plan.hpp>

#include <cstdint>
#include <optional>

namespace postfx {

/// Where both hold; nothing if they never do.
std::optional<Condition> both(const Condition& a, const Condition& b);

/// Does it hold when the decisions of the bits of `live` are for their effects and all others against?
bool holds(const Condition& condition, std::uint32_t live);

} // namespace postfx
