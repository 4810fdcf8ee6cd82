// Cross-fades: even steps from one picture to another, none of which is seen.
#include <catch2/catch.hpp>
#include <testing.hpp>

#include <gl/cross_fade.hpp>
#include <image/flip.hpp>

#include <postfx/budget.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

using namespace postfx;

namespace {

constexpr int width = 96, height = 54;
constexpr float code = 1.0f / 255;

using Color = std::function<float(int x, int y, int channel)>;

Image image_of(const Color& color) {
    Image image(width, height, 4, 1.0f);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c)
                image.values[4 * static_cast<std::size_t>(y * width + x) + c] =
                    std::round(255 * std::clamp(color(x, y, c), 0.0f, 1.0f)) * code;
        }
    }
    return image;
}

gl::Texture texture_of(const Image& image) {
    gl::Texture texture(image.width, image.height, Format::rgba8);
    texture.upload(image);
    return texture;
}

Image picture(std::uint32_t texture) {
    return gl::read_texture(texture, width, height, Format::rgba8);
}

/// What is shown while a still picture turns into another one: the first one, then all steps.
std::vector<Image> frames_between(const Image& before, const Image& after, int steps) {
    const gl::Texture from = texture_of(before), to = texture_of(after);
    gl::CrossFade fade;
    std::vector<Image> frames = {before};
    fade.begin(from.name(), width, height, steps);
    for (int i = 0; i < steps; ++i)
        frames.push_back(picture(fade.show(to.name(), width, height)));
    return frames;
}

double seen_between(const Image& a, const Image& b) {
    return flip(a, b, Encoding::srgb).mean;
}

/// Tiles with edges in between.
float tiles(int x, int y, int channel) {
    return (x / 12 + y / 9) % 2 ? 0.2f + 0.1f * static_cast<float>(channel) : 0.7f;
}

float between_pixels(int x, int y, int channel) {
    float sum = 0;
    for (int i = -2; i <= 2; ++i)
        sum += tiles(x + i + 12, y + i + 12, channel) / 5;
    return sum;
}

} // namespace

TEST_CASE("a fade goes from one picture to the other in even steps") {
    const Image before = image_of(tiles),
                after = image_of([](int x, int, int) { return static_cast<float>(x) / width; });
    const int steps = GENERATE(1, 2, 5, postfx::longest_fade);
    const std::vector<Image> frames = frames_between(before, after, steps);
    CHECK(frames.back().values == after.values);
    for (int i = 1; i < steps; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(steps);
        for (std::size_t k = 0; k < before.values.size(); ++k) {
            const float expected = before.values[k] + share * (after.values[k] - before.values[k]);
            // Rounded to one of the two next codes, and the difference to half floats: a quarter of a thousandth.
            if (std::abs(frames[i].values[k] - expected) > code + 0.0003f)
                FAIL_CHECK("step " << i << " at " << k);
        }
    }
}

TEST_CASE("without a change, and after it, the picture is the one that was drawn") {
    const gl::Texture a = texture_of(image_of(tiles)), b = texture_of(image_of(between_pixels));
    gl::CrossFade fade;
    CHECK(fade.show(a.name(), width, height) == a.name());
    fade.begin(a.name(), width, height, 1);
    CHECK(fade.show(b.name(), width, height) == b.name());
    fade.begin(b.name(), width, height, 3);
    CHECK(fade.show(a.name(), width, height) != a.name());
    CHECK(fade.show(a.name(), width, height) != a.name());
    CHECK(fade.show(a.name(), width, height) == a.name());
    CHECK(fade.show(a.name(), width, height) == a.name());
}

TEST_CASE("a fade ends when the picture gets another size") {
    const gl::Texture a = texture_of(image_of(tiles)), small(8, 8, Format::rgba8);
    gl::CrossFade fade;
    fade.begin(a.name(), width, height, 5);
    CHECK(fade.show(small.name(), 8, 8) == small.name());
    CHECK(fade.show(a.name(), width, height) == a.name());
}

TEST_CASE("a change that comes before the last one has ended starts from what is shown") {
    const Image first = image_of([](int, int, int) { return 0.2f; }),
                second = image_of([](int, int, int) { return 0.8f; });
    const gl::Texture a = texture_of(first), b = texture_of(second);
    gl::CrossFade fade;
    fade.begin(a.name(), width, height, 4);
    const std::uint32_t shown = fade.show(b.name(), width, height); // 0.35
    fade.begin(shown, width, height, 3);
    CHECK(picture(fade.show(a.name(), width, height)).values[0] == Approx(0.3).margin(1.5 * code));
    CHECK(picture(fade.show(a.name(), width, height)).values[0] == Approx(0.25).margin(1.5 * code));
    CHECK(fade.show(a.name(), width, height) == a.name());
}

TEST_CASE("what moves leaves no trail but of the difference between levels") {
    const auto edge_at = [](int at, float dark) {
        return image_of([at, dark](int x, int, int) { return x < at ? dark : 0.7f; });
    };
    const gl::Texture before = texture_of(edge_at(20, 0.2f)), after = texture_of(edge_at(20, 0.22f));
    gl::CrossFade fade;
    fade.begin(before.name(), width, height, 5);
    fade.show(after.name(), width, height);
    for (int i = 1; i < 5; ++i) {
        const Image drawn = edge_at(20 + 8 * i, 0.22f);
        const gl::Texture texture = texture_of(drawn);
        const Image shown = picture(fade.show(texture.name(), width, height));
        for (std::size_t k = 0; k < drawn.values.size(); ++k) {
            if (std::abs(shown.values[k] - drawn.values[k]) > 0.02f + 1.5f * code)
                FAIL("frame " << i << " at " << k);
        }
    }
}

TEST_CASE("no step of a fade is seen") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-1, 1);
    const float amount = GENERATE(0.3f, 0.5f, 0.7f);
    const int kind = GENERATE(0, 1, 2);
    const Image before = image_of(tiles);
    const Image after = image_of([&](int x, int y, int channel) {
        const float tile = tiles(x, y, channel);
        if (kind == 0) return tile + 0.05f * amount * (between_pixels(x, y, channel) - tile); // edges soften
        if (kind == 1) return tile + 0.017f * amount * (channel == 0 ? 1.0f : 0.0f); // the colour changes
        return tile + 0.04f * amount * unit(random);                                 // other noise
    });
    const double step = seen_between(before, after);
    CAPTURE(kind, amount, step);
    REQUIRE(step > visible_step);
    REQUIRE(fade_frames(step) <= longest_fade);
    const std::vector<Image> frames = frames_between(before, after, fade_frames(step));
    double largest = 0;
    for (std::size_t i = 1; i < frames.size(); ++i)
        largest = std::max(largest, seen_between(frames[i - 1], frames[i]));
    CAPTURE(frames.size(), largest);
    CHECK(largest <= visible_step);
}
