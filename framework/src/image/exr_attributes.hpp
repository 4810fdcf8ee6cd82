// What an EXR part's attributes say, and what follows from it.
#pragma once

#include <image/color_space.hpp>
#include <image/files.hpp>

#include <OpenEXR/ImfAttribute.h>
#include <OpenEXR/ImfHeader.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace postfx::formats {

/// The value in words: numbers, text, windows; "(type, 12 bytes)" for a type that nobody here knows.
std::string attribute_text(const Imf::Attribute& attribute);

/// All of a part's attributes but its channels: name and value.
std::vector<std::pair<std::string, std::string>> attributes_of(const Imf::Header& header);

/// "Arnold", "Blender", "Unreal", "V-Ray" or "Houdini" if the attributes of that program are there, else "".
std::string program_of(const Imf::Header& header);

/// A colour space that the file names, and how it becomes Rec. 709; no matrix if it is Rec. 709 or makes no sense.
struct ExrColorSpace {
    std::string statement{}; ///< "chromaticities 1 0, 0 1, 0 0, white 0.3333 0.3333"; "" if there is none
    std::string problem{};   ///< why it can't be followed
    std::optional<ColorMatrix> to_rec709{};
};

ExrColorSpace color_space_of(const Imf::Header& header, Adaptation adaptation);

/// Follow what the part says of its pixels and its camera; `file` has its image and channels already. Light is converted,
/// measurements are left as they are.
void follow_statements(const Imf::Header& header, const ImageRequest& request, ImageFile& file);

} // namespace postfx::formats
