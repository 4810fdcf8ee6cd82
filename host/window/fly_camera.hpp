// A camera that flies: WASD and the mouse.
#pragma once

#include <postfx/camera.hpp>

#include <glm/glm.hpp>

namespace postfx::host {

/// What the pilot does in one frame.
struct Steering {
    glm::dvec3 move{0}; ///< right, up, forward; each -1, 0 or 1
    glm::dvec2 turn{0}; ///< degrees to the right and upwards
    bool fast = false;
};

class FlyCamera {
public:
    /// Starts where `camera` is and looks where it looks, without its roll.
    FlyCamera(const Camera& camera, double metres_per_second);

    void steer(const Steering& steering, double seconds);
    /// Has it left its start?
    bool moved() const { return moved_; }

    /// The camera with its own projection.
    Camera camera() const;

private:
    glm::dvec3 forward() const;

    Camera start_;
    double metres_per_second_;
    glm::dvec3 position_;
    double yaw_, pitch_; ///< degrees; yaw 0 looks along -z, positive to the right
    bool moved_ = false;
};

} // namespace postfx::host
