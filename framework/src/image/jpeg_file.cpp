#include <image/jpeg_file.hpp>

#include <algorithm>

namespace postfx::formats {
namespace {

constexpr int start_of_scan = 0xda, end_of_image = 0xd9;

std::size_t byte_at(std::string_view bytes, std::size_t at) {
    return static_cast<std::uint8_t>(bytes[at]);
}

/// Markers without data: restarts, the beginning, and one for arithmetic coding.
bool stands_alone(std::size_t marker) {
    return (marker >= 0xd0 && marker <= 0xd8) || marker == 0x01;
}

} // namespace

std::vector<JpegSegment> jpeg_segments(const Path& file, std::string_view bytes) {
    std::vector<JpegSegment> segments;
    for (std::size_t at = 2; at + 4 <= bytes.size();) {
        const std::size_t marker = byte_at(bytes, at + 1);
        // Fill bytes, or bytes that belong to nothing, which the decoder tells of.
        if (byte_at(bytes, at) != 0xff || marker == 0xff || marker == 0 || stands_alone(marker)) {
            at += byte_at(bytes, at) == 0xff && stands_alone(marker) ? 2 : 1;
            continue;
        }
        if (marker == start_of_scan || marker == end_of_image) return segments;
        const std::size_t length = byte_at(bytes, at + 2) << 8 | byte_at(bytes, at + 3); // counts itself
        if (length < 2) fail(file, "damaged JPEG: a segment shorter than its own length");
        if (length > bytes.size() - at - 2) break;
        segments.push_back({static_cast<int>(marker), bytes.substr(at + 4, length - 2), at + 4});
        at += 2 + length;
    }
    fail(file, "truncated JPEG: it ends before its pixels");
}

std::optional<std::string_view> find_application_data(const std::vector<JpegSegment>& segments, int marker,
                                                      std::string_view signature) {
    for (const JpegSegment& segment : segments)
        if (segment.marker == marker && segment.data.starts_with(signature))
            return segment.data.substr(signature.size());
    return std::nullopt;
}

std::optional<std::string> icc_profile_of(const std::vector<JpegSegment>& segments) {
    constexpr std::string_view signature("ICC_PROFILE\0", 12);
    std::vector<std::string_view> pieces; // by their numbers, which begin at 1
    std::size_t count = 0;
    for (const JpegSegment& segment : segments) {
        if (segment.marker != 0xe2 || !segment.data.starts_with(signature)) continue;
        if (segment.data.size() < signature.size() + 2) return "";
        const std::size_t number = byte_at(segment.data, signature.size());
        count = byte_at(segment.data, signature.size() + 1);
        if (number == 0 || number > count) return "";
        pieces.resize(std::max(pieces.size(), number));
        pieces[number - 1] = segment.data.substr(signature.size() + 2);
    }
    if (pieces.empty()) return std::nullopt;
    if (pieces.size() != count
        || std::any_of(pieces.begin(), pieces.end(), [](auto piece) { return piece.empty(); }))
        return "";
    std::string profile;
    for (const std::string_view piece : pieces)
        profile += piece;
    return profile;
}

} // namespace postfx::formats
