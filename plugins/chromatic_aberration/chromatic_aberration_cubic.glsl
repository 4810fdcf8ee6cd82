#include "chromatic_aberration_axis.glsl"
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

// How a pixel differs from `light` in two of its channels.
vec2 chromatic_aberration_at(ivec2 place, vec2 light, ivec2 size, bool is_red, sampler2D picture) {
    vec3 found = texelFetch(picture, clamp(place, ivec2(0), size - 1), 0).rgb;
    return chromatic_aberration_light(is_red ? found.rg : found.bg) - light;
}

// The same at a place between pixels, by 2R x 2R of them, line by line. Of 4x4 the corners count for little: the outer
// lines are straight between their middle two pixels. A cubic kernel rings: beside a lamp it would be darker than
// black. So no line leaves the range of its nearest four pixels, nor their column that of the nearest four lines.
vec2 chromatic_aberration_difference(vec2 light, vec2 position, ivec2 size, bool is_red, sampler2D picture) {
    const int radius = CHROMATIC_ABERRATION_RADIUS;
    vec2 first = floor(position - 0.5);
    vec2 share = position - 0.5 - first;
    float across[2 * radius];
    for (int i = 0; i < 2 * radius; ++i)
        across[i] = chromatic_aberration_kernel(abs(float(i + 1 - radius) - share.x));
    const vec2 farthest = vec2(131008.0); // two lights of +-65504
    vec2 sum = vec2(0.0), least = farthest, most = -farthest;
    for (int j = 1 - radius; j <= radius; ++j) {
        ivec2 place = ivec2(first) + ivec2(0, j);
        vec2 line = vec2(0.0);
        if (radius == 2 && (j == -1 || j == 2)) {
            line = mix(chromatic_aberration_at(place, light, size, is_red, picture),
                       chromatic_aberration_at(place + ivec2(1, 0), light, size, is_red, picture), share.x);
        } else {
            vec2 line_least = farthest, line_most = -farthest;
            for (int i = 1 - radius; i <= radius; ++i) {
                vec2 difference = chromatic_aberration_at(place + ivec2(i, 0), light, size, is_red, picture);
                line += across[i + radius - 1] * difference;
                if (i >= -1 && i <= 2) {
                    line_least = min(line_least, difference);
                    line_most = max(line_most, difference);
                }
            }
            line = clamp(line, line_least, line_most);
        }
        sum += chromatic_aberration_kernel(abs(float(j) - share.y)) * line;
        if (j >= -1 && j <= 2) {
            least = min(least, line);
            most = max(most, line);
        }
    }
    return clamp(sum, least, most);
}

vec2 chromatic_aberration_cubic_side(vec2 light, Pixel pixel, float scale, bool is_red, int taps,
                                      sampler2D picture) {
    vec2 displacement = scale * (pixel.position - chromatic_aberration_axis() * vec2(pixel.size));
    vec2 change = vec2(0.0);
    for (int i = 1; i <= taps; ++i) {
        vec2 position = pixel.position + (float(i) / float(taps)) * displacement;
        vec2 difference = chromatic_aberration_difference(light, position, pixel.size, is_red, picture);
        change += chromatic_aberration_weights(i, taps) * difference;
    }
    return change;
}

vec3 chromatic_aberration_cubic(vec3 color, Pixel pixel, ChromaticAberrationCubicParams params, sampler2D picture) {
    vec3 light = chromatic_aberration_light(color);
    vec2 red =
        chromatic_aberration_cubic_side(light.rg, pixel, params.red, true, CHROMATIC_ABERRATION_RED_TAPS, picture);
    vec2 blue =
        chromatic_aberration_cubic_side(light.bg, pixel, params.blue, false, CHROMATIC_ABERRATION_BLUE_TAPS, picture);
    return chromatic_aberration_sum(light, red, blue);
}
