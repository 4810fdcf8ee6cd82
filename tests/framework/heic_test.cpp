// HEIC files, made by libheif and changed where it writes less than phones do; and a phone's own.
#include "icc_profiles.hpp"
#include "image_checks.hpp"

#include <image/srgb.hpp>

#include <libheif/heif.h>

#include <cmath>
#include <functional>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// Of one colour, 128 x 64 pixels: smaller ones would be padded and cut.
heif_image* picture_of(const std::vector<std::uint8_t>& codes) {
    heif_image* image = nullptr;
    const bool alpha = codes.size() == 4;
    heif_image_create(128, 64, heif_colorspace_RGB,
                      alpha ? heif_chroma_interleaved_RGBA : heif_chroma_interleaved_RGB, &image);
    heif_image_add_plane(image, heif_channel_interleaved, 128, 64, 8);
    int stride = 0;
    std::uint8_t* bytes = heif_image_get_plane(image, heif_channel_interleaved, &stride);
    for (int y = 0; y < 64; ++y)
        for (int i = 0; i < 128 * static_cast<int>(codes.size()); ++i)
            bytes[y * stride + i] = codes[static_cast<std::size_t>(i) % codes.size()];
    return image;
}

heif_error append(heif_context*, const void* data, std::size_t size, void* to) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), size);
    return {heif_error_Ok, heif_suberror_Unspecified, ""};
}

/// "" if this libheif can't write any.
std::string heic_of(const std::vector<std::uint8_t>& codes,
                    const std::function<void(heif_image*, heif_encoding_options*)>& before = {},
                    const std::function<void(heif_context*, heif_image_handle*)>& after = {},
                    heif_orientation orientation = heif_orientation_normal) {
    heif_context* context = heif_context_alloc();
    heif_encoder* encoder = nullptr;
    std::string bytes;
    if (heif_context_get_encoder_for_format(context, heif_compression_HEVC, &encoder).code == heif_error_Ok) {
        heif_encoder_set_lossless(encoder, 1);
        heif_image* image = picture_of(codes);
        heif_encoding_options* options = heif_encoding_options_alloc();
        options->image_orientation = orientation;
        if (before) before(image, options);
        heif_image_handle* handle = nullptr;
        REQUIRE(heif_context_encode_image(context, image, encoder, options, &handle).code == heif_error_Ok);
        if (after) after(context, handle);
        heif_writer writer{1, append};
        heif_context_write(context, &writer, &bytes);
        heif_image_handle_release(handle);
        heif_encoding_options_free(options);
        heif_image_release(image);
        heif_encoder_release(encoder);
    } else {
        WARN("skipped: this libheif has no encoder");
    }
    heif_context_free(context);
    return bytes;
}

std::uint32_t number_at(const std::string& bytes, std::size_t at, std::size_t size) {
    std::uint32_t number = 0;
    for (std::size_t i = at; i < at + size; ++i)
        number = number << 8 | static_cast<std::uint8_t>(bytes.at(i));
    return number;
}

void add_to_number(std::string& bytes, std::size_t at, std::size_t more) {
    const std::uint32_t number = number_at(bytes, at, 4) + static_cast<std::uint32_t>(more);
    for (std::size_t i = 0; i < 4; ++i)
        bytes[at + i] = static_cast<char>(number >> (24 - 8 * i));
}

/// Every offset of the item location box, of 4 bytes each.
void shift_items(std::string& bytes, std::size_t more) {
    std::size_t at = bytes.find("iloc") + 4;
    const std::uint32_t version = number_at(bytes, at, 1), sizes = number_at(bytes, at + 4, 2);
    REQUIRE((version <= 1 && sizes >> 12 == 4));
    const std::size_t length_size = sizes >> 8 & 15, base_size = sizes >> 4 & 15, index_size = sizes & 15;
    std::size_t items = number_at(bytes, at + 6, 2);
    at += 8;
    for (; items > 0; --items) {
        at += 2 + (version == 1 ? 2 : 0) + 2 + base_size; // number, construction, data reference
        std::size_t extents = number_at(bytes, at, 2);
        at += 2;
        for (; extents > 0; --extents) {
            at += index_size;
            add_to_number(bytes, at, more);
            at += 4 + length_size;
        }
    }
}

/// Bits, most significant first, then zeros to a whole byte.
std::string packed(const std::string& bits) {
    std::string bytes;
    for (std::size_t i = 0; i < bits.size(); i += 8) {
        const std::string byte = (bits.substr(i, 8) + "0000000").substr(0, 8);
        bytes += static_cast<char>(std::stoi(byte, nullptr, 2));
    }
    return bytes;
}

/// 2^power as ITU-T H.265 writes numbers here: a sign, 7 bits of exponent (31: 1), 5 bits of length, one of mantissa.
std::string power_of_two(int power) {
    std::string bits = "0";
    for (int bit = 6; bit >= 0; --bit)
        bits += (31 + power) >> bit & 1 ? '1' : '0';
    return bits + "00000" + "0";
}

/// The alpha of a file becomes its depth, with a statement of depth representation, whose `bits` follow its head.
std::string with_depth(std::string bytes, const std::string& bits) {
    const std::string alpha = "urn:mpeg:hevc:2015:auxid:1";
    const std::size_t type = bytes.find(alpha);
    REQUIRE(type != std::string::npos);
    bytes[type + alpha.size() - 1] = '2';
    const std::string payload = packed(bits + "1");
    const std::string unit =
        std::string("\x4e\x01", 2) + static_cast<char>(177) + static_cast<char>(payload.size()) + payload;
    const auto sized = [](const std::string& data) {
        return std::string(3, '\0') + static_cast<char>(data.size()) + data;
    };
    const std::string statement = sized(sized(unit));
    for (const char* box : {"meta", "iprp", "ipco", "auxC"})
        add_to_number(bytes, bytes.find(box) - 4, statement.size());
    shift_items(bytes, statement.size());
    return bytes.insert(type + alpha.size() + 1, statement);
}

ImageFile read_heic(const std::string& bytes, Role role = Role::color) {
    return read_image(ImageSource{"a.heic", bytes}, {.role = role});
}

} // namespace

TEST_CASE("HEIC: colour, alpha and turning") {
    const std::string plain = heic_of({200, 60, 30});
    if (plain.empty()) return;
    const ImageFile file = read_heic(plain);
    REQUIRE((file.image.width == 128 && file.image.height == 64 && file.image.channels == 3));
    CHECK(file.coding.bits == 8);
    // To YCbCr and back: a code or two.
    for (const auto& [channel, code] : {std::pair{0, 200}, {1, 60}, {2, 30}})
        CHECK(std::fabs(linear_to_srgb(file.image.at(5, 5, channel)) * 255 - code) <= 2);
    const ImageFile alpha = read_heic(heic_of({200, 60, 30, 51}));
    CHECK(alpha.coding.alpha == Coding::Alpha::straight);
    CHECK(alpha.image.at(5, 5, 3) == Approx(0.2).margin(1.1 / 255));
    CHECK(read_heic(heic_of({1, 2, 3}, {}, {}, heif_orientation_rotate_90_cw)).image.height == 128);
    for (std::size_t size = 0; size < plain.size(); size += 41)
        CHECK_THROWS_AS(read_heic(plain.substr(0, size)), Error);
}

TEST_CASE("HEIC: profiles, code points and the camera") {
    const std::string profile = p3_profile(1);
    const std::string wide = heic_of({255, 0, 0}, [&](heif_image* image, heif_encoding_options*) {
        heif_image_set_raw_color_profile(image, "prof", profile.data(), profile.size());
    });
    if (wide.empty()) return;
    CHECK(read_heic(wide).image.at(5, 5, 0) == Approx(1.22494).margin(0.02)); // a code off, of gamma 1
    CHECK(read_heic(wide, Role::data).image.at(5, 5, 0) == Approx(1).margin(0.01));
    // libheif writes "unspecified": primaries, transfer and matrix are numbers of two bytes each.
    std::string linear = heic_of({255, 0, 0}, [&](heif_image*, heif_encoding_options* options) {
        options->macOS_compatibility_workaround_no_nclx_profile = 0;
    });
    const std::size_t nclx = linear.find("colrnclx") + 8;
    linear[nclx + 1] = 12;
    linear[nclx + 3] = 8;
    CHECK(read_heic(linear).image.at(5, 5, 0) == Approx(1.22494).margin(0.02));
    // EXIF: the focal length for 35 mm film, 26 mm, and an orientation that the file's own properties would repeat.
    const std::string exif(
        "II*\0\x08\0\0\0\2\0\x12\1\3\0\1\0\0\0\6\0\0\0\x69\x87\4\0\1\0\0\0\x26\0\0\0\0\0\0\0"
        "\1\0\5\xa4\3\0\1\0\0\0\x1a\0\0\0\0\0\0\0",
        56);
    const ImageFile shot =
        read_heic(heic_of({1, 2, 3}, {}, [&](heif_context* context, heif_image_handle* handle) {
            heif_context_add_exif_metadata(context, handle, exif.data(), static_cast<int>(exif.size()));
        }));
    REQUIRE(shot.shot.focal_length_35mm);
    CHECK(*shot.shot.focal_length_35mm == 26);
    CHECK(shot.image.width == 128);
}

TEST_CASE("HEIC: the depth image and what its samples stand for") {
    const std::string alpha = heic_of({200, 60, 30, 51});
    if (alpha.empty()) return;
    CHECK_THROWS_WITH(read_heic(alpha, Role::depth), Catch::Contains("no depth image"));
    // Flags of z near, z far, d min, d max; the kind: 0 inverse z ("1"), 1 disparity ("010", and the view, 0: "1"), 2 z ("011").
    const std::string numbers = power_of_two(-1) + power_of_two(2); // 0.5 and 4
    struct Expected {
        std::string bits;
        DepthScale::Kind kind;
        double at_zero, at_one;
    };
    for (const Expected& expected : {Expected{"00110101" + numbers, DepthScale::Kind::dioptres, 0.5, 4},
                                     Expected{"11001" + numbers, DepthScale::Kind::dioptres, 0.25, 2},
                                     Expected{"1100011" + numbers, DepthScale::Kind::metres, 0.5, 4}}) {
        const ImageFile depth = read_heic(with_depth(alpha, expected.bits), Role::depth);
        REQUIRE((depth.image.channels == 1 && depth.image.width == 128));
        CHECK(depth.image.values[0] == Approx(0.2).margin(1.1 / 255));
        REQUIRE(depth.depth_scale);
        CHECK(depth.depth_scale->kind == expected.kind);
        CHECK(depth.depth_scale->at_zero == expected.at_zero);
        CHECK(depth.depth_scale->at_one == expected.at_one);
    }
    const ImageFile unsaid = read_heic(with_depth(alpha, "00001"), Role::depth);
    CHECK_FALSE(unsaid.depth_scale);
    CHECK(unsaid.warnings.size() == 1);
}

TEST_CASE("A phone's photograph with its depth") {
    const auto file = test_data("../heic/pug.heic");
    if (file.empty()) return;
    const ImageSource source = open_image(file);
    const ImageFile photograph = read_image(source);
    CHECK((photograph.image.width == 4032 && photograph.image.height == 3024));
    CHECK(photograph.shot.focal_length_mm == 5.7);
    CHECK(photograph.shot.focal_length_35mm == 26);
    const ImageFile depth = read_image(source, {.role = Role::depth});
    // As another program wrote it.
    CHECK(same_values(depth.image,
                      read_image(file.parent_path() / "pug_depth.png", {.role = Role::data}).image));
    REQUIRE(depth.depth_scale);
    CHECK(depth.depth_scale->kind == DepthScale::Kind::dioptres);
    CHECK(depth.depth_scale->at_zero == Approx(1.498).margin(5e-4));
    CHECK(depth.depth_scale->at_one == Approx(4.383).margin(5e-4));
    CHECK(read_image(file.parent_path() / "RGB_10__128x128.heif").coding.bits == 10);
    read_error(file.parent_path() / "corrupted.heic");
}
