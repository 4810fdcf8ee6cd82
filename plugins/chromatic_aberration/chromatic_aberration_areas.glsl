#include "chromatic_aberration_light.glsl"
#include "chromatic_aberration_spectrum.glsl"

// A pixel of the result shows the mean of an area of the picture, 1 + d times as wide as a pixel, and the areas of
// all pixels tile it. In it the light of each pixel of the picture is spread over that pixel alone, as a parabola (the
// piecewise parabolic method, Colella and Woodward 1984). So each pixel's light is kept, whatever the parabola is.
const int CHROMATIC_ABERRATION_REACH = CHROMATIC_ABERRATION_RADIUS - 1; // pixels on either side that shape a parabola
const int CHROMATIC_ABERRATION_CELLS = 2 * CHROMATIC_ABERRATION_REACH + 3; // an area meets three pixels

// The light at the edge between the second and the third of four pixels, exact for parabolas (radius 2) or cubics (3).
vec2 chromatic_aberration_edge(vec2 a, vec2 b, vec2 c, vec2 d) {
    if (CHROMATIC_ABERRATION_RADIUS == 2) return 0.5 * (b + c);
    return clamp((7.0 * (b + c) - (a + d)) / 12.0, min(b, c), max(b, c));
}

// Where a parabola with those ends, relative to its mean, would leave the range of its ends, the picture would ring:
// beside a lamp it would be darker than black. There its ends are drawn in, up to a constant.
vec2 chromatic_aberration_calm(vec2 end, vec2 other) {
    return mix(sign(end) * min(abs(end), 2.0 * abs(other)), vec2(0.0), greaterThanEqual(end * other, vec2(0.0)));
}

// The share in which it may leave it: on the smooth top of a wave, where its bend is no more than 1.25 times that of
// the pixels around (Colella and Sekora 2008). bends: of the pixel and its neighbours.
vec2 chromatic_aberration_smooth(vec2 left, vec2 right, vec2 bend_before, vec2 bend, vec2 bend_behind) {
    if (CHROMATIC_ABERRATION_RADIUS == 2) return vec2(0.0);
    vec2 own = 6.0 * (left + right), side = sign(own);
    vec2 most = 1.25 * max(min(min(side * bend_before, side * bend), side * bend_behind), 0.0);
    return min(most, abs(own)) / max(abs(own), vec2(1e-30));
}

// Integral from a pixel's left end to x in 0..1 of the parabola with those ends and the mean 0.
vec2 chromatic_aberration_part(vec2 left, vec2 right, float x) {
    return x * ((1.0 - x) * ((1.0 - x) * left - x * right));
}

// Mean over `width` pixels from `start`, in 0..1 from the left end of the middle three pixels' first.
vec2 chromatic_aberration_mean(vec2 cells[CHROMATIC_ABERRATION_CELLS], float start, float width) {
    const int reach = CHROMATIC_ABERRATION_REACH;
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 3; ++i) {
        float from = clamp(start - float(i), 0.0, 1.0), to = clamp(start + width - float(i), 0.0, 1.0);
        vec2 own = cells[reach + i], before = cells[reach + i - 1], behind = cells[reach + i + 1];
        vec2 second_before = cells[i], second_behind = cells[2 * reach + i];
        vec2 left = chromatic_aberration_edge(second_before, before, own, behind) - own;
        vec2 right = chromatic_aberration_edge(before, own, behind, second_behind) - own;
        vec2 smooth_share = chromatic_aberration_smooth(left, right, second_before - 2.0 * before + own,
                                                        before - 2.0 * own + behind,
                                                        own - 2.0 * behind + second_behind);
        vec2 calm_left = mix(chromatic_aberration_calm(left, right), left, smooth_share);
        vec2 calm_right = mix(chromatic_aberration_calm(right, left), right, smooth_share);
        sum += (to - from) * own + chromatic_aberration_part(calm_left, calm_right, to) -
               chromatic_aberration_part(calm_left, calm_right, from);
    }
    return sum / width;
}

// How a pixel differs from `light` in two of its channels.
vec2 chromatic_aberration_at(ivec2 place, vec2 light, ivec2 size, bool is_red, sampler2D picture) {
    vec3 found = texelFetch(picture, clamp(place, ivec2(0), size - 1), 0).rgb;
    return chromatic_aberration_light(is_red ? found.rg : found.bg) - light;
}

// The same of the mean over the area that the pixel shows where the image is 1 + scale times as large, line by line.
vec2 chromatic_aberration_difference(vec2 light, Pixel pixel, float scale, bool is_red, sampler2D picture) {
    vec2 displacement = scale * (vec2(pixel.index) - 0.5 * vec2(pixel.size)); // of the pixel's lower left end
    vec2 whole = floor(displacement), start = displacement - whole;
    ivec2 first = pixel.index + ivec2(whole) - CHROMATIC_ABERRATION_REACH;
    vec2 lines[CHROMATIC_ABERRATION_CELLS];
    for (int j = 0; j < CHROMATIC_ABERRATION_CELLS; ++j) {
        vec2 line[CHROMATIC_ABERRATION_CELLS];
        for (int i = 0; i < CHROMATIC_ABERRATION_CELLS; ++i)
            line[i] = chromatic_aberration_at(first + ivec2(i, j), light, pixel.size, is_red, picture);
        lines[j] = chromatic_aberration_mean(line, start.x, 1.0 + scale);
    }
    return chromatic_aberration_mean(lines, start.y, 1.0 + scale);
}

vec2 chromatic_aberration_areas_side(vec2 light, Pixel pixel, float scale, bool is_red, int taps,
                                     sampler2D picture) {
    vec2 change = vec2(0.0);
    for (int i = 1; i <= taps; ++i) {
        change += chromatic_aberration_weights(i, taps) *
                  chromatic_aberration_difference(light, pixel, float(i) / float(taps) * scale, is_red, picture);
    }
    return change;
}

vec3 chromatic_aberration_areas(vec3 color, Pixel pixel, ChromaticAberrationAreasParams params, sampler2D picture) {
    vec3 light = chromatic_aberration_light(color);
    vec2 red =
        chromatic_aberration_areas_side(light.rg, pixel, params.red, true, CHROMATIC_ABERRATION_RED_TAPS, picture);
    vec2 blue =
        chromatic_aberration_areas_side(light.bg, pixel, params.blue, false, CHROMATIC_ABERRATION_BLUE_TAPS, picture);
    return chromatic_aberration_sum(light, red, blue);
}
