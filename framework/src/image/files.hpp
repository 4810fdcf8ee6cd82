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
    Image image;                        ///< RGB or RGBA (1 or 2 channels if the file has no colour); scene-linear
    bool was_8bit = false;              ///< PNG/JPEG with 8 bits per channel: sRGB-decoded here
    std::map<std::string, Image> layers; ///< EXR: further channels, grouped: "Z", "N" (3), "left.R" ... as in the file
};

/// Read any supported file, by content where possible. PNG and JPEG are sRGB-decoded to linear light, alpha is not.
/// EXR: the display window, pixels outside the data window are 0 (and so is what the file leaves out).
/// Throws Error naming the file: missing, truncated, unknown kind, absurd size.
ImageFile read_image(const std::filesystem::path& file);

/// Read a file of data, not light (depth, normals): PNG values are divided by their maximum, nothing is decoded.
/// `layer` selects an EXR channel or group ("Z", "depth.Z", "N"); "" = the obvious one for that file.
Image read_data(const std::filesystem::path& file, const std::string& layer = "");

/// 8-bit codes, 3 or 4 channels, bottom row first, written as PNG.
void write_png(const std::filesystem::path& file, int width, int height, int channels,
               const std::vector<std::uint8_t>& codes);

/// By ending: .exr (float or half), .hdr, .pfm: linear values as they are; .png: sRGB-encoded and rounded.
/// Written beside and renamed, so an existing file is never left half-written. Throws Error naming the file.
struct ExrOptions {
    bool half = false;
};
void write_image(const std::filesystem::path& file, const Image& image, const ExrOptions& options = {});

/// Is `file`'s ending one that write_image knows? Throws Error (naming the endings) if not.
void check_writable_kind(const std::filesystem::path& file);
/// .png: an 8-bit display-referred file.
bool is_display_kind(const std::filesystem::path& file);

/// Write bytes so that `file` is either the old one or the whole new one.
void write_file_atomically(const std::filesystem::path& file, const std::string& bytes);

} // namespace postfx
