#include "fly_camera.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

constexpr double fast_factor = 6;
constexpr double steepest = 89; ///< degrees; straight up, "right" would be undefined

} // namespace

FlyCamera::FlyCamera(const Camera& camera, double metres_per_second)
    : start_(camera), metres_per_second_(metres_per_second) {
    const auto& m = camera.view_to_world;
    position_ = {m[12], m[13], m[14]};
    const glm::dvec3 looks = -glm::dvec3(m[8], m[9], m[10]);
    yaw_ = glm::degrees(std::atan2(looks.x, -looks.z));
    pitch_ = glm::degrees(std::asin(std::clamp(looks.y, -1.0, 1.0)));
}

glm::dvec3 FlyCamera::forward() const {
    const double yaw = glm::radians(yaw_), pitch = glm::radians(pitch_);
    return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
}

void FlyCamera::steer(const Steering& steering, double seconds) {
    if (steering.move == glm::dvec3(0) && steering.turn == glm::dvec2(0)) return;
    moved_ = true;
    yaw_ = std::remainder(yaw_ + steering.turn.x, 360.0);
    pitch_ = std::clamp(pitch_ + steering.turn.y, -steepest, steepest);
    const glm::dvec3 ahead = forward();
    const glm::dvec3 right = glm::normalize(glm::cross(ahead, glm::dvec3(0, 1, 0)));
    const double distance = metres_per_second_ * (steering.fast ? fast_factor : 1) * seconds;
    position_ +=
        distance
        * (steering.move.x * right + steering.move.y * glm::dvec3(0, 1, 0) + steering.move.z * ahead);
}

Camera FlyCamera::camera() const {
    Camera camera = start_;
    const glm::dmat4 view_to_world =
        glm::inverse(glm::lookAt(position_, position_ + forward(), glm::dvec3(0, 1, 0)));
    std::copy_n(&view_to_world[0][0], 16, camera.view_to_world.begin());
    return camera;
}

} // namespace postfx::host
