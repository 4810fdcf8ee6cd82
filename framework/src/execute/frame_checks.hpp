// What a frame is given is looked at before anything is drawn with it: OpenGL would draw a wrong picture and say nothing.
#pragma once

#include <gl/objects.hpp>

#include <postfx/executor.hpp>

#include <functional>
#include <string>

namespace postfx {

/// Throws Error, naming the attachment, for a texture that the plan can't read: none, of another kind or size, of
/// integers, or one of `is_own`, which the plan writes to. [GL thread]
void check_textures(const Plan& plan, const std::vector<std::uint32_t>& textures,
                    const std::function<bool(std::uint32_t)>& is_own);

/// Throws Error, naming the member, for a number that is none or out of its range.
void check_camera(const Camera& camera);
void check_time(double time);

} // namespace postfx
