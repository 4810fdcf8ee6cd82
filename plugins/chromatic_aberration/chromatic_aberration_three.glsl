#include "chromatic_aberration_axis.glsl"
#include "chromatic_aberration_filtered.glsl"

// Red and blue from images of another size, green as it is.
vec3 chromatic_aberration_three(vec3 color, vec2 uv, float red, float blue, sampler2D picture) {
    vec2 from_axis = uv - chromatic_aberration_axis();
    return postfx_light(vec3(chromatic_aberration_filtered(uv + from_axis * red, picture).r, color.g,
                             chromatic_aberration_filtered(uv + from_axis * blue, picture).b));
}
