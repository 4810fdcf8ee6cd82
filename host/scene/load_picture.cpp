#include "assets.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#include <stb_image.h>

namespace postfx::host {

PicturePtr decode_picture(const std::uint8_t* bytes, std::size_t size, bool srgb, const std::string& name) {
    int width = 0, height = 0, channels = 0;
    stbi_set_flip_vertically_on_load_thread(1);
    stbi_uc* pixels = stbi_load_from_memory(bytes, static_cast<int>(size), &width, &height, &channels, 4);
    if (!pixels) throw Error({name, 0, 0, {}, {}}, fmt::format("not a picture: {}", stbi_failure_reason()));
    auto picture = std::make_shared<Picture>();
    picture->width = width;
    picture->height = height;
    picture->srgb = srgb;
    picture->rgba.assign(pixels,
                         pixels + static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    stbi_image_free(pixels);
    return picture;
}

PicturePtr load_picture(const std::filesystem::path& file, bool srgb) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream || bytes.empty()) throw Error({file.string(), 0, 0, {}, {}}, "can't read this texture");
    return decode_picture(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), srgb,
                          file.string());
}

} // namespace postfx::host
