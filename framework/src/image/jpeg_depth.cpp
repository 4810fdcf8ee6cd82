#include <image/jpeg_depth.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace postfx::formats {
namespace {

constexpr int app1 = 0xe1, app2 = 0xe2;

/// The packet and its extension, which holds what does not fit into one segment.
std::string xmp_of(const std::vector<JpegSegment>& segments) {
    constexpr std::string_view packet("http://ns.adobe.com/xap/1.0/\0", 29);
    constexpr std::string_view extension("http://ns.adobe.com/xmp/extension/\0", 35);
    constexpr std::size_t extension_head =
        32 + 4 + 4; // a checksum, the whole size, and where this piece begins
    std::string xmp, extended;
    for (const JpegSegment& segment : segments) {
        if (segment.marker != app1) continue;
        if (segment.data.starts_with(packet)) xmp += segment.data.substr(packet.size());
        // The pieces are written in their order.
        if (segment.data.starts_with(extension) && segment.data.size() > extension.size() + extension_head)
            extended += segment.data.substr(extension.size() + extension_head);
    }
    return xmp + extended;
}

/// Of a property, which is written as an attribute or as an element.
std::optional<std::string_view> property(std::string_view xmp, const std::string& name) {
    for (const auto& [begin, end] : {std::pair{name + "=\"", "\""}, std::pair{"<" + name + ">", "<"}}) {
        const std::size_t at = xmp.find(begin);
        if (at == std::string_view::npos) continue;
        const std::size_t from = at + begin.size(), to = xmp.find(end, from);
        if (to != std::string_view::npos) return xmp.substr(from, to - from);
    }
    return std::nullopt;
}

std::optional<double> number(std::string_view xmp, const std::string& name) {
    const std::optional<std::string_view> text = property(xmp, name);
    if (!text) return std::nullopt;
    double value = 0;
    const auto [end, problem] = std::from_chars(text->data(), text->data() + text->size(), value);
    (void)end;
    if (problem != std::errc() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::string from_base64(const Path& file, std::string_view text) {
    static constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char letter : text) {
        if (letter == '=' || letter == '\n' || letter == '\r' || letter == ' ') continue;
        const std::size_t digit = digits.find(letter);
        if (digit == std::string_view::npos) fail(file, "its depth map is damaged: no base64");
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 255);
    }
    return bytes;
}

/// Google's formats: linear in the distance, or in its inverse; 0 is near.
std::optional<DepthScale> scale_of_range(std::string_view xmp, const std::string& prefix) {
    const std::optional<double> near = number(xmp, prefix + "Near"), far = number(xmp, prefix + "Far");
    const std::string_view format = property(xmp, prefix + "Format").value_or("");
    if (!near || !far || !(*near > 0) || !(*far > *near)) return std::nullopt;
    if (format == "RangeLinear") return DepthScale{DepthScale::Kind::metres, *near, *far};
    if (format == "RangeInverse") return DepthScale{DepthScale::Kind::dioptres, 1 / *near, 1 / *far};
    return std::nullopt;
}

ImageFile decoded(const ImageSource& source, std::string bytes, std::optional<DepthScale> scale) {
    ImageFile depth = read_image(ImageSource{source.name, std::move(bytes)}, {.role = Role::data});
    depth.layer = "depth map";
    depth.depth_scale = scale;
    if (!scale) depth.warnings.emplace_back("its depth map does not say what its samples stand for");
    return depth;
}

/// Where in the file the item lies of which Dynamic Depth's directory says that it is the depth: items lie one after
/// another at the end.
std::optional<std::string_view> dynamic_depth_item(const ImageSource& source, std::string_view xmp) {
    std::size_t at = xmp.find("<Container:Directory");
    std::optional<std::size_t> depth_length;
    std::size_t behind = 0; // bytes from the depth's beginning to the end of the file
    for (at = xmp.find("<Container:Item", at); at != std::string_view::npos;
         at = xmp.find("<Container:Item", at + 1)) {
        const std::string_view item = xmp.substr(at, xmp.find('>', at) - at);
        const double length =
            number(item, "Item:Length").value_or(0) + number(item, "Item:Padding").value_or(0);
        const bool primary = property(item, "Item:Semantic") == "Primary";
        if (primary || !(length >= 0) || length > static_cast<double>(source.bytes.size())) continue;
        const bool depth = property(item, "Item:Semantic") == "Depth"
                           || property(item, "Item:DataURI") == "primary/depthmap";
        if (depth) depth_length = static_cast<std::size_t>(number(item, "Item:Length").value_or(0));
        if (depth_length) behind += static_cast<std::size_t>(length);
    }
    if (!depth_length || behind == 0 || behind > source.bytes.size()) return std::nullopt;
    return std::string_view(source.bytes).substr(source.bytes.size() - behind, *depth_length);
}

/// The further pictures of a multi-picture file.
std::vector<std::string_view> further_pictures(const ImageSource& source,
                                               const std::vector<JpegSegment>& segments) {
    std::vector<std::string_view> pictures;
    const std::string_view bytes = source.bytes;
    for (const JpegSegment& segment : segments) {
        if (segment.marker != app2 || !segment.data.starts_with(std::string_view("MPF\0", 4))) continue;
        const std::size_t base = segment.at + 4; // from here its offsets count
        const std::string_view index = segment.data.substr(4);
        const bool little = index.starts_with("II");
        const auto number_at = [&](std::size_t at, std::size_t size) {
            std::size_t value = 0;
            for (std::size_t i = 0; i < size && at + size <= index.size(); ++i)
                value = value << 8 | static_cast<std::uint8_t>(index[at + (little ? size - 1 - i : i)]);
            return value;
        };
        constexpr std::size_t entries_tag = 0xb002, entry_size = 16;
        const std::size_t fields = number_at(4, 4);
        for (std::size_t field = fields + 2;
             field < fields + 2 + 12 * number_at(fields, 2) && field < index.size(); field += 12) {
            if (number_at(field, 2) != entries_tag) continue;
            const std::size_t count = number_at(field + 4, 4) / entry_size, entries = number_at(field + 8, 4);
            for (std::size_t i = 1; i < std::min<std::size_t>(count, 64);
                 ++i) { // the first one is the photograph
                const std::size_t size = number_at(entries + entry_size * i + 4, 4);
                const std::size_t offset = number_at(entries + entry_size * i + 8, 4);
                if (base + offset < bytes.size()) pictures.push_back(bytes.substr(base + offset, size));
            }
        }
    }
    return pictures;
}

/// Apple's XMP of an auxiliary picture: what it is, and what 0 and 1 stand for.
std::optional<ImageFile> apple_depth(const ImageSource& source, std::string_view picture) {
    const std::vector<JpegSegment> segments = jpeg_segments(source.name, picture);
    const std::string xmp = xmp_of(segments);
    const std::string_view type = property(xmp, "apdi:AuxiliaryImageType").value_or("");
    if (type != "disparity" && type != "depth") return std::nullopt;
    const std::optional<double> low = number(xmp, "apdi:FloatMinValue"),
                                high = number(xmp, "apdi:FloatMaxValue");
    std::optional<DepthScale> scale;
    if (low && high)
        scale =
            DepthScale{type == "depth" ? DepthScale::Kind::metres : DepthScale::Kind::dioptres, *low, *high};
    return decoded(source, std::string(picture), scale);
}

} // namespace

std::optional<ImageFile> depth_in_jpeg(const ImageSource& source, const std::vector<JpegSegment>& segments) {
    const std::string xmp = xmp_of(segments);
    if (const auto data = property(xmp, "GDepth:Data"))
        return decoded(source, from_base64(source.name, *data), scale_of_range(xmp, "GDepth:"));
    if (const auto item = dynamic_depth_item(source, xmp))
        return decoded(source, std::string(*item), scale_of_range(xmp, "DepthMap:"));
    for (const std::string_view picture : further_pictures(source, segments))
        if (picture.starts_with("\xff\xd8\xff"))
            if (std::optional<ImageFile> depth = apple_depth(source, picture)) return depth;
    return std::nullopt;
}

} // namespace postfx::formats
