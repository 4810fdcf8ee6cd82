// What a file says of its colours: how its numbers become light. Every format with colour codes says it with this.
#pragma once

#include <image/color_space.hpp>
#include <image/icc.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace postfx {

/// Without a word it is sRGB, as everything that shows pictures takes it.
struct ColorStatement {
    std::function<double(double)>
        to_light{}; ///< light of a sample (1 is the largest code); nothing: sRGB's curve
    std::optional<ColorMatrix> to_rec709{};      ///< of that light; nothing: it is Rec. 709
    std::shared_ptr<const IccProfile> profile{}; ///< instead of both
    std::vector<std::string> honoured{}, warnings{};

    bool is_plain_srgb() const { return !to_light && !to_rec709 && !profile; }
};

/// By the primaries and the curve of ITU-T H.273 (code points), as `cICP` of PNG and `nclx` of HEIC have them.
/// Narrow range: RGB codes 16 to 235 of 8 bits, and so on for more. `where` begins what is told: "PNG cICP". Code
/// points that mean nothing here leave sRGB and a warning. White becomes the white of Rec. 709.
ColorStatement color_of_cicp(const std::string& where, int primaries, int transfer, bool full_range,
                             int bits);

/// By an ICC profile for `channels` (1 grey, 3 RGB, 4 CMYK) of colour. A damaged one, or one for other channels, leaves
/// sRGB and a warning; one that is sRGB itself, whatever its name, leaves sRGB.
ColorStatement color_of_icc(std::string_view profile, int channels);

/// By an exponent from codes to light (nothing: sRGB's curve) and by primaries (nothing: Rec. 709), as EXIF and TIFF state
/// them. `where` begins what is told. Primaries that make no colour space leave Rec. 709 and a warning.
ColorStatement color_of_colorimetry(const std::string& where, std::optional<double> gamma,
                                    const std::optional<Chromaticities>& space);

/// Adobe RGB (1998), which EXIF can name without a profile.
ColorStatement adobe_rgb_color();

} // namespace postfx
