// A JPEG's segments (ITU-T T.81) before its pixels: what other programs put beside them.
#pragma once

#include <image/formats.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace postfx::formats {

struct JpegSegment {
    int marker = 0; ///< 0xe0 to 0xef: APP0 to APP15
    std::string_view data{};
    std::size_t at = 0; ///< where the data begin in the file
};

/// Those before the first scan. Throws Error for a damaged one.
std::vector<JpegSegment> jpeg_segments(const Path& file, std::string_view bytes);

/// The data of the first APP segment that begins with `signature`, without it; nothing if there is none.
std::optional<std::string_view> find_application_data(const std::vector<JpegSegment>& segments, int marker,
                                                      std::string_view signature);

/// An ICC profile from all of its segments (ICC.1, annex B.4). Nothing if there is none, "" if one is missing.
std::optional<std::string> icc_profile_of(const std::vector<JpegSegment>& segments);

} // namespace postfx::formats
