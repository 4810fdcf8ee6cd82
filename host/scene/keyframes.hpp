// Key frames of a model's own animation.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace postfx::host {

/// Values over time. Before the first key and after the last one they stay.
struct Track {
    enum class Interpolation : std::uint8_t { step, linear, cubic };
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t width = 3;  ///< numbers per key
    std::vector<float> times; ///< seconds, growing, at least one
    /// `width` numbers per key; cubic (glTF's CUBICSPLINE): incoming tangent, value and outgoing tangent of each.
    std::vector<float> values;

    /// The value at that time; a rotation (x, y, z, w) turns the shorter way at a steady pace.
    std::vector<float> at(double time, bool rotation = false) const;
};

/// What a model's animation does to a node.
struct NodeKeys {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
    std::optional<Track> translations, rotations, scales, shape_weights;
    double duration = 0; ///< seconds, of the whole animation; then it begins again

    /// Node to parent.
    glm::dmat4 local(double time) const;
    /// `time` within the duration. Its very end is the end, not the start again.
    double looped(double time) const;
};

/// That matrix taken apart, without any tracks.
NodeKeys keys_at_rest(const glm::dmat4& local);

} // namespace postfx::host
