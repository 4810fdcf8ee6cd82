// A picture as its file stores it, and what the file says of it. What every reader of colour codes makes, and the one
// place where that becomes what was asked for.
#pragma once

#include <image/color_statement.hpp>
#include <image/exif.hpp>
#include <image/files.hpp>

#include <string>
#include <utility>
#include <vector>

namespace postfx {

struct StoredPicture {
    /// Rows from the bottom. Samples as they are stored, not yet divided by `largest`: grey, RGB, either with alpha as
    /// the last channel, or CMYK as amounts of ink.
    Image samples{};
    double largest = 255; ///< what stands for 1
    Coding coding{.numbers = Coding::Numbers::codes, .bits = 8};
    bool cmyk = false;
    ColorStatement color{};
    int orientation = 1; ///< EXIF, not yet applied
    ShotData shot{};
    std::vector<std::pair<std::string, std::string>> attributes{};
    std::vector<std::string> warnings{};

    int color_channels() const {
        return cmyk ? 4 : samples.channels - (coding.alpha == Coding::Alpha::none ? 0 : 1);
    }
};

/// Take what EXIF says of the shot and of the orientation; its colour space only where `color` says nothing.
void take_exif(StoredPicture& picture, std::string_view tiff, bool color_is_said);

/// Codes that are multiplied by their alpha become those of straight alpha: only light can be multiplied by it.
void divide_codes_by_alpha(StoredPicture& picture);

/// A warning where the pixels of a picture are not square.
void tell_pixel_shape(ImageFile& file);

/// Light by the colour statement, measurements and textures by dividing; turned as the camera was held, but for a
/// texture.
ImageFile as_asked(StoredPicture picture, const ImageRequest& request);

/// For `postfx inspect`.
ImageDescription described(const char* kind, StoredPicture picture);

} // namespace postfx
