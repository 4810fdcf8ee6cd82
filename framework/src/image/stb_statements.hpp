// What BMP, TGA and PSD say of their pixels and stb_image does not read.
#pragma once

#include <image/stored_picture.hpp>

#include <string_view>

namespace postfx::formats {

/// Profiles, calibrated colours and the density of the header versions 3 to 5.
void take_bmp_statements(std::string_view bytes, StoredPicture& picture);

/// Pixels from right to left; gamma, the kind of alpha and the pixels' shape of version 2's extension area.
void take_tga_statements(std::string_view bytes, StoredPicture& picture);

/// Profile, EXIF and the pixels' shape among the image resources.
void take_psd_statements(std::string_view bytes, StoredPicture& picture);

/// 16, where stb_image would give 8 bits of them; 8 for other kinds.
int psd_bits(std::string_view bytes);

/// Why stb_image would read this BMP or PSD wrongly or not at all; "" if nothing is known against it.
std::string problem_of(std::string_view bytes);

} // namespace postfx::formats
