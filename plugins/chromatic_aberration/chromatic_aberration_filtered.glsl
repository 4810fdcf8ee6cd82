#include <postfx/numeric.glsl>

// The picture at a place between pixels, by the sampler's filter. Where that meets what is not light, which is rare, the
// four pixels are held to light before they are weighed.
vec3 chromatic_aberration_filtered(vec2 uv, sampler2D picture) {
    vec3 sum = textureLod(picture, uv, 0.0).rgb;
    // A loop, since a branch may cost its whole length where no pixel takes it.
    int repairs = postfx_is_light(sum) ? 0 : 4;
    for (int i = 0; i < repairs; ++i) {
        ivec2 last = textureSize(picture, 0) - 1;
        vec2 place = uv * vec2(last + 1) - 0.5, at = floor(place) + vec2(i & 1, i >> 1), weight = 1.0 - abs(place - at);
        vec3 light = postfx_light(texelFetch(picture, clamp(ivec2(at), ivec2(0), last), 0).rgb);
        sum = (i == 0 ? vec3(0.0) : sum) + weight.x * weight.y * light;
    }
    return sum;
}
