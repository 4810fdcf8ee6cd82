#version 450 core
// What somebody would write by hand for one picture: chromatic aberration, vignette, tone map, grain, sRGB encoding and
// dither in one shader. What a user can set is a uniform, at the effects' defaults for 1280x720 and a vertical field of
// view of 38 degrees. `postfx bench night_drive --chain configs/bench/lens_tail.yaml --against
// configs/bench/lens_tail.glsl` measures the fused chain against it and tells how far the two pictures differ.
layout(binding = 0) uniform sampler2D u_color;        // nearest
layout(binding = 1) uniform sampler2D u_color_linear; // the same, linear
layout(location = 0) out vec4 o_color;

uniform vec2 u_size = vec2(1280.0, 720.0);
uniform vec2 u_half_pixel = vec2(0.000478232796236); // tan of half the field of view, of half a pixel
uniform uint u_frame = 0u, u_seed = 0u;
uniform float u_red = -0.00096509233, u_blue = 0.001976475108;
uniform float u_vignette = 0.5;
uniform float u_gain = 1.0;
uniform float u_frequency = 0.756015352711, u_own = 0.0164316767252, u_joint = 0.0100147078098;

bool finite(float x) {
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

float finite_or(float x, float limit) {
    if (finite(x)) return x;
    if ((floatBitsToUint(x) & 0x007fffffu) != 0u) return 0.0;
    return (floatBitsToUint(x) & 0x80000000u) != 0u ? -limit : limit;
}

vec3 finite_or(vec3 x, float limit) {
    return vec3(finite_or(x.r, limit), finite_or(x.g, limit), finite_or(x.b, limit));
}

float light_of(float x) {
    bool is_nan = (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
    return is_nan ? 0.0 : clamp(x, -65504.0, 65504.0);
}

float display_light(float x) {
    return floatBitsToUint(x) > 0x7f800000u ? 0.0 : min(x, 65504.0);
}

vec3 noise(ivec2 place, uint stream) {
    uvec3 v = uvec3(uint(place.x) | (uint(place.y) << 16u), u_frame, u_seed * 0x9e3779b9u + stream);
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return vec3(v >> 8u) * (1.0 / 16777216.0);
}

uint mixed(uint v) {
    v ^= v >> 16u;
    v *= 0x7feb352du;
    v ^= v >> 15u;
    v *= 0x846ca68bu;
    return v ^ (v >> 16u);
}

vec3 grain_at(uint place, uint key) {
    uint v = place * 0x9e3779b9u + key;
    v ^= v >> 16u;
    v *= 0x7feb352du;
    v = (v ^ (v >> 15u)) + key;
    v *= 0x846ca68bu;
    v ^= v >> 16u;
    return (vec3(v & 1023u, (v >> 10u) & 1023u, v >> 22u) - 511.5) * (3.4641016 / 1024.0);
}

float lattice_weight(vec2 offset) {
    float x = max(0.5 - dot(offset, offset), 0.0);
    return x * x;
}

void main() {
    ivec2 index = ivec2(gl_FragCoord.xy);
    vec2 uv = gl_FragCoord.xy / u_size;
    vec4 stored = texelFetch(u_color, index, 0);

    // Chromatic aberration: one tap to the red side, one to the blue.
    vec3 center = vec3(light_of(stored.r), light_of(stored.g), light_of(stored.b));
    vec3 to_red = textureLod(u_color_linear, uv + (uv - 0.5) * u_red, 0.0).rgb;
    vec3 to_blue = textureLod(u_color_linear, uv + (uv - 0.5) * u_blue, 0.0).rgb;
    vec2 red = vec2(light_of(to_red.r), light_of(to_red.g)) - center.rg;
    vec2 blue = vec2(light_of(to_blue.b), light_of(to_blue.g)) - center.bg;
    vec3 color = center + vec3(2.0 / 3.0 * red.x, 1.0 / 6.0 * (red.y + blue.y), 2.0 / 3.0 * blue.x);

    // Vignette: a share of the cos^4 law.
    vec2 slope = vec2(2 * index + 1 - ivec2(u_size)) * u_half_pixel;
    float cos_squared = 1.0 / (1.0 + dot(slope, slope));
    color *= (1.0 - u_vignette) + u_vignette * cos_squared * cos_squared;

    // Tone map.
    const mat3 to_film =
        mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777) * (1.0 / 0.6);
    const mat3 to_display =
        mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 exposed = color * u_gain;
    vec3 film = to_film * vec3(display_light(exposed.r), display_light(exposed.g), display_light(exposed.b));
    film = film * (film + 0.0245786) / (film * (0.983729 * film + 0.4329510) + 0.238081);
    color = clamp(to_display * film, 0.0, 1.0);

    // Grain on a triangular lattice.
    vec2 position = gl_FragCoord.xy * u_frequency;
    vec2 corner = floor(position + (position.x + position.y) * 0.36602540);
    vec2 offset = position - corner + (corner.x + corner.y) * 0.21132487;
    bool is_lower = offset.x > offset.y;
    vec2 second = is_lower ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    vec3 weight = vec3(lattice_weight(offset), lattice_weight(offset - second + 0.21132487),
                       lattice_weight(offset - 1.0 + 2.0 * 0.21132487));
    weight *= inversesqrt(dot(weight, weight));
    uint key = mixed(u_frame * 0x9e3779b9u + u_seed * 0x85ebca6bu);
    uint place = uint(int(corner.x)) | (uint(int(corner.y)) << 16u);
    vec3 field = weight.x * grain_at(place, key) + weight.y * grain_at(place + (is_lower ? 1u : 0x10000u), key) +
                 weight.z * grain_at(place + 0x10001u, key);
    field = u_own * field + u_joint * (field.r + field.g + field.b);
    vec3 room = max(min(color, 1.0 - color), 0.0);
    color += clamp(sqrt(max(color * (1.0 - color), 0.0)) * field, -room, room);

    // sRGB and dither.
    color = clamp(finite_or(color, 1.0), 0.0, 1.0);
    vec3 high = 1.055 * pow(max(color, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    vec3 code = mix(high, 12.92 * color, lessThanEqual(color, vec3(0.0031308))) * 255.0;
    vec3 dither = noise(index, 0xd17e4u) + noise(index, 0xd17e5u) - 1.0;
    code += dither * clamp(min(code, 255.0 - code), 0.0, 1.0);
    o_color = vec4(code / 255.0, stored.a);
}
