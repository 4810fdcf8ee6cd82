#include <testing.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr double ulp = 0x1p-23; // of 1
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr const char *classic = "classic", *medium = "medium"; // levels
constexpr double ramp = 0, fresnel = 1;                        // values of profile

const Camera perspective = Camera::perspective(60, 0.1);
const Camera parallel = Camera::parallel(2, 0.1, 100);

/// Added to black: the picture is the share.
Values bare(Values values) {
    values.insert({{"strength", 1}, {"color.0", 1}, {"color.1", 1}, {"color.2", 1}});
    return values;
}

Image black(int width, int height) {
    return constant(width, height, {0, 0, 0});
}

/// Normals of all directions, mostly of length 1, a few much shorter or longer.
Image normals(int width, int height) {
    std::mt19937 random(3);
    std::normal_distribution<double> any;
    Image image(width, height, 3);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const double n[] = {any(random), any(random), any(random)};
        const double scale = i % 11 == 0 ? 1e-4 : i % 13 == 0 ? 1e4 : 1;
        for (int c = 0; c < 3; ++c)
            image.values[3 * i + c] = static_cast<float>(scale * n[c] / std::hypot(n[0], n[1], n[2]));
    }
    return image;
}

/// A sphere that fills the height, seen in parallel: its normal at a pixel is its place on the disc.
Image sphere(int size) {
    Image image(size, size, 3);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const double across = (2 * x + 1.0 - size) / size, up = (2 * y + 1.0 - size) / size;
            const double squared = across * across + up * up;
            if (squared > 1) continue;
            image.at(x, y, 0) = static_cast<float>(across);
            image.at(x, y, 1) = static_cast<float>(up);
            image.at(x, y, 2) = static_cast<float>(std::sqrt(1 - squared));
        }
    }
    return image;
}

bool all_finite(const Image& image) {
    return std::all_of(image.values.begin(), image.values.end(), [](float v) { return std::isfinite(v); });
}

} // namespace

TEST_CASE("the ramp is the float64 reference's to 4 ulp over the width") {
    for (double width : {0.01, 0.1, 0.3, 1.0, 3.0, 10.0}) {
        for (const Camera& camera : {perspective, parallel, Camera::perspective(150, 0.1)}) {
            for (const auto& [columns, rows] :
                 {std::pair{1, 1}, std::pair{97, 61}, std::pair{1, 40}, std::pair{64, 36}}) {
                const Input input{.color = black(columns, rows),
                                  .attachments = {{"normal", normals(columns, rows)}},
                                  .camera = camera};
                const Values values = bare({{"width", width}});
                const Worst worst = worst_difference(run_effect("rim_light", input, values),
                                                     reference(reference_input("rim_light", input, values)));
                // The cosine rounds to 4 ulp of 1, the slope is 1 / width, and the share rounds once more.
                CHECK(worst.absolute <= 4 * ulp / width + ulp);
            }
        }
    }
}

TEST_CASE("fresnel is exact, and the seed's ramp is its own model") {
    const Input input{
        .color = black(97, 61), .attachments = {{"normal", normals(97, 61)}}, .camera = perspective};
    for (double index : {1.01, 1.33, 1.5, 2.4, 10.0}) {
        const Values values = bare({{"profile", fresnel}, {"refractive_index", index}});
        const Worst worst = worst_difference(run_effect("rim_light", input, values),
                                             reference(reference_input("rim_light", input, values)));
        // Near grazing, reflectance falls by up to some 40 per unit of the cosine, which is good to a part
        // of an ulp there.
        CHECK(worst.absolute <= 16 * ulp);
    }
    for (double width : {0.05, 0.3, 2.0}) {
        const Values values = bare({{"width", width}, {"quality", classic}});
        const Worst worst = worst_difference(run_effect("rim_light", input, values),
                                             reference(reference_input("rim_light", input, values)));
        CHECK(worst.absolute <= 4 * ulp / width + ulp);
    }
}

TEST_CASE("the mean over a sphere is a third of the squared width, and it is mirror symmetric") {
    constexpr int size = 400;
    const Input input{
        .color = black(size, size), .attachments = {{"normal", sphere(size)}}, .camera = parallel};
    double pixels = 0;
    for (std::size_t i = 0; i < input.color.pixel_count(); ++i)
        pixels += input.attachments.at("normal").values[3 * i + 2] != 0;
    for (double width : {0.1, 0.35, 0.7, 1.0, 1.7, 4.0}) {
        for (const char* level : {classic, medium}) {
            const Image result = run_effect("rim_light", input, bare({{"width", width}, {"quality", level}}));
            double sum = 0;
            int mirrored = 0;
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x) {
                    sum += result.at(x, y, 0);
                    mirrored += result.at(x, y, 0) != result.at(size - 1 - x, y, 0);
                    mirrored += result.at(x, y, 0) != result.at(x, size - 1 - y, 0);
                }
            }
            const double truth = width <= 1 ? width * width / 3 : 1 - 2 / (3 * width);
            // Pixels that the outline cuts, 1 in 80, are in or out by their centre, which evens out to some 5 %.
            CHECK(sum / pixels == Approx(truth).margin(1e-3));
            CHECK(mirrored == 0);
        }
    }
}

TEST_CASE("in perspective, what each pixel's own ray meets edge on is lit and what it meets head on is not") {
    constexpr int width = 64, height = 37;
    Image edge_on(width, height, 3), head_on(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double across = (2 * x + 1.0 - width) / height * perspective.tan_half_fov();
            const double up = (2 * y + 1.0 - height) / height * perspective.tan_half_fov();
            const double beside = std::hypot(1, across);
            const float normal[] = {float(1 / beside), 0, float(across / beside)};
            const float to_eye[] = {float(-across), float(-up), 1};
            std::memcpy(edge_on.pixel(x, y), normal, sizeof normal);
            std::memcpy(head_on.pixel(x, y), to_eye, sizeof to_eye);
        }
    }
    Input input{.color = black(width, height), .attachments = {{"normal", edge_on}}, .camera = perspective};
    const Worst from_one = worst_difference(run_effect("rim_light", input, bare({})),
                                            convert<double>(constant(width, height, {1, 1, 1})));
    CHECK(from_one.absolute <= 4 * ulp / 0.25);
    input.attachments["normal"] = head_on;
    CHECK(same_bits(run_effect("rim_light", input, bare({{"width", 0.999}})), input.color));
}

TEST_CASE("both faces of a surface are alike, but in the seed's form") {
    Input input{.color = black(64, 36), .attachments = {{"normal", normals(64, 36)}}, .camera = perspective};
    Input turned = input;
    for (float& value : turned.attachments["normal"].values)
        value = -value;
    for (double profile : {ramp, fresnel}) {
        const Values values = bare({{"profile", profile}});
        CHECK(same_bits(run_effect("rim_light", input, values), run_effect("rim_light", turned, values)));
    }
    const Values seed = bare({{"quality", classic}});
    CHECK_FALSE(same_bits(run_effect("rim_light", input, seed), run_effect("rim_light", turned, seed)));
}

TEST_CASE("without a direction, at the sky, and away from rims, light keeps its bits") {
    Input input{.color = noise(16, 4, -5, 60), .camera = perspective};
    input.color.at(0, 0, 0) = -0.0f;
    const std::uint32_t payload = 0x7fc12345u;
    std::memcpy(&input.color.at(1, 0, 2), &payload, sizeof(payload));
    const float hostile[][3] = {{0, 0, 0},        {-0.0f, 0, 0},     {1e-40f, 0, 0},    {not_a_number, 0, 1},
                                {infinity, 0, 0}, {0, -infinity, 0}, {3e38f, 3e38f, 0}, {1e-20f, 1e-20f, 0}};
    Image normal(16, 4, 3);
    for (std::size_t i = 0; i < normal.pixel_count(); ++i)
        std::copy_n(hostile[i % 8], 3, &normal.values[3 * i]);
    for (const char* level : {classic, medium}) {
        for (double profile : {ramp, fresnel}) {
            const Values values = bare({{"profile", profile}, {"quality", level}, {"width", 5}});
            input.attachments = {{"normal", normal}};
            CHECK(same_bits(run_effect("rim_light", input, values), input.color));
            // Without normals but with depth, the sky is known by its depth.
            input.attachments = {{"depth", constant(16, 4, {static_cast<float>(input.camera.sky_depth)})}};
            CHECK(same_bits(run_effect("rim_light", input, values), input.color));
        }
        input.attachments = {{"normal", constant(16, 4, {0, 0, 1})}};
        CHECK(same_bits(run_effect("rim_light", input, {{"width", 0.3}, {"quality", level}}), input.color));
    }
}

TEST_CASE("no strength, no width, no light, and nothing to find edges by change no bit") {
    const Input input{.color = noise(33, 17, -5, 60), .attachments = {{"normal", normals(33, 17)}}};
    const Values at_identity[] = {{{"strength", 0}},
                                  {{"width", 0}},
                                  {{"width", 0}, {"profile", fresnel}, {"quality", classic}},
                                  {{"color.0", 0}, {"color.1", 0}, {"color.2", 0}}};
    for (const Values& values : at_identity) {
        CHECK(same_bits(run_effect("rim_light", input, values), input.color));
        const Plan plan = plan_effect("rim_light", input, values);
        CHECK(plan.passes.empty());
        CHECK(plan.effects.at(0).moment == Moment::configuration);
        CHECK(plan.effects.at(0).kind == SkipKind::exact);
    }
    const Plan blind = plan_effect("rim_light", {.color = input.color}, {});
    CHECK(blind.passes.empty());
    CHECK(blind.effects.at(0).moment == Moment::scene);
    CHECK_FALSE(same_bits(run_effect("rim_light", input, {{"width", 0}, {"profile", fresnel}}), input.color));
}

TEST_CASE("depth alone gives the normals of planes, and silhouettes their own surface's") {
    constexpr int width = 80, height = 45;
    for (const Camera& camera : {perspective, Camera::perspective(60, 0.1, 500, Camera::DepthKind::standard),
                                 parallel, Camera::parallel(2, 0.1, 100, Camera::DepthKind::standard)}) {
        // Two planes at an edge, and sky: n . P = -offset with the view-space normal n.
        const double planes[][4] = {{0, 0.98, 0.199, 1.5}, {0.6, 0, 0.8, 4}};
        Image depth(width, height, 1), normal(width, height, 3);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double half = camera.orthographic ? 1 : camera.tan_half_fov();
                const double across = (2 * x + 1.0 - width) / height * half;
                const double up = (2 * y + 1.0 - height) / height * half;
                const auto& plane = planes[x < width / 2 ? 0 : 1];
                const double along = plane[0] * across + plane[1] * up;
                const double z =
                    camera.orthographic ? (plane[3] + along) / plane[2] : plane[3] / (plane[2] - along);
                const bool sky = !(z > 0.1 && z < 90);
                depth.at(x, y, 0) = static_cast<float>(camera.depth_at(sky ? infinity : z));
                for (int c = 0; c < 3 && !sky; ++c)
                    normal.at(x, y, c) = static_cast<float>(plane[c]);
            }
        }
        const Input seen{.color = black(width, height), .attachments = {{"depth", depth}}, .camera = camera};
        const Input told{
            .color = black(width, height), .attachments = {{"normal", normal}}, .camera = camera};
        const Image result = run_effect("rim_light", seen, bare({{"width", 1}}));
        const Worst worst =
            worst_difference(result, convert<double>(run_effect("rim_light", told, bare({{"width", 1}}))));
        // Half floats keep a normal to 5e-4.
        CHECK(worst.absolute <= 1e-3);
    }
}

TEST_CASE("hostile light stays where it is, and no light is lifted out of half floats") {
    Input input{.color = constant(9, 9, {65504, -65504, 1e-40f}),
                .attachments = {{"normal", constant(9, 9, {1, 0, 0})}},
                .camera = parallel};
    Values most = {{"strength", 100}, {"color.0", 1000}, {"color.1", 1000}, {"color.2", 1000}};
    CHECK(all_finite(run_effect("rim_light", input, most, Format::rgba16f)));
    input.color.at(0, 0, 0) = infinity;
    input.color.at(1, 0, 0) = -infinity;
    input.color.at(2, 0, 0) = not_a_number;
    const Image result = run_effect("rim_light", input, most);
    CHECK(std::count_if(result.values.begin(), result.values.end(), [](float v) { return !std::isfinite(v); })
          == 3);
    CHECK(result.at(3, 0, 0) == 65504);
    CHECK(result.at(3, 0, 1) == 100000 - 65504);
}

TEST_CASE("finite light stays finite whatever depth, normal and values") {
    const float samples[] = {0,        1,         -1,    0.5f, 2, 1e-30f, 1e-40f, not_a_number,
                             infinity, -infinity, 3e38f, 1e-3f};
    std::mt19937 random(5);
    const auto any = [&](double least, double most) { // often an end
        const double u = std::clamp(std::uniform_real_distribution(-0.2, 1.2)(random), 0.0, 1.0);
        return least + (most - least) * std::pow(u, 4);
    };
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 13}, std::pair{17, 9}}) {
        Image depth(width, height, 1), normal(width, height, 3);
        for (int run = 0; run < 30; ++run) {
            for (float& value : depth.values)
                value = samples[random() % std::size(samples)];
            for (float& value : normal.values)
                value = samples[random() % std::size(samples)];
            Input input{.color = noise(width, height, -65504, 65504)};
            if (run % 3 != 0) input.attachments["normal"] = normal;
            if (run % 3 != 1) input.attachments["depth"] = depth;
            const Camera cameras[] = {perspective, parallel,
                                      Camera::perspective(179, 1e-3, 1e7, Camera::DepthKind::standard)};
            input.camera = cameras[run / 3 % 3];
            const Values values = {{"quality", run % 4 % 3 == 0 ? classic : medium},
                                   {"profile", run % 2},
                                   {"width", any(0, 10)},
                                   {"refractive_index", any(1.01, 10)},
                                   {"strength", any(0, 100)},
                                   {"color.0", any(0, 1000)}};
            CHECK(all_finite(run_effect("rim_light", input, values, Format::rgba16f)));
        }
    }
    // The narrowest width there is, met exactly edge on, head on, and in between.
    for (const char* level : {classic, medium}) {
        const Values narrow = bare({{"width", 5e-324}, {"quality", level}});
        for (const auto& [x, z, share] :
             {std::tuple{1.0f, 0.0f, 1.0f}, {0.0f, 1.0f, 0.0f}, {0.7f, 0.7f, 0.0f}}) {
            const Input input{.color = black(1, 1),
                              .attachments = {{"normal", constant(1, 1, {x, 0, z})}},
                              .camera = parallel};
            CHECK(run_effect("rim_light", input, narrow).at(0, 0, 0) == share);
        }
    }
}

TEST_CASE("with a shifted lens the rim is that of the part of a larger picture") {
    constexpr int width = 96, height = 54;
    for (const Camera& camera : {perspective, parallel}) {
        const Input whole{.color = black(width, height),
                          .attachments = {{"normal", normals(width, height)}},
                          .camera = camera};
        for (const char* level : {classic, medium}) {
            const Values values = bare({{"width", 0.5}, {"quality", level}});
            const Image wide = run_effect("rim_light", whole, values);
            for (const Part& part : {Part{48, 0, 48, 54}, Part{0, 27, 96, 27}, Part{5, 9, 31, 23}}) {
                const Input input = part_of(whole, part);
                const Image result = run_effect("rim_light", input, values);
                // The reference's bound for a width of a half; where the axis is, is rounded as often again.
                const double margin = 2 * (4 * ulp / 0.5 + ulp);
                CHECK(worst_difference(result, convert<double>(part_of(three_channels(wide), part))).absolute
                      <= margin);
                CHECK(
                    worst_difference(result, reference(reference_input("rim_light", input, values))).absolute
                    <= margin);
            }
        }
    }
}

TEST_CASE("with a shifted lens normals from depth are those of the part of a larger picture") {
    constexpr int width = 96, height = 54;
    for (const Camera& camera : {perspective, parallel}) {
        // A plane that is seen at 84 degrees at its farthest, where the ramp of width 1 is steep.
        Image depth(width, height, 1);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const auto plane = camera.view_plane(x + 0.5, y + 0.5, width, height);
                const double z = camera.orthographic ? 5 - 1.5 * plane[0] - plane[1]
                                                     : 5 / (1 + 0.7 * plane[0] + 0.4 * plane[1]);
                depth.at(x, y, 0) = static_cast<float>(camera.depth_at(z));
            }
        }
        const Input whole{.color = black(width, height), .attachments = {{"depth", depth}}, .camera = camera};
        const Values values = bare({{"width", 1}});
        const Image wide = run_effect("rim_light", whole, values);
        for (const Part& part : {Part{48, 0, 48, 54}, Part{0, 27, 96, 27}, Part{5, 9, 31, 23}}) {
            const Image result = run_effect("rim_light", part_of(whole, part), values);
            // Normals are stored as half floats: 2^-11 of each component, in both pictures. Of a plane, pixels at the
            // border have the same normal as all others, from one side.
            CHECK(worst_difference(result, convert<double>(part_of(three_channels(wide), part))).absolute
                  <= 2 * std::sqrt(3) * 0x1p-11);
        }
    }
}
