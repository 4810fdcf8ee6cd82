#version 450 core
// What somebody would write by hand for one picture: chromatic aberration, vignette, tone map, grain, sRGB encoding and
// dither in one shader. What a user can set is a uniform, at the effects' defaults for 1280x720 and a vertical field of
// view of 38 degrees. `postfx bench night_drive --chain configs/bench/lens_tail.yaml --against
// configs/bench/lens_tail.glsl` measures the fused chain against it and tells how far the two pictures differ.
layout(binding = 0) uniform sampler2D u_color;        // nearest
layout(binding = 1) uniform sampler2D u_color_linear; // the same, linear
layout(location = 0) out vec4 o_color;

uniform vec2 u_size = vec2(1280.0, 720.0);
uniform vec2 u_half_extent = vec2(0.612137979182, 0.34432761329); // tan of half the field of view
uniform uint u_frame = 0u, u_seed = 0u;
uniform float u_red = -0.00096509233, u_blue = 0.001976475108;
uniform float u_vignette = 0.5;
uniform float u_gain = 1.0;
uniform float u_sigma = 0.03, u_frequency = 0.756015352711, u_own = 0.547722557505, u_joint = 0.333823593659;

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

vec3 light_of(vec3 color) {
    return clamp(finite_or(color, 65504.0), -1e38, 1e38);
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

vec3 grain_at(ivec2 place) {
    return (2.0 * noise(place, 0x6a11eu) - 1.0) * 1.7320508;
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
    vec3 center = light_of(stored.rgb);
    vec3 red = light_of(textureLod(u_color_linear, uv + (uv - 0.5) * u_red, 0.0).rgb) - center;
    vec3 blue = light_of(textureLod(u_color_linear, uv + (uv - 0.5) * u_blue, 0.0).rgb) - center;
    vec3 color = center + vec3(2.0 / 3.0, 1.0 / 6.0, 0.0) * red + vec3(0.0, 1.0 / 6.0, 2.0 / 3.0) * blue;

    // Vignette: a share of the cos^4 law.
    vec2 slope = vec2(2 * index + 1 - ivec2(u_size)) / u_size * u_half_extent;
    float cos_squared = 1.0 / (1.0 + dot(slope, slope));
    color *= (1.0 - u_vignette) + u_vignette * cos_squared * cos_squared;

    // Tone map.
    const mat3 to_film = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 to_display =
        mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 film = to_film * (clamp(finite_or(color * u_gain, 65504.0), 0.0, 65504.0) * (1.0 / 0.6));
    film = film * (film + 0.0245786) / (film * (0.983729 * film + 0.4329510) + 0.238081);
    color = clamp(to_display * film, 0.0, 1.0);

    // Grain on a triangular lattice.
    vec2 position = gl_FragCoord.xy * u_frequency;
    vec2 corner = floor(position + (position.x + position.y) * 0.36602540);
    vec2 offset = position - corner + (corner.x + corner.y) * 0.21132487;
    vec2 second = offset.x > offset.y ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    vec3 weight = vec3(lattice_weight(offset), lattice_weight(offset - second + 0.21132487),
                       lattice_weight(offset - 1.0 + 2.0 * 0.21132487));
    ivec2 lattice = ivec2(corner);
    vec3 field = weight.x * grain_at(lattice) + weight.y * grain_at(lattice + ivec2(second)) +
                 weight.z * grain_at(lattice + 1);
    field *= inversesqrt(dot(weight, weight));
    field = u_own * field + u_joint * (field.r + field.g + field.b);
    vec3 room = max(min(color, 1.0 - color), 0.0);
    color += clamp(u_sigma * sqrt(max(color * (1.0 - color), 0.0)) * field, -room, room);

    // sRGB and dither.
    color = clamp(finite_or(color, 1.0), 0.0, 1.0);
    vec3 high = 1.055 * pow(max(color, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    vec3 code = mix(high, 12.92 * color, lessThanEqual(color, vec3(0.0031308))) * 255.0;
    vec3 dither = noise(index, 0xd17e4u) + noise(index, 0xd17e5u) - 1.0;
    code += dither * clamp(min(code, 255.0 - code), 0.0, 1.0);
    o_color = vec4(code / 255.0, stored.a);
}
