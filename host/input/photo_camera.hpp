// What a photograph says of the camera that took it, and where it is focused.
#pragma once

#include <image/files.hpp>

#include <postfx/camera.hpp>
#include <postfx/image.hpp>

#include <optional>

namespace postfx::host {

/// A place in a picture, as shares of its width from the left and of its height from the top, both 0..1.
struct PicturePoint {
    double x = 0.5, y = 0.5;
};

/// Vertical field of view [degrees] of a whole photograph of width x height pixels, upright as it is shown: from the
/// focal length for 35 mm film, which EXIF 2.3 defines by the diagonal of its frame (36 mm x 24 mm), whatever the
/// picture's shape. Nothing when the file does not tell it.
std::optional<double> vertical_fov_of(const ShotData& shot, int width, int height);

/// Metres along the view axis to what is seen at `point`: the median of the surfaces within a hundredth of the
/// picture's height around it, so that one wrong sample of a phone's depth map does not decide. `depth`: raw samples
/// of `camera`, one channel. Nothing when no surface is seen there.
std::optional<double> distance_at(const Image& depth, const Camera& camera, PicturePoint point);

} // namespace postfx::host
