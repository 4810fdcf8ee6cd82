// What stands in for an engine: a context and a loader of its own, and nothing of postfx.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace engine {

/// Makes an EGL context of OpenGL 4.5 without a display current on this thread, and loads functions for it. False where
/// there is none.
bool start();
/// How this engine's window system finds a GL function.
void* get_proc_address(const char* name);
/// An rgba32f texture of these pixels, bottom row first.
std::uint32_t make_texture(int width, int height, const std::vector<float>& pixels);
/// Level 0 as 8-bit codes, bottom row first.
std::vector<unsigned char> read_codes(std::uint32_t texture, int width, int height);
/// The first GL error since the last call; 0 = none.
unsigned take_error();

/// The renderer's name as other loaders that are linked beside it see it; "" where they are not installed.
std::string renderer_by_glew();
std::string renderer_by_epoxy();

} // namespace engine
