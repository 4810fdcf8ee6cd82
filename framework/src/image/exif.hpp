// What a camera wrote beside a photograph: EXIF (CIPA DC-008), a TIFF of its own inside of JPEG, PNG, WebP and HEIC.
#pragma once

#include <image/color_space.hpp>
#include <image/files.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace postfx {

struct ExifData {
    int orientation = 1; ///< 1 to 8; 1 also for numbers that mean nothing
    std::optional<double> focal_length_mm{}, focal_length_35mm{};
    bool adobe_rgb = false; ///< DCF's optional colour space, "R03"
    bool srgb = false;
    bool uncalibrated = false;                 ///< neither sRGB nor Adobe RGB: a profile has to say which
    std::optional<double> gamma{};             ///< from codes to light
    std::optional<Chromaticities> primaries{}; ///< with the white point, D65 if it states none
    bool transfer_function = false;            ///< a table, which is not read
    bool damaged = false; ///< its structure is wrong somewhere; what could be read is here
    std::string make{}, model{};
};

/// `tiff`: from "II" or "MM" on, or with "Exif\0\0" before it. Never throws: the picture is good without.
ExifData read_exif(std::string_view tiff);

/// Into what is known of the shot; its orientation is left to who turns the picture.
void note_exif(const ExifData& exif, ShotData& shot);

/// As `postfx inspect` lists it.
std::vector<std::pair<std::string, std::string>> attributes_of(const ExifData& exif);

} // namespace postfx
