// Image files to and from float pixels: who asks says in which role, and gets what the file says of its pixels.
#pragma once

#include <image/color_space.hpp>
#include <image/description.hpp>
#include <image/role.hpp>

#include <postfx/image.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace postfx {

/// A file's bytes, read once: a pipe gives them only once, and one file may hold several roles.
struct ImageSource {
    std::filesystem::path name{}; ///< for messages; "-" is standard input
    std::string bytes{};
};

/// Read a regular file, a pipe, or standard input ("-"). Throws Error naming the file: missing, a directory, empty,
/// unreadable, too large.
ImageSource open_image(const std::filesystem::path& file);

/// What is asked of a file.
struct ImageRequest {
    Role role = Role::color;
    std::string
        layer{}; ///< a layer or channel by its name (EXR); "" = by the conventions of the programs that write it
    std::string view{}; ///< a stereo view by its name; "" = the file's default one
    std::string
        beside{}; ///< the layer of this file that is taken for the colour: what was rendered with it comes
                  ///< first (EXR)
    Adaptation adaptation = Adaptation::none;
};

/// How the file's samples were coded.
struct Coding {
    enum class Numbers { codes, half, single }; ///< unsigned integers of `bits`, or floating point
    enum class Alpha { none, straight, premultiplied };
    Numbers numbers = Numbers::single;
    int bits = 32;           ///< per channel
    bool plain_srgb = false; ///< colour was sRGB codes: encoding it again gives the same codes
    Alpha alpha = Alpha::none;
};

/// What a sample of a depth map means, where the file itself says it.
struct DepthScale {
    enum class Kind { metres, dioptres }; ///< along the view axis, or their inverse
    Kind kind = Kind::metres;
    double at_zero = 0, at_one = 1; ///< what the samples 0 and 1 stand for, linear between
};

/// What the axes of a normal are.
enum class NormalSpace { view, world };

/// What the file says of the camera.
struct ShotData {
    std::optional<double> focal_length_mm,
        focal_length_35mm{}; ///< EXIF; the latter for a 36 x 24 mm frame's diagonal
    std::optional<std::array<double, 16>>
        world_to_camera{};                      ///< column major, column vectors, the camera looks down -z
    std::optional<double> pixel_aspect_ratio{}; ///< width over height of a pixel, if not 1
    std::optional<double> white_luminance{};    ///< cd/m^2 of RGB 1 1 1; told, never scaled by
    int orientation = 1;                        ///< EXIF 1..8 that has been applied already
};

/// What was in an image file.
struct ImageFile {
    /// Light is scene-linear Rec. 709; 1 or 2 channels if the file has no colour. Rows from the bottom.
    Image image{};
    Coding coding{};
    std::string layer{}, view{}; ///< what was taken, "" where the file has only one
    ShotData shot{};
    bool has_depth_map = false; ///< role color: the same file has a depth map of its own, as phones make them
    std::optional<DepthScale> depth_scale{}; ///< role depth only
    std::optional<NormalSpace>
        normal_space{};                  ///< role normal only: by the layer's name, or who wrote the file
    std::vector<std::string> honoured{}; ///< what the file says of its pixels and was followed, one line each
    std::vector<std::string> warnings{}; ///< what was brought into shape or had to be left out, one line each
};

/// Read any supported file, by content, in the role that is asked for. Alpha is never decoded. EXR: the display
/// window; pixels outside the data window are 0 (and so is what the file leaves out). Throws Error naming the file:
/// missing, truncated, unknown kind, absurd size (more than 32768 pixels a side or 2^28 in all), nothing for the
/// role, or several things that are equally good for it (with their names).
ImageFile read_image(const ImageSource& source, const ImageRequest& request = {});
ImageFile read_image(const std::filesystem::path& file, const ImageRequest& request = {});

/// What is in the file, without its pixels, and what would be taken in which role.
ImageDescription describe_image(const ImageSource& source);

/// The file that a picture was taken from, and how it was asked for.
struct Origin {
    const ImageSource* source = nullptr;
    ImageRequest request{};
};

/// How a file is written.
struct WriteOptions {
    /// .exr: write the origin, if it is an EXR, with the picture in place of the one that was taken: other layers,
    /// parts, views, windows and attributes stay as they are, bit for bit, and so do pixels that have not changed.
    /// `half` is then ignored: channels keep their types.
    const Origin* origin = nullptr;
    bool half = false;     ///< .exr: half instead of float; beyond 65504 becomes infinity
    int bits = 8;          ///< .png: 8 or 16
    double quality = 0.92; ///< .jpg: 0..1
    std::string kind{};    ///< "png", "exr", ..., whatever the file's ending; "" = by its ending
};

/// 8-bit sRGB codes, 1 to 4 channels, bottom row first, written as PNG, or without alpha as JPEG, by the ending.
void write_codes(const std::filesystem::path& file, const BasicImage<std::uint8_t>& codes,
                 const WriteOptions& options = {});

/// By ending: .exr, .pfm: 1 to 4 channels of float, bits kept; .hdr: 8 bits of mantissa, nothing negative; .png, .jpg:
/// sRGB-encoded and rounded, clamped to [0, 1], NaN is 0. HDR, PFM and JPEG have no alpha: it is left out. Written
/// beside and renamed, so an existing file is never left half-written. Throws Error naming the file. Returns what could
/// not be kept of the origin, one line each.
std::vector<std::string> write_image(const std::filesystem::path& file, const Image& image,
                                     const WriteOptions& options = {});

/// "png", "jpg", "exr", ...: `kind` where it is given, else the file's ending, in small letters; jpeg is jpg. "" for none.
std::string written_kind(const std::filesystem::path& file, const std::string& kind = "");
/// Is `file`'s ending, or `kind` where it is given, one that write_image knows? Throws Error (naming the kinds) if not.
void check_writable_kind(const std::filesystem::path& file, const std::string& kind = "");
/// .png, .jpg: a display-referred file.
bool is_display_kind(const std::filesystem::path& file, const std::string& kind = "");

/// Throws Error when the folder that `file`, or what it is a link to, would be written to is not there.
void check_output_folder(const std::filesystem::path& file);

/// Write bytes so that `file` is either the old one or the whole new one. Links are written through, to what is not
/// there yet too; write protection is kept; devices and pipes are written to, and standard output when `file` is "-".
/// Throws Error naming the file and the cause.
void write_file_atomically(const std::filesystem::path& file, const std::string& bytes);

} // namespace postfx
