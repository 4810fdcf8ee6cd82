// Stands for heic.cpp where libheif was not there when this was built.
#include <image/formats.hpp>

namespace postfx::formats {
namespace {

bool recognises_heic(std::string_view bytes) {
    return bytes.size() >= 12 && bytes.substr(4, 4) == "ftyp";
}

ImageFile read_heic(const ImageSource& source, const ImageRequest&) {
    fail(source.name, "this build has no HEIC; with the package libheif-dev, build again");
}

ImageDescription describe_heic(const ImageSource& source) {
    fail(source.name, "this build has no HEIC; with the package libheif-dev, build again");
}

} // namespace

const Format heic = {"HEIC", recognises_heic, read_heic, describe_heic};

} // namespace postfx::formats
