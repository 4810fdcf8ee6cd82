// PNG, JPEG, HDR and PFM files. EXR has a test of its own.
#include "image_checks.hpp"
#include "png_bytes.hpp"

#include <image/srgb.hpp>

#include <bit>
#include <cmath>
#include <csignal>
#include <limits>

#include <sys/resource.h>
#include <sys/stat.h>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// Floats with payloads that arithmetic would lose.
Image peculiar_image(int channels) {
    Image image(5, 3, channels);
    const std::vector<float> peculiar = {std::bit_cast<float>(0x7fc12345u),
                                         std::bit_cast<float>(0xffa00001u),
                                         std::numeric_limits<float>::infinity(),
                                         -std::numeric_limits<float>::infinity(),
                                         -0.0f,
                                         std::numeric_limits<float>::denorm_min(),
                                         -1.5f,
                                         std::numeric_limits<float>::max(),
                                         0.1f};
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = peculiar[i % peculiar.size()];
    return image;
}

/// Positive values over many magnitudes, reproducible.
Image wide_range_image(int width, int height) {
    Image image(width, height, 3);
    std::uint32_t state = 1;
    for (float& value : image.values) {
        state = state * 1664525u + 1013904223u;
        value = std::ldexp(static_cast<float>(state >> 8), static_cast<int>(state % 40u) - 40);
    }
    return image;
}

/// Put bytes into a file and read it.
Image read_bytes_as(const std::filesystem::path& file, const std::string& bytes) {
    put_bytes(file, bytes);
    return read_image(file).image;
}

/// While it lives, files can't grow beyond some bytes: every longer write fails half-way.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit before_{};
    void (*handler_)(int);
};

std::ptrdiff_t entries(const TemporaryDirectory& directory) {
    return std::distance(std::filesystem::directory_iterator(directory.path()), {});
}

} // namespace

TEST_CASE("The sRGB curve has the standard's values") {
    CHECK(srgb_to_linear(0) == 0);
    CHECK(srgb_to_linear(1) == 1);
    // IEC 61966-2-1, worked out with 40 digits and cut to 15.
    CHECK(srgb_to_linear(10 / 255.0) == Approx(0.00303526983548838).epsilon(1e-13));
    CHECK(srgb_to_linear(0.5) == Approx(0.214041140482233).epsilon(1e-13));
    CHECK(linear_to_srgb(0.5) == Approx(0.735356983052449).epsilon(1e-13));
    CHECK(linear_to_srgb(std::nan("")) == 0);
    CHECK(linear_to_srgb(-std::numeric_limits<double>::infinity()) == 0);
    CHECK(linear_to_srgb(std::numeric_limits<double>::infinity()) == 1);
}

TEST_CASE("All 256 codes survive reading and writing a PNG") {
    const TemporaryDirectory directory;
    const int channels = GENERATE(1, 2, 3, 4);
    CAPTURE(channels);
    BasicImage<std::uint8_t> codes(256, 2, channels);
    for (std::size_t i = 0; i < codes.values.size(); ++i)
        codes.values[i] =
            static_cast<std::uint8_t>(i / static_cast<std::size_t>(channels) + i % channels * 85);
    write_codes(directory / "codes.png", codes);
    const ImageFile first = read_image(directory / "codes.png");
    CHECK(first.coding.bits == 8);
    REQUIRE(first.image.channels == channels);
    write_image(directory / "again.png", first.image);
    CHECK(file_bytes(directory / "again.png") == file_bytes(directory / "codes.png"));

    const Image data = read_image(directory / "again.png", {.role = Role::data}).image;
    for (std::size_t i = 0; i < codes.values.size(); ++i)
        REQUIRE(data.values[i] == static_cast<float>(codes.values[i] / 255.0));
}

TEST_CASE("A PNG's first row is the top one, alpha is not decoded") {
    const TemporaryDirectory directory;
    const std::string rows("\0\xff\0\0\x80\0\x0a\0\0\xff", 10);
    const Image image = read_bytes_as(directory / "a.png", stored_png(1, 2, 8, 6, rows));
    REQUIRE((image.width == 1 && image.height == 2 && image.channels == 4));
    CHECK(image.at(0, 1, 0) == 1.0f);
    CHECK(image.at(0, 1, 3) == static_cast<float>(128 / 255.0));
    CHECK(image.at(0, 0, 0) == static_cast<float>(10 / 255.0 / 12.92));
    CHECK(image.at(0, 0, 3) == 1.0f);
}

TEST_CASE("PNG with 16 bits") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory / "deep.png";
    put_bytes(file, stored_png(3, 1, 16, 0, std::string("\0\0\0\x12\x34\xff\xff", 7)));
    const ImageFile light = read_image(file);
    CHECK(light.coding.bits != 8);
    REQUIRE(light.image.channels == 1);
    CHECK(light.image.values[1] == static_cast<float>(srgb_to_linear(0x1234 / 65535.0)));
    CHECK(read_image(file, {.role = Role::data}).image.values
          == std::vector<float>{0.0f, static_cast<float>(0x1234 / 65535.0), 1.0f});
}

TEST_CASE("Writing a PNG clamps, and NaN is black") {
    const TemporaryDirectory directory;
    const float infinity = std::numeric_limits<float>::infinity();
    Image image(2, 1, 4);
    image.values = {2.0f, -1.0f, std::nanf(""), infinity, 0.5f, -infinity, infinity, std::nanf("")};
    write_image(directory / "odd.png", image);
    // 188 = round(255 * 0.73536), the sRGB code of half the light
    const std::vector<float> codes = {255, 0, 0, 255, 188, 0, 255, 0};
    const Image read = read_image(directory / "odd.png", {.role = Role::data}).image;
    for (std::size_t i = 0; i < codes.size(); ++i)
        CHECK(read.values[i] == codes[i] / 255.0f);
}

TEST_CASE("JPEG") {
    const TemporaryDirectory directory;
    const auto file =
        std::filesystem::path(POSTFX_SOURCE_DIRECTORY) / "tests/framework/images/two_colors.jpg";
    const ImageFile jpeg = read_image(file);
    CHECK(jpeg.coding.bits == 8);
    REQUIRE((jpeg.image.width == 16 && jpeg.image.height == 8 && jpeg.image.channels == 3));
    // Left 200, 60, 30; right 30, 60, 220. Each half is whole 8x8 blocks of one colour, so what the
    // quantisation of the mean leaves is at most 4 codes.
    const Image data = read_image(file, {.role = Role::data}).image;
    for (const auto& [x, rgb] :
         {std::pair{2, std::array{200, 60, 30}}, std::pair{13, std::array{30, 60, 220}}})
        for (int channel = 0; channel < 3; ++channel)
            CHECK(std::fabs(data.at(x, 4, channel) * 255 - static_cast<float>(rgb[channel])) <= 4);
    const std::string bytes = file_bytes(file);
    check_truncated(directory, file, bytes.size(), 7);
    check_truncated(directory, file, bytes.size(), bytes.size() - 1);

    // A Huffman table that claims more codes than there are bytes.
    std::string hostile = bytes;
    hostile.replace(hostile.find("\xff\xc4") + 5, 16, 16, '\xff');
    put_bytes(directory / "hostile.jpg", hostile);
    CHECK(read_error(directory / "hostile.jpg").find("damaged JPEG") != std::string::npos);
}

TEST_CASE("PFM keeps every bit, in both byte orders, bottom row first") {
    const TemporaryDirectory directory;
    for (const int channels : {1, 3}) {
        const Image image = peculiar_image(channels);
        write_image(directory / "a.pfm", image);
        CHECK(same_values(read_image(directory / "a.pfm").image, image));
        CHECK(same_values(read_image(directory / "a.pfm", {.role = Role::data}).image, image));
    }
    const Image big =
        read_bytes_as(directory / "b.pfm", std::string("Pf\n1 2\n1.0\n\x3f\x80\0\0\x40\0\0\0", 19));
    CHECK(big.values == std::vector<float>{1.0f, 2.0f});
    const Image little =
        read_bytes_as(directory / "l.pfm", std::string("Pf 2 1 -1\n\0\0\x80\x3f\0\0\0\x40", 18));
    CHECK(little.values == std::vector<float>{1.0f, 2.0f});
    CHECK(little.width == 2);
    const ImageFile scaled =
        read_image(ImageSource{"s.pfm", std::string("Pf 2 1 -4\n\0\0\x80\x3f\0\0\0\x40", 18)});
    CHECK(scaled.image.values == std::vector<float>{1.0f, 2.0f});
    CHECK(scaled.warnings.size() == 1);
}

TEST_CASE("PFM and HDR have no alpha, HDR no grey") {
    const TemporaryDirectory directory;
    Image image(1, 1, 4);
    image.values = {1, 2, 3, 0.5f};
    write_image(directory / "a.pfm", image);
    CHECK(read_image(directory / "a.pfm").image.values == std::vector<float>{1, 2, 3});
    write_image(directory / "a.hdr", image);
    CHECK(read_image(directory / "a.hdr").image.values == std::vector<float>{1, 2, 3});
    image = Image(1, 1, 2);
    image.values = {4, 0.5f};
    write_image(directory / "g.pfm", image);
    CHECK(read_image(directory / "g.pfm").image.values == std::vector<float>{4});
    write_image(directory / "g.hdr", image);
    CHECK(read_image(directory / "g.hdr").image.values == std::vector<float>{4, 4, 4});
}

TEST_CASE("HDR keeps 8 bits of each pixel's largest channel") {
    const TemporaryDirectory directory;
    const int width = GENERATE(1, 7, 8, 300); // below 8 rows have no runs; 300 needs several runs of 127
    Image image = wide_range_image(width, 5);
    for (int x = 0; x < width; ++x)
        for (int channel = 0; channel < 3; ++channel)
            image.at(x, 2, channel) = 0.25f; // one long run
    write_image(directory / "a.hdr", image);
    const Image read = read_image(directory / "a.hdr").image;
    REQUIRE((read.width == width && read.height == 5 && read.channels == 3));
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < width; ++x) {
            const float* pixel = image.pixel(x, y);
            const float largest = std::max({pixel[0], pixel[1], pixel[2]});
            // Half a step of the shared exponent: the largest is at least 128 steps.
            for (int channel = 0; channel < 3; ++channel)
                REQUIRE(std::fabs(read.at(x, y, channel) - pixel[channel]) <= largest / 256);
        }
    write_image(directory / "b.hdr", read);
    CHECK(file_bytes(directory / "b.hdr") == file_bytes(directory / "a.hdr"));
}

TEST_CASE("HDR at the ends of its range") {
    const TemporaryDirectory directory;
    Image image(2, 1, 3);
    const float infinity = std::numeric_limits<float>::infinity();
    image.values = {std::nanf(""), -1, infinity, std::numeric_limits<float>::denorm_min(), 0, 0};
    write_image(directory / "a.hdr", image);
    CHECK(read_image(directory / "a.hdr").image.values
          == std::vector<float>{0, 0, std::ldexp(255.0f, 127 - 8), 0, 0, 0});
    image.values = {255.9f, 0, 0, 1, 1, 1}; // the mantissa is rounded up to 256
    write_image(directory / "b.hdr", image);
    CHECK(read_image(directory / "b.hdr").image.values == std::vector<float>{256, 0, 0, 1, 1, 1});
}

TEST_CASE("HDR rows: order and the oldest runs") {
    const TemporaryDirectory directory;
    const std::string header = "#?RADIANCE\nEXPOSURE=1\n\n";
    const std::string pixels("\x80\0\0\x81\0\x80\0\x81", 8); // red 1, green 1
    const Image down = read_bytes_as(directory / "d.hdr", header + "-Y 2 +X 1\n" + pixels);
    CHECK(down.values == std::vector<float>{0, 1, 0, 1, 0, 0});
    const Image up = read_bytes_as(directory / "u.hdr", header + "+Y 2 +X 1\n" + pixels);
    CHECK(up.values == std::vector<float>{1, 0, 0, 0, 1, 0});
    const Image runs =
        read_bytes_as(directory / "r.hdr", header + "-Y 1 +X 4\n" + pixels.substr(0, 4) + "\x01\x01\x01\x03");
    CHECK(runs.values == std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});

    put_bytes(directory / "bad.hdr", header + "-Y 1 +X 4\n" + pixels.substr(0, 4) + "\x01\x01\x01\x09");
    CHECK(read_error(directory / "bad.hdr").find("run") != std::string::npos);
    put_bytes(directory / "zero.hdr", header + "-Y 1 +X 8\n" + std::string("\2\2\0\x08\0\0\0\0", 8));
    CHECK(read_error(directory / "zero.hdr").find("run") != std::string::npos);
    put_bytes(directory / "abcd.hdr", "#?RADIANCE\nFORMAT=32-bit_abcd\n\n-Y 1 +X 1\nabcd");
    CHECK(read_error(directory / "abcd.hdr").find("32-bit_abcd") != std::string::npos);
    put_bytes(directory / "turned.hdr", header + "+X 1 -X 1\nabcd");
    CHECK(read_error(directory / "turned.hdr").find("resolution") != std::string::npos);
}

TEST_CASE("The night sky of others") {
    const auto file = test_data("night.hdr");
    if (file.empty()) return;
    const ImageFile night = read_image(file);
    REQUIRE((night.image.width == 1024 && night.image.height == 512 && night.image.channels == 3));
    for (const float value : night.image.values)
        REQUIRE((std::isfinite(value) && value >= 0));
    const TemporaryDirectory directory;
    write_image(directory / "night.hdr", night.image);
    CHECK(same_values(read_image(directory / "night.hdr").image, night.image));
    const std::string bytes = file_bytes(file);
    put_bytes(directory / "half.hdr", bytes.substr(0, bytes.size() / 2));
    CHECK(read_error(directory / "half.hdr").find("truncated") != std::string::npos);
}

TEST_CASE("Truncated files are refused") {
    const TemporaryDirectory directory;
    const Image image = wide_range_image(9, 4);
    for (const char* name : {"a.hdr", "a.pfm", "a.png"}) {
        const std::filesystem::path file = directory / name;
        write_image(file, image);
        // PNG: without its last 16 bytes (IEND, checksum of the pixels) the picture is still whole.
        const std::size_t whole = file_bytes(file).size() - (file.extension() == ".png" ? 16 : 0);
        check_truncated(directory, file, whole, 1);
    }
}

TEST_CASE("Absurd sizes are refused before anything is allocated") {
    const TemporaryDirectory directory;
    const std::string hdr = "#?RADIANCE\n\n";
    const std::vector<std::pair<std::string, std::string>> files = {
        {"a.pfm", "PF\n2000000000 2000000000\n-1\n1234"},
        {"b.pfm", "PF\n30000 30000\n-1\n1234"},
        {"c.pfm", "PF\n0 5\n-1\n1234"},
        {"d.pfm", "PF\n-4 5\n-1\n1234"},
        {"a.hdr", hdr + "-Y 99999999 +X 99999999\nabcd"},
        {"b.hdr", hdr + "-Y 0 +X 1\nabcd"},
        {"a.png", stored_png(0x7fffffff, 0x7fffffff, 8, 2, "1234")},
        {"b.png", stored_png(32768, 32768, 8, 2, "1234")},
    };
    for (const auto& [name, bytes] : files) {
        put_bytes(directory / name, bytes);
        CHECK(read_error(directory / name).find("absurd size") != std::string::npos);
    }
    put_bytes(directory / "e.pfm", "PF\nmany 5\n-1\n");
    CHECK(read_error(directory / "e.pfm").find("width") != std::string::npos);
    put_bytes(directory / "f.pfm", "PF\n1 1\n0\n123456789012");
    CHECK(read_error(directory / "f.pfm").find("scale") != std::string::npos);
}

TEST_CASE("What is no image is refused") {
    const TemporaryDirectory directory;
    put_bytes(directory / "empty.png", "");
    put_bytes(directory / "words.png", "once upon a time");
    write_image(directory / "a.png", Image(2, 2, 3));
    CHECK(read_error(directory / "missing.png").find("no such file") != std::string::npos);
    CHECK(read_error(directory.path()).find("directory") != std::string::npos);
    CHECK(read_error(directory / "empty.png").find("empty") != std::string::npos);
    CHECK(read_error(directory / "words.png").find("PNG, JPEG, HEIC, TIFF, WebP, OpenEXR, HDR, PFM, PNM, TGA")
          != std::string::npos);
    CHECK(read_error("/dev/zero").find("larger") != std::string::npos);
    const auto file = directory / "a.png";
    CHECK(error_of(file, [&] { read_image(file, {.role = Role::data, .layer = "Z"}); }).find("layers")
          != std::string::npos);
}

TEST_CASE("Endings") {
    CHECK_NOTHROW(check_writable_kind("a/b.PNG"));
    CHECK_NOTHROW(check_writable_kind("b.exr"));
    CHECK(error_of("b.exe", [] { check_writable_kind("b.exe"); }).find("did you mean \".exr\"")
          != std::string::npos);
    CHECK(error_of("b", [] { check_writable_kind("b"); }).find(".png, .jpg, .exr, .hdr, .pfm")
          != std::string::npos);
    CHECK(is_display_kind("b.png"));
    CHECK_FALSE(is_display_kind("b.exr"));
    CHECK(is_display_kind("b.JPG"));
    CHECK(error_of("b.gif", [] { write_image("b.gif", Image(1, 1, 3)); }).find(".gif") != std::string::npos);
}

TEST_CASE("Pictures that can't be written") {
    const TemporaryDirectory directory;
    const auto file = directory / "a.exr";
    for (const Image& image : {Image(), Image(2, 2, 5), Image(40000, 1, 1)})
        error_of(file, [&] { write_image(file, image); });
    error_of(directory / "a.png", [&] {
        write_codes(directory / "a.png", {2, 2, 3, std::vector<std::uint8_t>(11)});
    });
    CHECK(entries(directory) == 0);
}

TEST_CASE("A failed write leaves the old file and nothing else") {
    const TemporaryDirectory directory;
    const std::string name = GENERATE("a.png", "a.exr", "a.hdr", "a.pfm");
    const std::filesystem::path file = directory / name;
    put_bytes(file, "old");
    std::string message;
    {
        const FileSizeLimit limit(100);
        message = error_of(file, [&] { write_image(file, wide_range_image(64, 64)); });
    }
    CHECK(message.find("too large") != std::string::npos); // EFBIG: some bytes were written before
    CHECK(file_bytes(file) == "old");
    CHECK(entries(directory) == 1);
    write_image(file, wide_range_image(64, 64));
    CHECK(read_image(file).image.width == 64);
    CHECK(entries(directory) == 1);
}

TEST_CASE("Places that can't be written to") {
    const TemporaryDirectory directory;
    const Image image(2, 2, 3);
    const auto inside_missing = directory / "missing/a.png";
    CHECK(error_of(inside_missing, [&] { write_image(inside_missing, image); }).find("there is no folder")
          != std::string::npos);
    std::filesystem::create_directory(directory / "folder.png");
    const auto folder = directory / "folder.png";
    CHECK(error_of(folder, [&] { write_image(folder, image); }).find("directory") != std::string::npos);
    if (std::filesystem::exists("/dev/full"))
        CHECK(error_of("/dev/full", [&] { write_file_atomically("/dev/full", "x"); }).find("No space")
              != std::string::npos);
    CHECK_NOTHROW(write_file_atomically("/dev/null", "x"));

    if (geteuid() == 0) return; // permissions do not bind the superuser
    put_bytes(directory / "a.png", "old");
    const auto file = directory / "a.png";
    std::filesystem::permissions(file, std::filesystem::perms::owner_read);
    CHECK(error_of(file, [&] { write_image(file, image); }).find("Permission denied") != std::string::npos);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    std::filesystem::permissions(directory.path(),
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    CHECK(error_of(file, [&] { write_image(file, image); }).find("Permission denied") != std::string::npos);
    std::filesystem::permissions(directory.path(), std::filesystem::perms::owner_all);
    CHECK(file_bytes(file) == "old");
}

TEST_CASE("Links are followed, names may be as long as names get") {
    const TemporaryDirectory directory;
    put_bytes(directory / "real.pfm", "old");
    std::filesystem::create_symlink("real.pfm", directory / "link.pfm");
    write_image(directory / "link.pfm", Image(1, 1, 1, 2.0f));
    CHECK(std::filesystem::is_symlink(directory / "link.pfm"));
    CHECK(read_image(directory / "real.pfm").image.values == std::vector<float>{2.0f});
    const std::string longest = std::string(251, 'x') + ".pfm";
    CHECK_NOTHROW(write_image(directory / longest, Image(1, 1, 1)));

    const mode_t mask = umask(0);
    umask(mask);
    CHECK(std::filesystem::status(directory / longest).permissions() == std::filesystem::perms(0666 & ~mask));
}

TEST_CASE("Links to what is not there yet are written through") {
    namespace fs = std::filesystem;
    const TemporaryDirectory directory;
    fs::create_directory(directory / "renders");
    fs::create_symlink("renders/real.pfm", directory / "dangling.pfm");
    fs::create_symlink("dangling.pfm", directory / "chain.pfm");
    write_image(directory / "chain.pfm", Image(1, 1, 1, 2.0f));
    CHECK(fs::is_symlink(directory / "chain.pfm"));
    CHECK(fs::is_symlink(directory / "dangling.pfm"));
    CHECK(fs::is_regular_file(fs::symlink_status(directory / "renders/real.pfm")));
    CHECK(read_image(directory / "chain.pfm").image.values == std::vector<float>{2.0f});

    // ".." counts from where a link to a folder leads, not from where it stands.
    fs::create_directories(directory / "far/away");
    fs::create_directory_symlink(directory / "far/away", directory / "near");
    fs::create_symlink("../up.pfm", directory / "near/up.pfm");
    write_image(directory / "near/up.pfm", Image(1, 1, 1, 3.0f));
    CHECK(read_image(directory / "far/up.pfm").image.values == std::vector<float>{3.0f});

    fs::create_symlink("nowhere/real.pfm", directory / "lost.pfm");
    const std::string lost =
        error_of(directory / "lost.pfm", [&] { write_image(directory / "lost.pfm", Image(1, 1, 1)); });
    CHECK(lost.find("there is no folder " + (directory / "nowhere").string()) != std::string::npos);
    CHECK(fs::is_symlink(directory / "lost.pfm"));

    fs::create_symlink("b.pfm", directory / "a.pfm");
    fs::create_symlink("a.pfm", directory / "b.pfm");
    error_of(directory / "a.pfm", [&] { write_image(directory / "a.pfm", Image(1, 1, 1)); });
    CHECK(fs::is_symlink(directory / "a.pfm"));
}

TEST_CASE("A file that is written again keeps who may read it") {
    namespace fs = std::filesystem;
    const TemporaryDirectory directory;
    const fs::path file = directory / "a.pfm";
    write_image(file, Image(1, 1, 1));
    const auto usual = fs::status(file).permissions();
    const auto own = fs::perms::owner_read | fs::perms::owner_write;
    REQUIRE(usual != own);
    fs::permissions(file, own);
    write_image(file, Image(2, 1, 1));
    CHECK(fs::status(file).permissions() == own);
    CHECK(read_image(file).image.width == 2);
}

TEST_CASE("A kind that is named goes before the ending") {
    const TemporaryDirectory directory;
    const Image image(2, 1, 1, 2.0f);
    write_image(directory / "picture.png", image, {.kind = "pfm"});
    CHECK(same_values(read_image(directory / "picture.png").image, image));
    CHECK_NOTHROW(check_writable_kind("-", "exr"));
    CHECK(is_display_kind("a.exr", "png"));
    CHECK(error_of("a.png", [] { check_writable_kind("a.png", "gif"); }).find("its kind is \"gif\"")
          != std::string::npos);
}
