#include <execute/device_limits.hpp>

#include <postfx/error.hpp>

#include <postfx_glad/gl.h>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace postfx {
namespace {

GLint limit(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

void expect_at_most(const Pass& pass, std::size_t wanted, std::size_t most, std::string_view of_what) {
    if (wanted <= most) return;
    throw Error(Place{.effect = pass.name},
                fmt::format("wants {} {}, this device has at most {}", wanted, of_what, most));
}

} // namespace

DeviceLimits device_limits() {
    GLint viewport[2] = {};
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    return {.texture_side = limit(GL_MAX_TEXTURE_SIZE),
            .viewport_width = viewport[0],
            .viewport_height = viewport[1],
            .textures = static_cast<std::size_t>(limit(GL_MAX_TEXTURE_IMAGE_UNITS)),
            .outputs = static_cast<std::size_t>(limit(GL_MAX_DRAW_BUFFERS)),
            .uniform_bytes = static_cast<std::size_t>(limit(GL_MAX_UNIFORM_BLOCK_SIZE))};
}

void check_limits(const Plan& plan, const DeviceLimits& limits) {
    for (const Pass& pass : plan.passes) {
        const auto expect_side = [&](int wanted, int most) {
            expect_at_most(pass, static_cast<std::size_t>(wanted), static_cast<std::size_t>(most), "pixels");
        };
        expect_side(pass.width, std::min(limits.texture_side, limits.viewport_width));
        expect_side(pass.height, std::min(limits.texture_side, limits.viewport_height));
        expect_at_most(pass, pass.inputs.size(), limits.textures, "textures");
        expect_at_most(pass, pass.outputs.size(), limits.outputs, "outputs");
        expect_at_most(pass, pass.uniform_block.size(), limits.uniform_bytes, "bytes of uniforms");
    }
}

} // namespace postfx
