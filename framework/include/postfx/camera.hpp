// How a depth sample and a pixel become a place in front of the camera.
#pragma once

#include <array>
#include <limits>

namespace postfx {

/// Depth samples are affine in 1/z (perspective) or in z (orthographic), where z > 0 is metres along the view
/// axis:
///     perspective:   1/z = depth_scale * d + depth_offset
///     orthographic:    z = depth_scale * d + depth_offset
/// so no shader divides by zero at the sky (1/z = 0) and every convention (standard, reversed, infinite) is
/// two numbers.
struct Camera {
    bool orthographic = false;
    double vertical_fov = 45.0;    ///< degrees, perspective only
    double vertical_extent = 10.0; ///< metres that the picture's height spans, orthographic only
    /// Where the optical axis (of parallel views the view-space origin) lies in the picture, to the right and up from
    /// its middle, in half widths and half heights; finite. Not 0 with a shifted lens, in a part of a larger picture,
    /// in one eye's view, and with jitter. Beyond -1..1 it is outside of the picture.
    std::array<double, 2> principal_point = {0, 0};
    double near_plane = 0.1;                                    ///< metres
    double far_plane = std::numeric_limits<double>::infinity(); ///< metres
    double depth_scale = 10.0; ///< see above; default is reversed-Z with infinite far plane, d = near / z
    double depth_offset = 0.0;
    double sky_depth = 0.0; ///< the raw sample that means "nothing there"; compared exactly, never linearised

    double focus_distance = 0; ///< metres along the view axis that the camera is focused on; 0 = not known

    /// Camera to world, column major, metres; the camera looks down its own -z.
    std::array<double, 16> view_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

    enum class DepthKind { reversed_infinite, reversed, standard };
    /// Set near, far and the depth numbers together.
    static Camera perspective(double vertical_fov_degrees, double near_plane,
                              double far_plane = std::numeric_limits<double>::infinity(),
                              DepthKind kind = DepthKind::reversed_infinite);
    static Camera parallel(double vertical_extent, double near_plane, double far_plane,
                           DepthKind kind = DepthKind::reversed);

    /// Metres along the view axis for a raw sample; +infinity for the sky.
    double view_z(double depth) const;
    /// The raw sample for a distance along the view axis in metres (infinity gives sky_depth).
    double depth_at(double view_z) const;
    /// tan(vertical_fov / 2); 0 for orthographic cameras.
    double tan_half_fov() const;
    /// What the place x, y of a picture of that size (pixels from its lower left corner) looks at: where its ray
    /// crosses the plane 1 m in front of a perspective camera, or how far beside the axis a parallel ray runs [m].
    std::array<double, 2> view_plane(double x, double y, int width, int height) const;
};

} // namespace postfx
