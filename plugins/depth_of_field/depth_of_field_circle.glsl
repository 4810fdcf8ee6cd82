#include <postfx/depth.glsl>
#include <postfx/numeric.glsl>

// Signed diameter of the circle of confusion [px], negative in front of the focus plane. lens: scale and offset of
// the raw depth sample, value at the sky, largest magnitude. A sample that is not a number counts as in focus.
float depth_of_field_circle(float depth, vec4 lens) {
    float circle = postfx_is_sky(depth) ? lens.z : depth * lens.x + lens.y;
    return clamp(postfx_finite_or(circle, lens.w), -lens.w, lens.w);
}
