// Image files: PNG, JPEG, HDR, EXR, PFM to and from float pixels.
#pragma once

#include <postfx/image.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace postfx {

/// What was in an image file.
struct ImageFile {
    Image image;           ///< RGB or RGBA (1 or 2 channels if the file has no colour); scene-linear
    bool was_8bit = false; ///< PNG/JPEG with 8 bits per channel: sRGB-decoded here
    /// EXR: what is not in `image`, grouped by prefix: "Z" (1 channel), "N" (3), "left" (4), "left.Z" (1) ...
    std::map<std::string, Image> layers;
};

/// Read any supported file, by content. PNG and JPEG are sRGB-decoded to linear light, alpha is not. EXR: the
/// display window; pixels outside the data window are 0 (and so is what the file leaves out); of stereo views
/// the default one, or the first. Throws Error naming the file: missing, truncated, unknown kind, absurd size
/// (more than 32768 pixels a side or 2^28 in all), no colour.
ImageFile read_image(const std::filesystem::path& file);

/// Read a file of data, not light (depth, normals): PNG values are divided by their maximum, nothing is
/// decoded. `layer` selects an EXR channel or group ("Z", "depth.Z", "N"); "" = the one named Z or depth,
/// else the colour.
Image read_data(const std::filesystem::path& file, const std::string& layer = "");

/// 8-bit codes, 1 to 4 channels, bottom row first, written as PNG.
void write_png(const std::filesystem::path& file, int width, int height, int channels,
               const std::vector<std::uint8_t>& codes);

/// By ending: .exr, .pfm: 1 to 4 channels of float, bits kept (half: beyond 65504 becomes infinity); .hdr: 8
/// bits of mantissa, nothing negative; .png: sRGB-encoded and rounded, clamped to [0, 1], NaN is 0. HDR and
/// PFM have no alpha: it is left out. Written beside and renamed, so an existing file is never left
/// half-written. Throws Error naming the file.
struct ExrOptions {
    bool half = false;
    std::string kind{}; ///< "png", "exr", "hdr" or "pfm", whatever the file's ending; "" = by its ending
};
void write_image(const std::filesystem::path& file, const Image& image, const ExrOptions& options = {});

/// Is `file`'s ending, or `kind` where it is given, one that write_image knows? Throws Error (naming the kinds) if not.
void check_writable_kind(const std::filesystem::path& file, const std::string& kind = "");
/// .png: an 8-bit display-referred file.
bool is_display_kind(const std::filesystem::path& file, const std::string& kind = "");

/// Throws Error when the folder that `file`, or what it is a link to, would be written to is not there.
void check_output_folder(const std::filesystem::path& file);

/// Write bytes so that `file` is either the old one or the whole new one. Links are written through, to what is not
/// there yet too; write protection is kept; devices and pipes are written to, and standard output when `file` is "-".
/// Throws Error naming the file and the cause.
void write_file_atomically(const std::filesystem::path& file, const std::string& bytes);

} // namespace postfx
