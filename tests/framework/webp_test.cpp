// WebP files, made by libwebp.
#include "icc_profiles.hpp"
#include "image_checks.hpp"

#include <image/srgb.hpp>

#include <webp/encode.h>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// Without loss; `codes` of RGBA, top row first.
std::string webp_of(int width, int height, const std::vector<std::uint8_t>& codes) {
    std::uint8_t* bytes = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(codes.data(), width, height, 4 * width, &bytes);
    std::string result(reinterpret_cast<char*>(bytes), size);
    WebPFree(bytes);
    return result;
}

std::string little(std::size_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i)
        text += static_cast<char>(value >> (8 * i));
    return text;
}

std::string chunk(const std::string& name, const std::string& data) {
    return name + little(data.size(), 4) + data + std::string(data.size() % 2, '\0');
}

/// The extended format around a simple file: flags, then `before` and `after` its picture.
std::string extended(const std::string& simple, int width, int height, int flags, const std::string& before,
                     const std::string& after) {
    const std::string head = little(static_cast<std::size_t>(flags), 4)
                             + little(static_cast<std::size_t>(width - 1), 3)
                             + little(static_cast<std::size_t>(height - 1), 3);
    const std::string body = "WEBP" + chunk("VP8X", head) + before + simple.substr(12) + after;
    return "RIFF" + little(body.size(), 4) + body;
}

ImageFile read_webp(const std::string& bytes, Role role = Role::color) {
    return read_image(ImageSource{"a.webp", bytes}, {.role = role});
}

} // namespace

TEST_CASE("WebP: codes, alpha, profile and EXIF") {
    const std::string opaque = webp_of(2, 1, {255, 0, 0, 255, 0, 51, 255, 255});
    const ImageFile plain = read_webp(opaque);
    CHECK(plain.coding.plain_srgb);
    CHECK(plain.image.values == std::vector<float>{1, 0, 0, 0, static_cast<float>(srgb_to_linear(0.2)), 1});
    const ImageFile alpha = read_webp(webp_of(1, 1, {255, 51, 0, 51}), Role::data);
    CHECK(alpha.coding.alpha == Coding::Alpha::straight);
    CHECK(alpha.image.values == std::vector<float>{1, 0.2f, 0, 0.2f});

    constexpr int has_profile = 0x20, has_exif = 0x08;
    const ImageFile wide = read_webp(extended(opaque, 2, 1, has_profile, chunk("ICCP", p3_profile(1)), ""));
    CHECK(wide.image.values[0] == Approx(1.22494).margin(1e-4));
    const std::string exif("II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0\6\0\0\0\0\0\0\0", 26);
    const ImageFile turned = read_webp(extended(opaque, 2, 1, has_exif, "", chunk("EXIF", exif)));
    REQUIRE((turned.image.width == 1 && turned.image.height == 2));
    CHECK(turned.image.at(0, 1, 0) == 1);
}

TEST_CASE("WebP files that are cut off are refused") {
    std::vector<std::uint8_t> codes(4 * 32 * 32);
    for (std::size_t i = 0; i < codes.size(); ++i)
        codes[i] = static_cast<std::uint8_t>(i * i % 251);
    const std::string whole = webp_of(32, 32, codes);
    REQUIRE_NOTHROW(read_webp(whole));
    for (std::size_t size = 0; size + 2 < whole.size(); size += 97) {
        CAPTURE(size);
        CHECK_THROWS_AS(read_webp(whole.substr(0, size)), Error);
    }
}
