#include "chromatic_aberration_three.glsl"

vec3 chromatic_aberration_ghosts(vec3 color, Pixel pixel, ChromaticAberrationGhostsParams params, sampler2D picture) {
    return chromatic_aberration_three(color, pixel.uv, params.red, params.blue, picture);
}
