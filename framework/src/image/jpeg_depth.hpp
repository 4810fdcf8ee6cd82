// The depth map that some phones put into their JPEG photographs.
#pragma once

#include <image/jpeg_file.hpp>

#include <optional>

namespace postfx::formats {

/// As Google's camera (XMP `GDepth`), Android's Dynamic Depth (XMP `Container` and `DepthMap`) and Apple's export (a second
/// picture, CIPA DC-007, whose XMP says what it is) store it; as it is stored, not yet turned as the photograph is.
/// Nothing if there is none. Throws Error for one that can't be decoded.
std::optional<ImageFile> depth_in_jpeg(const ImageSource& source, const std::vector<JpegSegment>& segments);

} // namespace postfx::formats
