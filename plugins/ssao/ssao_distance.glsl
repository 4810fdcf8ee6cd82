#include <postfx/depth.glsl>
#include <postfx/numeric.glsl>

// Metres along the view axis where there is no surface. Finite, and so is its square times any field of view.
const float SSAO_NOTHING = 1e15;

// Metres along the view axis for a raw depth sample. The sky and samples that mean no place at all are nothing.
float ssao_distance(float depth) {
    float z = postfx_view_z(depth);
    return postfx_is_finite(z) && z > 0.0 && z < SSAO_NOTHING ? z : SSAO_NOTHING;
}
