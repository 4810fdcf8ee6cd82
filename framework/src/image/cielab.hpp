// Linear sRGB, CIE XYZ and CIE L*a*b* (ISO/CIE 11664-4), in double.
#pragma once

#include <array>

namespace postfx {

using Triple = std::array<double, 3>; ///< one colour

/// Linear sRGB (white = 1, 1, 1) to XYZ; its white has Y = 1.
Triple linear_to_xyz(const Triple& linear);
Triple xyz_to_linear(const Triple& xyz);

/// XYZ of linear 1, 1, 1: D65.
const Triple& white_xyz();

/// L* in [0, 100] for Y in [0, 1]; a* and b* are 0 for greys.
Triple xyz_to_lab(const Triple& xyz);
Triple lab_to_xyz(const Triple& lab);

} // namespace postfx
