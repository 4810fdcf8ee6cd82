// The sRGB transfer curve (IEC 61966-2-1), in double.
#pragma once

namespace postfx {

/// Linear light in [0, 1] for an encoded value in [0, 1].
double srgb_to_linear(double encoded);
/// Encoded value in [0, 1]; what lies outside [0, 1] is clamped, NaN is 0.
double linear_to_srgb(double linear);

} // namespace postfx
