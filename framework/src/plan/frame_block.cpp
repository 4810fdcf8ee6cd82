#include <plan/frame_block.hpp>

#include <algorithm>

namespace postfx {

FrameBlock frame_block(int width, int height, const Camera& camera) {
    const double half_height = camera.orthographic ? camera.vertical_extent / 2 : camera.tan_half_fov();
    FrameBlock block{};
    block.size[0] = static_cast<float>(width);
    block.size[1] = static_cast<float>(height);
    block.inverse_size[0] = static_cast<float>(1.0 / width);
    block.inverse_size[1] = static_cast<float>(1.0 / height);
    block.depth_affine[0] = static_cast<float>(camera.depth_scale);
    block.depth_affine[1] = static_cast<float>(camera.depth_offset);
    block.sky_depth = static_cast<float>(camera.sky_depth);
    block.near_plane = static_cast<float>(camera.near_plane);
    block.half_extent[0] = static_cast<float>(half_height * width / height);
    block.half_extent[1] = static_cast<float>(half_height);
    block.orthographic = camera.orthographic;
    block.principal_point[0] = static_cast<float>(camera.principal_point[0]);
    block.principal_point[1] = static_cast<float>(camera.principal_point[1]);
    std::copy(camera.view_to_world.begin(), camera.view_to_world.end(), block.view_to_world);
    return block;
}

} // namespace postfx
