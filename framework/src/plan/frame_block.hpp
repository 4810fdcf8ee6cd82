// The numbers of a frame, as shaders/postfx/prelude.glsl declares them at binding 0.
#pragma once

#include <postfx/camera.hpp>

#include <cstdint>

namespace postfx {

/// std140 layout of `Frame`. Time, frame, seed and view_to_world change from frame to frame, the others with the plan
/// only.
struct FrameBlock {
    float size[2], inverse_size[2];
    float depth_affine[2];
    float sky_depth, near_plane;
    float half_extent[2];
    std::int32_t orthographic;
    float time;
    std::uint32_t frame, seed;
    float principal_point[2];
    float view_to_world[16];
};
static_assert(sizeof(FrameBlock) == 128);

/// Of a picture of that size; time, frame and seed are 0.
FrameBlock frame_block(int width, int height, const Camera& camera);

} // namespace postfx
