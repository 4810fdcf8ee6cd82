// Pictures to test on, and how far results are from what was expected.
#include <testing.hpp>

#include <image/files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>

namespace postfx::testing {
namespace {

/// The file's own 8-bit codes of display-linear light.
int code_of(float linear) {
    const double x = std::clamp(static_cast<double>(linear), 0.0, 1.0);
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    return static_cast<int>(std::lround(encoded * 255));
}

} // namespace

Image constant(int width, int height, std::vector<float> value) {
    Image image(width, height, static_cast<int>(value.size()));
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = value[i % value.size()];
    return image;
}

Image noise(int width, int height, float low, float high, std::uint32_t seed) {
    Image image(width, height, 3);
    std::mt19937 random(seed);
    // Not uniform_real_distribution: its result differs between standard libraries.
    for (float& value : image.values) {
        value = low + (high - low) * static_cast<float>(random() >> 8) / 16777216.0f;
    }
    return image;
}

Image impulse(int width, int height, int x, int y, float value) {
    Image image(width, height, 3);
    for (int c = 0; c < 3; ++c)
        image.at(x, y, c) = value;
    return image;
}

Image three_channels(const Image& image) {
    Image result(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            std::memcpy(result.pixel(x, y), image.pixel(x, y), 3 * sizeof(float));
    }
    return result;
}

Image mirrored(const Image& image) {
    Image result(image.width, image.height, image.channels);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            std::copy_n(image.pixel(x, y), image.channels, result.pixel(image.width - 1 - x, y));
    }
    return result;
}

Image scaled(Image image, float factor) {
    for (float& value : image.values)
        value *= factor;
    return image;
}

Image part_of(const Image& image, const Part& part) {
    Image result(part.width, part.height, image.channels);
    for (int y = 0; y < part.height; ++y) {
        std::copy_n(image.pixel(part.x, part.y + y), part.width * image.channels, result.pixel(0, y));
    }
    return result;
}

Input part_of(const Input& input, const Part& part) {
    Input result = input;
    result.color = part_of(input.color, part);
    for (auto& [name, image] : result.attachments)
        image = part_of(input.attachments.at(name), part);
    const auto axis = [](double whole_axis, int whole, int begin, int size) {
        return ((whole_axis + 1) * whole - 2 * begin) / size - 1;
    };
    Camera& camera = result.camera;
    const double share = double(part.height) / input.color.height;
    camera.vertical_fov = std::atan(camera.tan_half_fov() * share) * 360 / std::numbers::pi;
    camera.vertical_extent *= share;
    camera.principal_point = {axis(input.camera.principal_point[0], input.color.width, part.x, part.width),
                              axis(input.camera.principal_point[1], input.color.height, part.y, part.height)};
    return result;
}

Worst worst_difference(const Image& result, const Image64& expected) {
    if (result.width != expected.width || result.height != expected.height) {
        throw Error(fmt::format("{}x{} compared with {}x{}", result.width, result.height, expected.width,
                                expected.height));
    }
    Worst worst;
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double a = result.at(x, y, c), b = expected.at(x, y, c);
                const bool same = a == b || (std::isnan(a) && std::isnan(b));
                double difference = same ? 0 : std::abs(a - b);
                if (std::isnan(difference)) difference = std::numeric_limits<double>::infinity();
                if (difference > worst.absolute) worst = {difference, worst.relative, x, y, c};
                worst.relative = std::max(worst.relative, difference / std::max(std::abs(b), 1e-6));
            }
        }
    }
    return worst;
}

bool same_bits(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height) return false;
    for (std::size_t i = 0; i < a.pixel_count(); ++i) {
        if (std::memcmp(&a.values[a.channels * i], &b.values[b.channels * i], 3 * sizeof(float)) != 0)
            return false;
    }
    return true;
}

void check_golden(const std::string& directory, const std::string& name, const Image& display_linear,
                  int max_codes, double max_differing_fraction, const std::string& reason) {
    namespace fs = std::filesystem;
    const fs::path golden = fs::path(directory) / "golden" / (name + ".png");
    const char* update = std::getenv("POSTFX_UPDATE_GOLDEN");
    if (update && *update == '1') {
        fs::create_directories(golden.parent_path());
        write_image(golden, display_linear);
        fmt::print("golden image {} was rewritten; say why in the commit\n", golden.string());
        return;
    }
    const Image expected = read_image(golden).image;
    if (expected.width != display_linear.width || expected.height != display_linear.height) {
        throw Error(Place{.file = golden.string()}, "has another size than the result");
    }
    int worst = 0;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < expected.pixel_count(); ++i) {
        int pixel_worst = 0;
        for (int c = 0; c < 3; ++c) {
            pixel_worst =
                std::max(pixel_worst, std::abs(code_of(display_linear.values[display_linear.channels * i + c])
                                               - code_of(expected.values[expected.channels * i + c])));
        }
        worst = std::max(worst, pixel_worst);
        differing += pixel_worst > max_codes;
    }
    const double fraction = static_cast<double>(differing) / static_cast<double>(expected.pixel_count());
    if (fraction > max_differing_fraction) {
        const fs::path result = fs::current_path() / (name + ".result.png");
        write_image(result, display_linear);
        throw Error(
            Place{.file = golden.string()},
            fmt::format(
                "{:.4f} % of the pixels differ by more than {} codes (worst {}; {:.4f} % allowed: {}); "
                "the result is in {}",
                100 * fraction, max_codes, worst, 100 * max_differing_fraction, reason, result.string()));
    }
}

} // namespace postfx::testing
