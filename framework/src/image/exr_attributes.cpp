#include <image/exr_attributes.hpp>

#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfCompressionAttribute.h>
#include <OpenEXR/ImfDeepImageStateAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfIDManifestAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfKeyCodeAttribute.h>
#include <OpenEXR/ImfLineOrderAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOpaqueAttribute.h>
#include <OpenEXR/ImfPreviewImageAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfTileDescriptionAttribute.h>
#include <OpenEXR/ImfTimeCodeAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

namespace postfx::formats {
namespace {

std::string text_of(float value) {
    return fmt::format("{:.7g}", value);
}
std::string text_of(double value) {
    return fmt::format("{:.15g}", value);
}
std::string text_of(int value) {
    return fmt::format("{}", value);
}
std::string text_of(const std::string& value) {
    return value;
}
template<class T>
std::string text_of(const Imath::Vec2<T>& value) {
    return text_of(value.x) + " " + text_of(value.y);
}
template<class T>
std::string text_of(const Imath::Vec3<T>& value) {
    return text_of(value.x) + " " + text_of(value.y) + " " + text_of(value.z);
}
template<class T>
std::string text_of(const Imath::Box<T>& value) {
    return text_of(value.min) + " to " + text_of(value.max);
}
template<class T>
std::string text_of(const std::vector<T>& values) {
    std::string text;
    for (const T& value : values)
        text += (text.empty() ? "" : ", ") + text_of(value);
    return text;
}
/// Row by row, as the library has it: vectors are rows, from the left.
template<class Matrix>
std::string matrix_text(const Matrix& matrix, int size) {
    std::string text;
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column)
            text += (column > 0 ? " " : row > 0 ? ", " : "") + text_of(matrix[row][column]);
    return text;
}
std::string text_of(const Imath::M33f& value) {
    return matrix_text(value, 3);
}
std::string text_of(const Imath::M33d& value) {
    return matrix_text(value, 3);
}
std::string text_of(const Imath::M44f& value) {
    return matrix_text(value, 4);
}
std::string text_of(const Imath::M44d& value) {
    return matrix_text(value, 4);
}
std::string text_of(const Imf::Chromaticities& value) {
    return fmt::format("red {}, green {}, blue {}, white {}", text_of(value.red), text_of(value.green),
                       text_of(value.blue), text_of(value.white));
}
std::string text_of(Imf::Compression value) {
    static constexpr std::array names = {"none",  "RLE", "ZIPS", "ZIP",  "PIZ",
                                         "PXR24", "B44", "B44A", "DWAA", "DWAB"};
    const auto index = static_cast<std::size_t>(value);
    return index < names.size() ? names[index] : "unknown";
}
std::string text_of(Imf::LineOrder value) {
    return value == Imf::INCREASING_Y   ? "increasing y"
           : value == Imf::DECREASING_Y ? "decreasing y"
                                        : "random";
}
std::string text_of(Imf::Envmap value) {
    return value == Imf::ENVMAP_LATLONG ? "latitude and longitude" : "cube";
}
std::string text_of(Imf::DeepImageState value) {
    static constexpr std::array names = {"messy", "sorted", "not overlapping", "tidy"};
    const auto index = static_cast<std::size_t>(value);
    return index < names.size() ? names[index] : "unknown";
}
std::string text_of(const Imf::Rational& value) {
    return fmt::format("{}/{}", value.n, value.d);
}
std::string text_of(const Imf::TileDescription& value) {
    return fmt::format("{} x {}, {}", value.xSize, value.ySize,
                       value.mode == Imf::ONE_LEVEL       ? "one level"
                       : value.mode == Imf::MIPMAP_LEVELS ? "mipmap levels"
                                                          : "ripmap levels");
}
std::string text_of(const Imf::TimeCode& value) {
    return fmt::format("{:02}:{:02}:{:02}:{:02}", value.hours(), value.minutes(), value.seconds(),
                       value.frame());
}
std::string text_of(const Imf::KeyCode& value) {
    return fmt::format("film {} {}, prefix {}, count {}, perforation {}", value.filmMfcCode(),
                       value.filmType(), value.prefix(), value.count(), value.perfOffset());
}
std::string text_of(const Imf::PreviewImage& value) {
    return fmt::format("{} x {} pixels", value.width(), value.height());
}
std::string text_of(const Imf::CompressedIDManifest& value) {
    return fmt::format("{} bytes", value._uncompressedDataSize);
}

/// Nothing if the attribute is none of these types.
template<class... Values>
std::optional<std::string> text_of_any(const Imf::Attribute& attribute) {
    std::optional<std::string> text;
    const auto attempt = [&]<class Value>(const Imf::TypedAttribute<Value>* typed) {
        if (typed && !text) text = text_of(typed->value());
    };
    (attempt(dynamic_cast<const Imf::TypedAttribute<Values>*>(&attribute)), ...);
    return text;
}

/// colorInteropID of the Color Interop Forum: names of scene-linear spaces by their primaries.
struct NamedSpace {
    std::string_view name;
    Chromaticities space;
};

constexpr Chromaticity d65 = {0.3127, 0.3290}, d60 = {0.32168, 0.33767};
constexpr Chromaticities aces_ap0 = {{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, d60};
constexpr std::array named_spaces = {
    NamedSpace{"lin_rec709_scene", rec709_chromaticities},
    NamedSpace{"lin_ap0_scene", aces_ap0},
    NamedSpace{"lin_ap1_scene", {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, d60}},
    NamedSpace{"lin_rec2020_scene", {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65}},
    NamedSpace{"lin_p3d65_scene", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, d65}},
    NamedSpace{"lin_adobergb_scene", {{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, d65}},
    NamedSpace{"lin_ciexyzd65_scene", {{1, 0}, {0, 1}, {0, 0}, d65}},
};

Chromaticities in_double(const Imf::Chromaticities& file) {
    const auto point = [](const Imath::V2f& value) { return Chromaticity{value.x, value.y}; };
    return {point(file.red), point(file.green), point(file.blue), point(file.white)};
}

std::string string_attribute(const Imf::Header& header, const char* name) {
    const auto* text = header.findTypedAttribute<Imf::StringAttribute>(name);
    return text ? text->value() : "";
}

const char* name_of(Adaptation adaptation) {
    return adaptation == Adaptation::none ? "none" : "bradford";
}

ExrColorSpace followed(const Chromaticities& space, std::string statement, Adaptation adaptation) {
    ExrColorSpace result{.statement = std::move(statement), .problem = {}, .to_rec709 = {}};
    if (is_rec709(space)) return result;
    result.to_rec709 = matrix_to_rec709(space, adaptation);
    if (!result.to_rec709) result.problem = "they make no colour space";
    return result;
}

void convert_light(const Imf::Header& header, Adaptation adaptation, ImageFile& file) {
    const ExrColorSpace space = color_space_of(header, adaptation);
    if (!space.problem.empty())
        file.warnings.push_back(
            fmt::format("{}: {}; the colours were left as they are", space.statement, space.problem));
    if (!space.to_rec709 || file.image.channels < 3) return;
    convert_colors(file.image, *space.to_rec709);
    file.honoured.push_back(
        fmt::format("{}: converted to Rec. 709 (adaptation: {})", space.statement, name_of(adaptation)));
}

void tell_pixel_aspect(const Imf::Header& header, ImageFile& file) {
    const double ratio = header.pixelAspectRatio();
    if (!(ratio > 0) || !std::isfinite(ratio)) {
        file.warnings.push_back(
            fmt::format("pixelAspectRatio {:.7g} makes no sense and was taken for 1", ratio));
        return;
    }
    if (ratio == 1) return;
    file.shot.pixel_aspect_ratio = ratio;
    file.warnings.push_back(
        fmt::format("pixelAspectRatio {:.7g}: pixels are not square; effects take them for square", ratio));
}

void tell_white_luminance(const Imf::Header& header, ImageFile& file) {
    if (!Imf::hasWhiteLuminance(header)) return;
    file.shot.white_luminance = Imf::whiteLuminance(header);
    file.honoured.push_back(fmt::format("whiteLuminance {:.7g} cd/m2: told, nothing is scaled by it",
                                        *file.shot.white_luminance));
}

/// The library multiplies row vectors from the left, so that its rows are the columns of column vectors. The camera of
/// OpenEXR is left-handed and looks along +z (ImfStandardAttributes.h, "worldToCamera"), ours along -z.
void take_world_to_camera(const Imf::Header& header, ImageFile& file) {
    if (!Imf::hasWorldToCamera(header)) return;
    const Imath::M44f matrix = Imf::worldToCamera(header);
    std::array<double, 16> camera{};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            const double value = matrix[row][column];
            camera[static_cast<std::size_t>(4 * row + column)] = column == 2 && value != 0 ? -value : value;
        }
    for (const double value : camera)
        if (!std::isfinite(value)) {
            file.warnings.emplace_back("worldToCamera is not finite and was left out");
            return;
        }
    file.shot.world_to_camera = camera;
}

} // namespace

std::string attribute_text(const Imf::Attribute& attribute) {
    const std::optional<std::string> text =
        text_of_any<std::string, float, int, double, Imath::V2i, Imath::V2f, Imath::V2d, Imath::V3i,
                    Imath::V3f, Imath::V3d, Imath::Box2i, Imath::Box2f, Imath::M33f, Imath::M33d, Imath::M44f,
                    Imath::M44d, Imf::StringVector, Imf::FloatVector, Imf::Chromaticities, Imf::Compression,
                    Imf::LineOrder, Imf::Envmap, Imf::DeepImageState, Imf::Rational, Imf::TileDescription,
                    Imf::TimeCode, Imf::KeyCode, Imf::PreviewImage, Imf::CompressedIDManifest>(attribute);
    if (text) return *text;
    const auto* opaque = dynamic_cast<const Imf::OpaqueAttribute*>(&attribute);
    return opaque ? fmt::format("({}, {} bytes)", attribute.typeName(), opaque->dataSize())
                  : fmt::format("({})", attribute.typeName());
}

std::vector<std::pair<std::string, std::string>> attributes_of(const Imf::Header& header) {
    std::vector<std::pair<std::string, std::string>> attributes;
    for (auto i = header.begin(); i != header.end(); ++i)
        if (std::string_view(i.name()) != "channels")
            attributes.emplace_back(i.name(), attribute_text(i.attribute()));
    return attributes;
}

std::string program_of(const Imf::Header& header) {
    static constexpr std::array<std::pair<std::string_view, const char*>, 6> marks = {
        {{"arnold/", "Arnold"},
         {"BlenderMultiChannel", "Blender"},
         {"cycles.", "Blender"},
         {"unreal/", "Unreal"},
         {"vrayInfo/", "V-Ray"},
         {"karma", "Houdini"}}};
    for (auto i = header.begin(); i != header.end(); ++i)
        for (const auto& [mark, program] : marks)
            if (std::string_view(i.name()).starts_with(mark)) return program;
    return "";
}

ExrColorSpace color_space_of(const Imf::Header& header, Adaptation adaptation) {
    if (Imf::hasChromaticities(header)) {
        const Imf::Chromaticities& file = Imf::chromaticities(header);
        return followed(in_double(file), "chromaticities " + text_of(file), adaptation);
    }
    const auto* aces = header.findTypedAttribute<Imf::IntAttribute>("acesImageContainerFlag");
    if (aces && aces->value() == 1) return followed(aces_ap0, "acesImageContainerFlag 1", adaptation);
    const std::string id = string_attribute(header, "colorInteropID");
    if (id.empty() || id == "unknown" || id == "data") return {};
    for (const NamedSpace& named : named_spaces)
        if (named.name == id) return followed(named.space, "colorInteropID " + id, adaptation);
    return {.statement = "colorInteropID " + id,
            .problem = "no such scene-linear space is known",
            .to_rec709 = {}};
}

void follow_statements(const Imf::Header& header, const ImageRequest& request, ImageFile& file) {
    if (is_light(request.role)) convert_light(header, request.adaptation, file);
    if (request.role == Role::color) {
        tell_pixel_aspect(header, file);
        tell_white_luminance(header, file);
        if (Imf::hasEnvmap(header))
            file.warnings.push_back(fmt::format("envmap: an environment ({}) is taken as a flat picture",
                                                text_of(Imf::envmap(header))));
    }
    take_world_to_camera(header, file);
}

} // namespace postfx::formats
