#include <execute/nonfinite_watch.hpp>

#include <algorithm>

namespace postfx {
namespace {

constexpr int group_side = 8;

constexpr std::string_view count_shader = R"(#version 450 core
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D u_image;
layout(location = 0) uniform uint u_slot;
struct Count {
    uint pixels;
    uint first; // y * width + x
};
layout(std430, binding = 0) buffer Counts { Count b_counts[]; };

void main() {
    ivec2 size = textureSize(u_image, 0), at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, size))) return;
    uvec4 bits = floatBitsToUint(texelFetch(u_image, at, 0)) & 0x7f800000u;
    if (any(equal(bits, uvec4(0x7f800000u)))) {
        atomicAdd(b_counts[u_slot].pixels, 1u);
        atomicMin(b_counts[u_slot].first, uint(at.y * size.x + at.x));
    }
}
)";

std::size_t image_count(const Plan& plan) {
    std::size_t count = plan.attachments.size();
    for (const Pass& pass : plan.passes)
        count += pass.outputs.size();
    return count;
}

} // namespace

NonfiniteWatch::NonfiniteWatch(const Plan& plan)
    : program_(gl::make_compute_program(count_shader, "non-finite watch")),
      counts_(gl::make_buffer(std::max<std::size_t>(1, image_count(plan)) * sizeof(NonfiniteCount), nullptr)),
      images_(image_count(plan)) {}

void NonfiniteWatch::begin_frame() {
    const std::vector<NonfiniteCount> none(images_);
    glNamedBufferSubData(counts_.name(), 0, static_cast<GLsizeiptr>(images_ * sizeof(NonfiniteCount)),
                         none.data());
    next_ = 0;
}

void NonfiniteWatch::count(GLuint texture, int width, int height) {
    glUseProgram(program_.name());
    glUniform1ui(0, static_cast<GLuint>(next_++));
    glBindTextureUnit(0, texture);
    glBindSampler(0, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, counts_.name());
    glDispatchCompute(static_cast<GLuint>((width + group_side - 1) / group_side),
                      static_cast<GLuint>((height + group_side - 1) / group_side), 1);
}

std::vector<NonfiniteCount> NonfiniteWatch::read() const {
    std::vector<NonfiniteCount> counts(images_);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(counts_.name(), 0, static_cast<GLsizeiptr>(images_ * sizeof(NonfiniteCount)),
                            counts.data());
    return counts;
}

} // namespace postfx
