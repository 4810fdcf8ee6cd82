// What the user means by SCENE.
#pragma once

#include "scene/scene.hpp"

#include <string>

namespace postfx::host {

/// What the user means by SCENE, its models read in a process of their own. What they could not bring along is told on
/// stderr, one line for each kind; `strict`: refused instead. Throws Error.
Scene open_known_scene(const std::string& scene, bool strict = false, const std::string& camera = {});

} // namespace postfx::host
