#include <image/formats.hpp>
#include <image/orientation.hpp>
#include <image/srgb.hpp>
#include <image/stored_picture.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx {
namespace {

/// Tables are made for codes of up to 16 bits.
constexpr double largest_table = 65535;

/// Change the colour channels, or the alpha, of every pixel.
template<class Change>
void change_channels(Image& image, int begin, int end, Change change) {
    for (std::size_t i = 0; i < image.values.size(); i += static_cast<std::size_t>(image.channels))
        for (int channel = begin; channel < end; ++channel) {
            float& value = image.values[i + static_cast<std::size_t>(channel)];
            value = change(value);
        }
}

/// Samples become `curve` of their share of the largest one.
void apply_curve(StoredPicture& picture, int begin, int end, const std::function<double(double)>& curve) {
    const double largest = picture.largest;
    const auto directly = [&](float sample) { return static_cast<float>(curve(sample / largest)); };
    if (picture.coding.numbers != Coding::Numbers::codes || largest > largest_table) {
        change_channels(picture.samples, begin, end, directly);
        return;
    }
    std::vector<float> table(static_cast<std::size_t>(largest) + 1);
    for (std::size_t code = 0; code < table.size(); ++code)
        table[code] = directly(static_cast<float>(code));
    change_channels(picture.samples, begin, end,
                    [&](float sample) { return table[static_cast<std::size_t>(sample)]; });
}

double itself(double share) {
    return share;
}

/// From shares of the largest sample to light, pixel by pixel, keeping alpha.
Image by_profile(const Image& shares, const IccProfile& profile) {
    const int inputs = profile.channels(), outputs = profile.light_channels();
    const int alphas = shares.channels - inputs;
    Image light(shares.width, shares.height, outputs + alphas);
    const auto width = static_cast<std::size_t>(shares.width);
    std::vector<float> colors(width * static_cast<std::size_t>(inputs)),
        row(width * static_cast<std::size_t>(outputs));
    for (int y = 0; y < shares.height; ++y) {
        for (int x = 0; x < shares.width; ++x)
            std::copy_n(shares.pixel(x, y), inputs, &colors[static_cast<std::size_t>(x * inputs)]);
        profile.to_light(colors.data(), row.data(), width);
        for (int x = 0; x < shares.width; ++x) {
            std::copy_n(&row[static_cast<std::size_t>(x * outputs)], outputs, light.pixel(x, y));
            std::copy_n(shares.pixel(x, y) + inputs, alphas, light.pixel(x, y) + outputs);
        }
    }
    return light;
}

/// Ink that lets through what it does not cover: what is done where nobody says what the inks look like.
void print_plainly(StoredPicture& picture) {
    Image colors(picture.samples.width, picture.samples.height, 3);
    const auto largest = static_cast<float>(picture.largest);
    for (std::size_t pixel = 0; pixel < colors.pixel_count(); ++pixel) {
        const float* ink = &picture.samples.values[4 * pixel];
        for (std::size_t channel = 0; channel < 3; ++channel)
            colors.values[3 * pixel + channel] =
                std::round((largest - ink[channel]) * (largest - ink[3]) / largest);
    }
    picture.samples = std::move(colors);
    picture.cmyk = false;
}

void make_light(StoredPicture& picture) {
    const int colors = picture.color_channels(), channels = picture.samples.channels;
    if (picture.color.profile) {
        apply_curve(picture, 0, channels, itself);
        picture.samples = by_profile(picture.samples, *picture.color.profile);
        return;
    }
    const bool codes = picture.coding.numbers == Coding::Numbers::codes;
    const auto unsaid = codes ? srgb_to_linear : itself;
    apply_curve(picture, 0, colors, picture.color.to_light ? picture.color.to_light : unsaid);
    apply_curve(picture, colors, channels, itself);
    if (picture.color.to_rec709 && colors == 3) convert_colors(picture.samples, *picture.color.to_rec709);
}

Image turned(const StoredPicture& picture, Role role) {
    if (role != Role::normal) return oriented(picture.samples, picture.orientation);
    const bool codes = picture.coding.numbers == Coding::Numbers::codes;
    return oriented_normals(picture.samples, picture.orientation,
                            codes ? VectorCoding::halves : VectorCoding::as_they_are);
}

void append(std::vector<std::string>& lines, const std::vector<std::string>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
}

} // namespace

void take_exif(StoredPicture& picture, std::string_view tiff, bool color_is_said) {
    const ExifData exif = read_exif(tiff);
    if (exif.damaged) picture.warnings.emplace_back("its EXIF is damaged; what of it could be read was");
    picture.orientation = exif.orientation;
    note_exif(exif, picture.shot);
    for (auto& attribute : attributes_of(exif))
        picture.attributes.push_back(std::move(attribute));
    if (color_is_said || exif.srgb) return;
    if (exif.adobe_rgb) {
        picture.color = adobe_rgb_color();
        return;
    }
    picture.color = color_of_colorimetry("EXIF", exif.gamma, exif.primaries);
    if (exif.transfer_function)
        picture.color.warnings.emplace_back("EXIF: its TransferFunction is not followed; taken as sRGB's");
    else if (exif.uncalibrated && picture.color.is_plain_srgb())
        picture.color.warnings.emplace_back(
            "EXIF says that its colours are not sRGB, and nothing says what they are; "
            "taken as sRGB");
}

void divide_codes_by_alpha(StoredPicture& picture) {
    constexpr double finer = 65535;
    const auto channels = static_cast<std::size_t>(picture.samples.channels);
    for (std::size_t i = 0; i < picture.samples.values.size(); i += channels) {
        const double alpha = picture.samples.values[i + channels - 1] / picture.largest;
        for (std::size_t channel = 0; channel < channels; ++channel) {
            float& sample = picture.samples.values[i + channel];
            const double divisor = channel + 1 < channels && alpha > 0 ? alpha : 1;
            sample =
                static_cast<float>(std::round(std::min(1.0, sample / picture.largest / divisor) * finer));
        }
    }
    picture.largest = finer;
    picture.coding.bits = 16;
    picture.coding.alpha = Coding::Alpha::straight;
}

void tell_pixel_shape(ImageFile& file) {
    // Densities are whole numbers, so that equal ones may differ by rounding.
    constexpr double rounding = 1e-3;
    const double ratio = file.shot.pixel_aspect_ratio.value_or(1);
    if (std::abs(ratio - 1) > rounding)
        file.warnings.push_back(fmt::format(
            "pixel aspect ratio {:.4g}: pixels are not square; effects take them for square", ratio));
}

ImageFile as_asked(StoredPicture picture, const ImageRequest& request) {
    ImageFile file;
    file.coding = picture.coding;
    file.coding.plain_srgb =
        picture.color.is_plain_srgb() && !picture.cmyk && picture.coding.numbers == Coding::Numbers::codes;
    file.warnings = picture.warnings;
    if (picture.cmyk && !(is_light(request.role) && picture.color.profile)) {
        if (is_light(request.role))
            file.warnings.emplace_back(
                "it is CMYK without an ICC profile: converted as if its inks were ideal");
        print_plainly(picture);
    }
    if (is_light(request.role)) {
        append(file.honoured, picture.color.honoured);
        append(file.warnings, picture.color.warnings);
        make_light(picture);
    } else {
        apply_curve(picture, 0, picture.samples.channels, itself);
    }
    file.shot = picture.shot;
    if (request.role != Role::texture && picture.orientation != 1) {
        file.honoured.push_back(fmt::format("EXIF orientation {}: turned", picture.orientation));
        file.shot.orientation = picture.orientation;
        picture.samples = turned(picture, request.role);
        if (file.shot.pixel_aspect_ratio && exchanges_sides(picture.orientation))
            file.shot.pixel_aspect_ratio = 1 / *file.shot.pixel_aspect_ratio;
    }
    file.image = std::move(picture.samples);
    if (request.role == Role::color) tell_pixel_shape(file);
    return file;
}

ImageDescription described(const char* kind, StoredPicture picture) {
    const bool codes = picture.coding.numbers == Coding::Numbers::codes;
    const std::string type = codes ? fmt::format("{} bit", picture.coding.bits)
                             : picture.coding.numbers == Coding::Numbers::half ? "half"
                                                                               : "float";
    std::vector<std::pair<std::string, std::string>> attributes = picture.attributes;
    if (picture.cmyk) attributes.emplace_back("colour", "CMYK");
    if (picture.coding.alpha != Coding::Alpha::none)
        attributes.emplace_back("alpha", picture.coding.alpha == Coding::Alpha::straight ? "straight"
                                                                                         : "premultiplied");
    const ImageFile file = as_asked(std::move(picture), {});
    ImageDescription description = formats::description_of_one(kind, file.image, type);
    description.parts.front().attributes = std::move(attributes);
    description.honoured = file.honoured;
    description.warnings = file.warnings;
    return description;
}

} // namespace postfx
