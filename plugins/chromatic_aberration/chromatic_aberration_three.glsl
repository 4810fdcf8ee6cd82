#include "chromatic_aberration_axis.glsl"
#include "chromatic_aberration_light.glsl"

// Red and blue from images of another size, green as it is.
vec3 chromatic_aberration_three(vec3 color, vec2 uv, float red, float blue, sampler2D picture) {
    vec2 from_axis = uv - chromatic_aberration_axis();
    return chromatic_aberration_light(vec3(textureLod(picture, uv + from_axis * red, 0.0).r, color.g,
                                           textureLod(picture, uv + from_axis * blue, 0.0).b));
}
