// PNG files of ours: sRGB, and they say so.
#include <image/c_errors.hpp>

#include <fmt/format.h>

#include <png.h>

#include <bit>

namespace postfx::formats {
namespace {

struct Output {
    std::string bytes{};
    JumpTarget target{};
};

[[noreturn]] void jump(png_structp png, png_const_charp message) {
    auto& target = static_cast<Output*>(png_get_error_ptr(png))->target;
    target.message = message;
    std::longjmp(target.place, 1);
}

void append(png_structp png, png_bytep data, std::size_t size) {
    static_cast<Output*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(data), size);
}

int color_type_of(int channels) {
    static constexpr int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                    PNG_COLOR_TYPE_RGB_ALPHA};
    return types[channels - 1];
}

/// `rows` from the top.
template<class Code>
void write_all(png_structp png, png_infop info, const BasicImage<Code>& codes, png_bytepp rows) {
    png_set_user_limits(png, max_side, max_side);
    png_set_IHDR(png, info, static_cast<png_uint_32>(codes.width), static_cast<png_uint_32>(codes.height),
                 8 * sizeof(Code), color_type_of(codes.channels), PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    // With the gamma and the primaries of sRGB for those who don't know the word.
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_RELATIVE);
    png_write_info(png, info);
    if (sizeof(Code) == 2 && std::endian::native == std::endian::little) png_set_swap(png);
    png_write_image(png, rows);
    png_write_end(png, info);
}

template<class Code>
std::string encoded(const Path& file, const BasicImage<Code>& codes) {
    std::vector<png_bytep> rows;
    for (int y = codes.height - 1; y >= 0; --y)
        rows.push_back(reinterpret_cast<png_bytep>(const_cast<Code*>(codes.pixel(0, y))));
    Output output;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, jump, nullptr);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool done = info && done_without_jump(output.target, [&] {
                          png_set_write_fn(png, &output, append, nullptr);
                          write_all(png, info, codes, rows.data());
                      });
    png_destroy_write_struct(&png, &info);
    if (!done) fail(file, fmt::format("no PNG could be made ({})", output.target.message));
    return std::move(output.bytes);
}

} // namespace

std::string png_bytes(const Path& file, const BasicImage<std::uint8_t>& codes) {
    return encoded(file, codes);
}

std::string png_bytes(const Path& file, const BasicImage<std::uint16_t>& codes) {
    return encoded(file, codes);
}

} // namespace postfx::formats
