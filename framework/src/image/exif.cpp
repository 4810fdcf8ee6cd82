#include <image/exif.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace postfx {
namespace {

enum Tag : std::uint32_t {
    make_tag = 0x010f,
    model_tag = 0x0110,
    orientation_tag = 0x0112,
    transfer_function_tag = 0x012d,
    white_point_tag = 0x013e,
    primaries_tag = 0x013f,
    exif_directory_tag = 0x8769,
    focal_length_tag = 0x920a,
    color_space_tag = 0xa001,
    interoperability_directory_tag = 0xa005,
    focal_length_35mm_tag = 0xa405,
    gamma_tag = 0xa500,
    interoperability_index_tag = 0x0001,
};

/// One field of a directory: its tag and where its values lie.
struct Field {
    std::uint32_t tag = 0, type = 0, count = 0;
    std::size_t at = 0;
};

class Tiff {
public:
    explicit Tiff(std::string_view bytes) : bytes_(bytes), little_(bytes.starts_with("II")) {}

    bool good() const { return good_; }
    std::uint32_t number(std::size_t at, std::size_t size) {
        if (at > bytes_.size() || size > bytes_.size() - at) {
            good_ = false;
            return 0;
        }
        std::uint32_t result = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t byte = little_ ? size - 1 - i : i;
            result = result << 8 | static_cast<std::uint8_t>(bytes_[at + byte]);
        }
        return result;
    }
    std::vector<Field> directory(std::size_t at) {
        static constexpr std::size_t sizes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4};
        std::vector<Field> fields;
        const std::uint32_t count = number(at, 2);
        for (std::uint32_t i = 0; i < count && good_; ++i) {
            const std::size_t entry = at + 2 + 12 * std::size_t{i};
            Field field{number(entry, 2), number(entry + 2, 2), number(entry + 4, 4), entry + 8};
            const std::size_t size = field.type < std::size(sizes) ? sizes[field.type] : 0;
            if (size * field.count > 4) field.at = number(entry + 8, 4);
            if (good_) fields.push_back(field);
        }
        return fields;
    }
    /// Of a BYTE, SHORT or LONG.
    std::uint32_t integer(const Field& field) {
        return number(field.at, field.type == 4 || field.type == 9 ? 4 : field.type == 3 ? 2 : 1);
    }
    /// Of a RATIONAL; nothing for 0 / 0 and the like, which cameras write for "unknown".
    std::optional<double> positive_ratio(const Field& field) {
        const double above = number(field.at, 4), below = number(field.at + 4, 4);
        if (field.type != 5 || !(above > 0) || !(below > 0)) return std::nullopt;
        return above / below;
    }
    /// x and y, the `index`th pair of RATIONALs; NaN for what is none.
    Chromaticity chromaticity(const Field& field, std::uint32_t index) {
        const auto ratio = [&](std::uint32_t i) {
            const std::size_t at = field.at + 8 * std::size_t{i};
            const bool there = field.type == 5 && i < field.count;
            return there ? number(at, 4) / static_cast<double>(number(at + 4, 4)) : std::nan("");
        };
        return {ratio(2 * index), ratio(2 * index + 1)};
    }
    std::string text(const Field& field) {
        if (field.at > bytes_.size() || field.count > bytes_.size() - field.at) {
            good_ = false;
            return {};
        }
        std::string words(bytes_.substr(field.at, field.count));
        words.erase(std::find(words.begin(), words.end(), '\0'), words.end());
        std::replace_if(
            words.begin(), words.end(), [](unsigned char letter) { return letter < 32; }, ' ');
        return words;
    }

private:
    std::string_view bytes_;
    bool little_, good_ = true;
};

void read_interoperability(Tiff& tiff, std::size_t at, ExifData& exif) {
    for (const Field& field : tiff.directory(at))
        if (field.tag == interoperability_index_tag && tiff.text(field) == "R03") exif.adobe_rgb = true;
}

void read_exif_directory(Tiff& tiff, std::size_t at, ExifData& exif) {
    for (const Field& field : tiff.directory(at)) {
        if (field.tag == focal_length_tag) exif.focal_length_mm = tiff.positive_ratio(field);
        if (field.tag == focal_length_35mm_tag && tiff.integer(field) > 0)
            exif.focal_length_35mm = tiff.integer(field);
        if (field.tag == gamma_tag) exif.gamma = tiff.positive_ratio(field);
        if (field.tag == color_space_tag) {
            const std::uint32_t space = tiff.integer(field);
            exif.srgb = space == 1;
            exif.uncalibrated = space == 0xffff;
            // The standard has no 2, but cameras and exiftool do.
            exif.adobe_rgb = exif.adobe_rgb || space == 2;
        }
        if (field.tag == interoperability_directory_tag)
            read_interoperability(tiff, tiff.integer(field), exif);
    }
}

} // namespace

ExifData read_exif(std::string_view bytes) {
    if (bytes.starts_with(std::string_view("Exif\0", 5)))
        bytes.remove_prefix(std::min<std::size_t>(6, bytes.size()));
    ExifData exif;
    Tiff tiff(bytes);
    const bool order_known = bytes.starts_with("II") || bytes.starts_with("MM");
    if (!order_known || tiff.number(2, 2) != 42) {
        exif.damaged = true;
        return exif;
    }
    Chromaticities space = rec709_chromaticities;
    for (const Field& field : tiff.directory(tiff.number(4, 4))) {
        if (field.tag == white_point_tag) space.white = tiff.chromaticity(field, 0);
        if (field.tag == primaries_tag) {
            space.red = tiff.chromaticity(field, 0);
            space.green = tiff.chromaticity(field, 1);
            space.blue = tiff.chromaticity(field, 2);
            exif.primaries = space;
        }
        if (field.tag == transfer_function_tag) exif.transfer_function = true;
        if (field.tag == orientation_tag) exif.orientation = static_cast<int>(tiff.integer(field));
        if (field.tag == make_tag) exif.make = tiff.text(field);
        if (field.tag == model_tag) exif.model = tiff.text(field);
        if (field.tag == exif_directory_tag) read_exif_directory(tiff, tiff.integer(field), exif);
    }
    if (exif.primaries) exif.primaries->white = space.white;
    // Cameras write 0 for "unknown".
    if (exif.orientation < 1 || exif.orientation > 8) exif.orientation = 1;
    exif.damaged = !tiff.good();
    return exif;
}

void note_exif(const ExifData& exif, ShotData& shot) {
    shot.focal_length_mm = exif.focal_length_mm;
    shot.focal_length_35mm = exif.focal_length_35mm;
}

std::vector<std::pair<std::string, std::string>> attributes_of(const ExifData& exif) {
    std::vector<std::pair<std::string, std::string>> attributes;
    if (!exif.make.empty() || !exif.model.empty())
        attributes.emplace_back("camera",
                                fmt::format("{}{}{}", exif.make, exif.make.empty() ? "" : " ", exif.model));
    if (exif.orientation != 1) attributes.emplace_back("EXIF orientation", std::to_string(exif.orientation));
    if (exif.focal_length_mm)
        attributes.emplace_back("focal length", fmt::format("{} mm", *exif.focal_length_mm));
    if (exif.focal_length_35mm)
        attributes.emplace_back("focal length for 35 mm film", fmt::format("{} mm", *exif.focal_length_35mm));
    return attributes;
}

} // namespace postfx
