#include "keyframes.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

glm::dquat quaternion(const std::vector<float>& v) {
    return glm::normalize(glm::dquat(static_cast<double>(v[3]), static_cast<double>(v[0]),
                                     static_cast<double>(v[1]), static_cast<double>(v[2])));
}

/// Between two keys, each `step` numbers from the other.
void interpolate(const Track& track, std::size_t key, double seconds, double share,
                 std::vector<float>& value) {
    const std::size_t width = track.width;
    const bool cubic = track.interpolation == Track::Interpolation::cubic;
    const float* a = &track.values[key * width * (cubic ? 3 : 1)];
    const float* b = a + width * (cubic ? 3 : 1);
    const double t = share, t2 = t * t, t3 = t2 * t;
    for (std::size_t i = 0; i < width; ++i) {
        const auto number = [&](const float* from, std::size_t part) {
            return static_cast<double>(from[part * width + i]);
        };
        value[i] = static_cast<float>(
            cubic ? (2 * t3 - 3 * t2 + 1) * number(a, 1) + seconds * (t3 - 2 * t2 + t) * number(a, 2)
                        + (3 * t2 - 2 * t3) * number(b, 1) + seconds * (t3 - t2) * number(b, 0)
                  : (1 - t) * number(a, 0) + t * number(b, 0));
    }
}

glm::dvec3 vector(const std::optional<Track>& track, double time, glm::dvec3 otherwise) {
    if (!track) return otherwise;
    const std::vector<float> v = track->at(time);
    return {v[0], v[1], v[2]};
}

} // namespace

std::vector<float> Track::at(double time, bool rotation) const {
    const auto above = std::upper_bound(times.begin(), times.end(), time,
                                        [](double a, float b) { return a < static_cast<double>(b); });
    const auto after = static_cast<std::size_t>(above - times.begin());
    const std::size_t key = after == 0 ? 0 : after - 1;
    const bool cubic = interpolation == Interpolation::cubic;
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(width * (cubic ? 3 * key + 1 : key));
    std::vector<float> value(first, first + width);
    if (after == 0 || after == times.size() || interpolation == Interpolation::step) return value;
    const double begin = static_cast<double>(times[key]), seconds = static_cast<double>(times[after]) - begin;
    const double share = (time - begin) / seconds;
    if (rotation && !cubic) {
        const auto next = values.begin() + static_cast<std::ptrdiff_t>(width * after);
        const glm::dquat turned = glm::slerp(quaternion(value), quaternion({next, next + width}), share);
        return {static_cast<float>(turned.x), static_cast<float>(turned.y), static_cast<float>(turned.z),
                static_cast<float>(turned.w)};
    }
    interpolate(*this, key, seconds, share, value);
    return value;
}

double NodeKeys::looped(double time) const {
    return time <= duration || duration <= 0 ? time : std::fmod(time, duration);
}

glm::dmat4 NodeKeys::local(double time) const {
    const double at = looped(time);
    const glm::dquat turn = rotations ? quaternion(rotations->at(at, true)) : rotation;
    return glm::translate(glm::dmat4(1), vector(translations, at, translation)) * glm::mat4_cast(turn)
           * glm::scale(glm::dmat4(1), vector(scales, at, scale));
}

NodeKeys keys_at_rest(const glm::dmat4& local) {
    NodeKeys keys;
    keys.translation = glm::dvec3(local[3]);
    glm::dmat3 turn(local);
    for (int axis = 0; axis < 3; ++axis)
        keys.scale[axis] = glm::length(turn[axis]);
    if (keys.scale.x == 0 || keys.scale.y == 0 || keys.scale.z == 0) return keys; // nothing is left to turn
    if (glm::determinant(turn) < 0) keys.scale.x = -keys.scale.x;
    for (int axis = 0; axis < 3; ++axis)
        turn[axis] /= keys.scale[axis];
    keys.rotation = glm::normalize(glm::quat_cast(turn));
    return keys;
}

} // namespace postfx::host
