#include "ssao_distance.glsl"

// The share of a grid of neighbours that is nearer to the camera, but not by more than the radius.
vec4 ssao_classic(Pixel pixel, SsaoClassicParams params, sampler2D depth) {
    float z = ssao_distance(texelFetch(depth, pixel.index, 0).r);
    float nearer = 0.0;
    for (int y = -4; y <= 4; ++y) {
        for (int x = -4; x <= 4; ++x) {
            ivec2 at = clamp(pixel.index + params.stride * ivec2(x, y), ivec2(0), pixel.size - 1);
            float difference = z - ssao_distance(texelFetch(depth, at, 0).r);
            if (difference > 0.0 && difference < params.radius) nearer += 1.0;
        }
    }
    return vec4(nearer / 80.0, z, 0.0, 0.0);
}
