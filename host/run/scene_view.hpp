// One view of a scene: its size, what is known of it before it is drawn, and its textures.
#pragma once

#include "chain_runner.hpp"

#include "scene/renderer.hpp"
#include "scene/scene.hpp"
#include "scene/view_bounds.hpp"

#include <postfx/plan.hpp>

#include <string>

namespace postfx::host {

/// "1280x720". Throws Error for anything else, or a side of 0 or above 32768.
struct Size {
    int width = 0, height = 0;
};
Size parse_size(const std::string& text);

/// What is known of a picture by a scene's own camera before it is drawn.
SceneFacts facts_of(const Scene& scene, ViewBounds& bounds, Size size, double time);

/// Put another camera into the facts, with what it can see of the scene at that time.
void look(SceneFacts& facts, ViewBounds& bounds, const Camera& camera, double time);

/// The frame's textures by attachment name.
Textures textures_of(const SceneFrame& frame);

} // namespace postfx::host
