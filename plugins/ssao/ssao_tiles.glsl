#include "ssao_distance.glsl"

// 1 for tiles with a surface in or right beside them: the denoiser and the picture's pixels read one texel beyond.
vec4 ssao_tiles(Pixel pixel, SsaoTilesParams params, sampler2D distances) {
    ivec2 last = textureSize(distances, 0) - 1;
    ivec2 from = max(SSAO_TILE * pixel.index - 2, ivec2(0)), to = min(SSAO_TILE * (pixel.index + 1) + 1, last);
    for (int y = from.y; y <= to.y; ++y) {
        for (int x = from.x; x <= to.x; ++x) {
            if (texelFetch(distances, ivec2(x, y), 0).r != SSAO_NOTHING) return vec4(1.0);
        }
    }
    return vec4(0.0);
}
