#include "depth_of_field_light.glsl"

// The picture as points of the lens see it, one after the other. Seen from a point of the lens (-1..1), a pixel moves
// by half its circle times that point; so what this pixel shows lies on a line through it, and is found by marching
// along it from the nearest surface to the farthest.

// Points of a disc, evenly spread (Vogel 1979): the golden angle in 32 bits of a turn is exact for any number.
vec2 depth_of_field_lens_point(int i, int count) {
    float turn = float(uint(i) * 2654435769u >> 8u) * (6.28318531 / 16777216.0);
    return sqrt((float(i) + 0.5) / float(count)) * vec2(cos(turn), sin(turn));
}

// The pixel that shows there. shift [px]: added to every circle.
ivec2 depth_of_field_seen(ivec2 index, vec2 point, float shift, float limit, ivec2 last, sampler2D circles) {
    bool steep = abs(point.y) > abs(point.x);
    float along = steep ? point.y : point.x;
    float unit = 0.5 * abs(along);            // pixels along the longer axis per pixel of circle
    vec2 stride = -point / abs(along);        // to the place where a circle is 1 / unit larger
    int steps = int((limit + abs(shift)) * unit + 0.5);
    ivec2 seen = index, previous = index;
    bool passed = false, before = false;
    for (int k = -steps; k <= steps; ++k) {
        ivec2 at = clamp(index + ivec2(floor(float(k) * stride + 0.5)), ivec2(0), last);
        float ahead = (texelFetch(circles, at, 0).r + shift) * unit - float(k);
        if (abs(ahead) <= 0.5) {
            // The line's pixel is up to half a pixel beside the disc's; the surface's own circle says which it is.
            float circle = texelFetch(circles, at, 0).r + shift;
            ivec2 exact = clamp(index - ivec2(floor(0.5 * circle * point + 0.5)), ivec2(0), last);
            float there = (texelFetch(circles, exact, 0).r + shift) * unit - float(k);
            return abs(there) <= 0.5 ? exact : at;
        }
        // Passing behind a surface hides what was seen before: if nothing else shows, that is taken to go on.
        if (ahead < 0.0 && before && !passed) {
            seen = previous;
            passed = true;
        }
        before = ahead > 0.0;
        previous = at;
    }
    return seen;
}

// Mean of what all points see; 0 in alpha if that is this pixel alone.
vec4 depth_of_field_lens(Pixel pixel, DepthOfFieldLensParams params, sampler2D source, sampler2D circles) {
    ivec2 last = pixel.size - 1;
    vec3 sum = vec3(0.0);
    float moved = 0.0;
    for (int i = 0; i < params.lens_samples; ++i) {
        vec2 point = depth_of_field_lens_point(i, params.lens_samples);
        for (int channel = 0; channel < (DEPTH_OF_FIELD_AXIAL == 1 ? 3 : 1); ++channel) {
            float shift = DEPTH_OF_FIELD_AXIAL == 1 ? params.axial_shift[channel] : 0.0;
            ivec2 at = depth_of_field_seen(pixel.index, point, shift, params.limit, last, circles);
            vec3 light = depth_of_field_light(texelFetch(source, at, 0).rgb);
            if (DEPTH_OF_FIELD_AXIAL == 1) {
                sum[channel] += light[channel];
            } else {
                sum += light;
            }
            if (at != pixel.index) moved = 1.0;
        }
    }
    return vec4(sum / float(params.lens_samples), moved);
}
