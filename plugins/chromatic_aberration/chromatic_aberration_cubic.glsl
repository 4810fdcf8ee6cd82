#include "chromatic_aberration_light.glsl"
#include "chromatic_aberration_spectrum.glsl"

// Cubic convolution (Keys 1981) at distance d from a pixel. Radius 2: the four-point kernel, known as Catmull-Rom,
// exact for parabolas; radius 3: the six-point kernel, exact for cubics.
float chromatic_aberration_kernel(float d) {
    if (CHROMATIC_ABERRATION_RADIUS == 2) {
        return d < 1.0 ? (1.5 * d - 2.5) * d * d + 1.0 : ((-0.5 * d + 2.5) * d - 4.0) * d + 2.0;
    }
    return d < 1.0   ? (16.0 * d - 28.0) / 12.0 * d * d + 1.0
           : d < 2.0 ? ((-7.0 * d + 36.0) * d - 59.0) / 12.0 * d + 2.5
                     : ((d - 8.0) * d + 21.0) / 12.0 * d - 1.5;
}

// A cubic kernel rings: beside a lamp it would be darker than black. With radius 2 nothing leaves the range of the two
// middle samples; with 3 it may ring as far as light goes, so as to converge to what is true between samples.
vec3 chromatic_aberration_limit(vec3 sum, vec3 a, vec3 b, vec3 light) {
    return CHROMATIC_ABERRATION_RADIUS == 2 ? clamp(sum, min(a, b), max(a, b))
                                            : clamp(sum, -65504.0 - light, 65504.0 - light);
}

// How the picture at a place between pixels differs from `light`, by 2R x 2R pixels, line by line.
vec3 chromatic_aberration_difference(vec3 light, vec2 position, ivec2 size, sampler2D picture) {
    const int radius = CHROMATIC_ABERRATION_RADIUS;
    vec2 first = floor(position - 0.5);
    vec2 share = position - 0.5 - first;
    vec3 lines = vec3(0.0), middle_lines[2];
    for (int j = 1 - radius; j <= radius; ++j) {
        vec3 line = vec3(0.0), middle[2];
        for (int i = 1 - radius; i <= radius; ++i) {
            ivec2 index = clamp(ivec2(first) + ivec2(i, j), ivec2(0), size - 1);
            vec3 difference = chromatic_aberration_light(texelFetch(picture, index, 0).rgb) - light;
            line += chromatic_aberration_kernel(abs(float(i) - share.x)) * difference;
            if (i == 0 || i == 1) middle[i] = difference;
        }
        line = chromatic_aberration_limit(line, middle[0], middle[1], light);
        lines += chromatic_aberration_kernel(abs(float(j) - share.y)) * line;
        if (j == 0 || j == 1) middle_lines[j] = line;
    }
    return chromatic_aberration_limit(lines, middle_lines[0], middle_lines[1], light);
}

vec2 chromatic_aberration_cubic_side(vec3 light, Pixel pixel, float scale, bool is_red, int taps,
                                      sampler2D picture) {
    vec2 displacement = scale * (pixel.position - 0.5 * vec2(pixel.size));
    vec2 change = vec2(0.0);
    for (int i = 1; i <= taps; ++i) {
        vec2 position = pixel.position + (float(i) / float(taps)) * displacement;
        vec3 difference = chromatic_aberration_difference(light, position, pixel.size, picture);
        change += chromatic_aberration_weights(i, taps) * (is_red ? difference.rg : difference.bg);
    }
    return change;
}

vec3 chromatic_aberration_cubic(vec3 color, Pixel pixel, ChromaticAberrationCubicParams params, sampler2D picture) {
    vec3 light = chromatic_aberration_light(color);
    vec2 red = chromatic_aberration_cubic_side(light, pixel, params.red, true, CHROMATIC_ABERRATION_RED_TAPS, picture);
    vec2 blue =
        chromatic_aberration_cubic_side(light, pixel, params.blue, false, CHROMATIC_ABERRATION_BLUE_TAPS, picture);
    return chromatic_aberration_sum(light, red, blue);
}
