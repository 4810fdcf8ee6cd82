// What a camera can see of a scene at most: near and far, high and low, lit and shining. No OpenGL.
#pragma once

#include "moving_bounds.hpp"
#include "scene.hpp"

#include <postfx/camera.hpp>
#include <postfx/plan.hpp>

#include <glm/glm.hpp>

#include <vector>

namespace postfx::host {

/// Finds SceneBounds of frames. They hold for every pixel of SceneRenderer's attachments, in which surfaces that are
/// blended leave no depth; `empty` is of their colors, without alpha. With nothing but sky, distances and heights are
/// those of what is not known. Each mesh is looked through once, in the constructor; a frame costs microseconds.
class ViewBounds {
public:
    /// `scene` is read by every call.
    explicit ViewBounds(const Scene& scene);

    /// Of a picture of so many pixels, `time` seconds after the scene's start.
    SceneBounds at(double time, const Camera& camera, int width, int height);

private:
    /// A part of a node, as a box of the node's space.
    struct PartBox {
        std::size_t node;
        Bounds box;
        bool opaque, emits, lit_by_surroundings;
        std::shared_ptr<const MovingBounds> moving; ///< null: it keeps its shape
    };

    const Scene& scene_;
    std::vector<PartBox> boxes_;
    std::vector<glm::dmat4> nodes_; ///< of the last frame
};

} // namespace postfx::host
