#include "chromatic_aberration_axis.glsl"
#include "chromatic_aberration_spectrum.glsl"

// A pixel of the result shows the mean of an area of the picture, 1 + d times as wide as a pixel, and the areas of
// all pixels tile it. In it the light of each pixel of the picture is spread over that pixel alone, as a parabola (the
// piecewise parabolic method, Colella and Woodward 1984). So each pixel's light is kept, whatever the parabola is.
const int CHROMATIC_ABERRATION_REACH = CHROMATIC_ABERRATION_RADIUS - 1; // pixels on either side that shape a parabola
const int CHROMATIC_ABERRATION_SHAPE = 2 * CHROMATIC_ABERRATION_REACH + 1;
const int CHROMATIC_ABERRATION_CELLS = CHROMATIC_ABERRATION_SHAPE + 2; // an area meets three pixels at most

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

// The share in which it may leave it all the same. Wholly in a pixel that is brighter than both its ends: a lamp's
// light is gathered in its middle, and nothing gets darker than the ends. Also on a smooth wave, where it bends no more
// than 1.25 times as much as the pixels around (Colella and Sekora 2008). bends: of the pixel and its neighbours.
vec2 chromatic_aberration_kept(vec2 left, vec2 right, vec2 bend_before, vec2 bend, vec2 bend_behind) {
    vec2 smooth_share = vec2(0.0);
    if (CHROMATIC_ABERRATION_RADIUS == 3) {
        vec2 own = 6.0 * (left + right), side = sign(own);
        vec2 most = 1.25 * max(min(min(side * bend_before, side * bend), side * bend_behind), 0.0);
        smooth_share = min(most, abs(own)) / max(abs(own), vec2(1e-30));
    }
    return mix(smooth_share, vec2(1.0), lessThan(max(left, right), vec2(0.0)));
}

// Integral from the left end to x in 0..1 of the middle pixel's light, less its mean.
vec2 chromatic_aberration_part(vec2 shape[CHROMATIC_ABERRATION_SHAPE], float x) {
    const int reach = CHROMATIC_ABERRATION_REACH;
    vec2 second_before = shape[0], second_behind = shape[2 * reach];
    vec2 before = shape[reach - 1], own = shape[reach], behind = shape[reach + 1];
    vec2 left = chromatic_aberration_edge(second_before, before, own, behind) - own;
    vec2 right = chromatic_aberration_edge(before, own, behind, second_behind) - own;
    vec2 kept =
        chromatic_aberration_kept(left, right, second_before - 2.0 * before + own, before - 2.0 * own + behind,
                                  own - 2.0 * behind + second_behind);
    vec2 calm_left = mix(chromatic_aberration_calm(left, right), left, kept);
    vec2 calm_right = mix(chromatic_aberration_calm(right, left), right, kept);
    return x * (1.0 - x) * ((1.0 - x) * calm_left - x * calm_right);
}

// Mean over `width` pixels from `start`, in 0..1 from the left end of the first of the two or three that it meets: two
// if it is narrower than a pixel, else three.
vec2 chromatic_aberration_mean(vec2 cells[CHROMATIC_ABERRATION_CELLS], int met, float start, float width) {
    const int reach = CHROMATIC_ABERRATION_REACH;
    float end = start + width - float(met - 1); // from the last one's left end
    bool is_last = end >= 0.0;                  // or it ends in the one before
    vec2 first[CHROMATIC_ABERRATION_SHAPE], last[CHROMATIC_ABERRATION_SHAPE];
    for (int i = 0; i <= 2 * reach; ++i) {
        first[i] = cells[i];
        last[i] = is_last ? cells[i + met - 1] : cells[i + met - 2];
    }
    vec2 whole = is_last ? cells[reach + met - 2] : vec2(0.0);
    if (met == 3) whole += cells[reach];
    end = is_last ? end : end + 1.0;
    return (whole - start * first[reach] + end * last[reach] + chromatic_aberration_part(last, end) -
            chromatic_aberration_part(first, start)) / width;
}

// How a pixel differs from `light` in two of its channels.
vec2 chromatic_aberration_at(ivec2 place, vec2 light, ivec2 size, bool is_red, sampler2D picture) {
    vec3 found = texelFetch(picture, clamp(place, ivec2(0), size - 1), 0).rgb;
    return postfx_light(is_red ? found.rg : found.bg) - light;
}

// The same of the mean over the area that the pixel shows where the image is 1 + scale times as large, line by line.
vec2 chromatic_aberration_difference(vec2 light, Pixel pixel, float scale, bool is_red, int met, sampler2D picture) {
    // Of the pixel's lower left end.
    vec2 displacement = scale * (vec2(pixel.index) - chromatic_aberration_axis() * vec2(pixel.size));
    vec2 whole = floor(displacement), start = displacement - whole;
    ivec2 first = pixel.index + ivec2(whole) - CHROMATIC_ABERRATION_REACH;
    vec2 lines[CHROMATIC_ABERRATION_CELLS];
    for (int j = 0; j < met + 2 * CHROMATIC_ABERRATION_REACH; ++j) {
        vec2 line[CHROMATIC_ABERRATION_CELLS];
        for (int i = 0; i < met + 2 * CHROMATIC_ABERRATION_REACH; ++i)
            line[i] = chromatic_aberration_at(first + ivec2(i, j), light, pixel.size, is_red, picture);
        lines[j] = chromatic_aberration_mean(line, met, start.x, 1.0 + scale);
    }
    return chromatic_aberration_mean(lines, met, start.y, 1.0 + scale);
}

vec3 chromatic_aberration_areas(vec3 color, Pixel pixel, ChromaticAberrationAreasParams params, sampler2D picture) {
    vec3 light = postfx_light(color);
    vec2 red = vec2(0.0), blue = vec2(0.0);
    for (int i = 1; i <= CHROMATIC_ABERRATION_RED_TAPS; ++i) {
        float scale = float(i) / float(CHROMATIC_ABERRATION_RED_TAPS) * params.red;
        red += chromatic_aberration_weights(i, CHROMATIC_ABERRATION_RED_TAPS) *
               chromatic_aberration_difference(light.rg, pixel, scale, true, CHROMATIC_ABERRATION_RED_MET, picture);
    }
    for (int i = 1; i <= CHROMATIC_ABERRATION_BLUE_TAPS; ++i) {
        float scale = float(i) / float(CHROMATIC_ABERRATION_BLUE_TAPS) * params.blue;
        blue += chromatic_aberration_weights(i, CHROMATIC_ABERRATION_BLUE_TAPS) *
                chromatic_aberration_difference(light.bg, pixel, scale, false, CHROMATIC_ABERRATION_BLUE_MET, picture);
    }
    return chromatic_aberration_sum(light, red, blue);
}
