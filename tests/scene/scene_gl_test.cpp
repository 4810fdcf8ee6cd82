// The scene renderer: what its attachments hold, against what the scene says in numbers.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include <gl/context.hpp>
#include <gl/objects.hpp>
#include <postfx/error.hpp>
#include <scene/renderer.hpp>
#include <temporary_directory.hpp>
#include <testing.hpp>

#include <glm/glm.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

using namespace postfx::host;
using postfx::Image;

namespace {

constexpr int size = 64;

SceneRenderer renderer(const std::string& yaml, int samples = 1) {
    return SceneRenderer(parse_scene(yaml, "test.yaml"), {samples});
}

Image read(const SceneFrame& frame, const std::string& name, int width = size, int height = size) {
    for (const SceneAttachment& attachment : frame.attachments) {
        if (attachment.name == name) {
            return postfx::gl::read_texture(attachment.texture, width, height, attachment.format);
        }
    }
    FAIL("no attachment " << name);
    return {};
}

glm::vec3 rgb(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

glm::vec3 middle(const Image& image) {
    return rgb(image, image.width / 2, image.height / 2);
}

/// Largest difference of a channel.
float apart(glm::vec3 a, glm::vec3 b) {
    const glm::vec3 d = glm::abs(a - b);
    return std::max(d.x, std::max(d.y, d.z));
}

/// A value near 1 has steps of 2^-11 in half floats; two roundings and the shader's own float arithmetic stay
/// below 2.
constexpr float half_steps = 2.0f / 2048;

void check_quiet() {
    for (const std::string& message : postfx::gl::take_debug_messages()) {
        FAIL_CHECK("OpenGL says: " << message);
    }
}

/// Of the names that a context of this test's size can have handed out.
int count_objects() {
    int count = 0;
    for (GLuint name = 1; name < 2000; ++name) {
        count += glIsTexture(name) + glIsBuffer(name) + glIsFramebuffer(name) + glIsProgram(name)
                 + glIsVertexArray(name) + glIsSampler(name) + glIsQuery(name);
    }
    return count;
}

/// Facing the camera at z = -8, white, lit by ambient light of 0.5.
const std::string wall =
    "camera: {position: [0, 0, 0], look_at: [0, 0, -1], vertical_fov: 60, near: 0.25}\n"
    "ambient: 0.5\n"
    "materials: {white: {diffuse: 1, specular: 0}}\n"
    "nodes:\n"
    "  - {position: [0, 0, -8], rotation: [90, 0, 0], mesh: {plane: {size: [6, 6]}}, material: white}\n";

} // namespace

TEST_CASE("depth is near / z, and exactly 0 where nothing is") {
    for (const int samples : {1, 4}) {
        auto scene = renderer(wall, samples);
        const SceneFrame frame = scene.render(size, size, 0, {"depth"});
        const Image depth = read(frame, "depth");
        // The hardware interpolates in float32: some units in the last place of 2^-24.
        CHECK(depth.at(size / 2, size / 2, 0) == Approx(0.25 / 8).epsilon(1e-6));
        CHECK(frame.camera.view_z(static_cast<double>(depth.at(size / 2, size / 2, 0)))
              == Approx(8).epsilon(1e-6));
        CHECK(depth.at(0, 0, 0) == 0.0f);
        CHECK(frame.camera.sky_depth == 0);
    }
    check_quiet();
}

TEST_CASE("depth of an orthographic camera is linear in z") {
    auto scene = renderer(
        "camera: {position: [0, 0, 0], look_at: [0, 0, -1], orthographic_extent: 8, near: 1, far: 21}\n"
        "nodes:\n"
        "  - {position: [0, 0, -6], rotation: [90, 0, 0], mesh: {plane: {size: [4, 4]}}}\n");
    const SceneFrame frame = scene.render(size, size, 0, {});
    const Image depth = read(frame, "depth");
    CHECK(depth.at(size / 2, size / 2, 0) == Approx(15.0 / 20).epsilon(1e-6));
    CHECK(frame.camera.view_z(static_cast<double>(depth.at(size / 2, size / 2, 0)))
          == Approx(6).epsilon(1e-6));
    CHECK(depth.at(size / 8, size / 2, 0) == 0.0f); // the plane spans half of the picture
    CHECK(depth.at(size / 4 + 1, size / 2, 0) > 0.0f);
    check_quiet();
}

TEST_CASE("only what is wanted is made") {
    auto scene = renderer(wall);
    const auto names = [&](const std::vector<std::string>& wanted) {
        std::vector<std::string> result;
        for (const auto& attachment : scene.render(size, size, 0, wanted).attachments)
            result.push_back(attachment.name);
        return result;
    };
    using Names = std::vector<std::string>;
    CHECK(names({}) == Names{"color", "depth"});
    CHECK(names({"depth", "normal"}) == Names{"color", "depth", "normal"});
    CHECK(names({"ambient", "emission"}) == Names{"color", "depth", "emission", "ambient"});
    CHECK(scene.render(size, size, 0, {}).texture("normal") == 0);
    CHECK_THROWS_WITH(names({"nromal"}), Catch::Contains("did you mean \"normal\"?"));
    check_quiet();
}

TEST_CASE("depth that nobody reads is not brought out of the samples") {
    auto scene = renderer(wall, 4);
    const Image with = read(scene.render(size, size, 0, {"depth"}), "color");
    const std::size_t bytes = scene.render(size, size, 0, {"depth"}).texture_bytes;
    const SceneFrame frame = scene.render(size, size, 0, {"color"});
    CHECK(frame.texture("depth") == 0);
    CHECK(bytes - frame.texture_bytes == 4 * size * size);
    CHECK(read(frame, "color").values == with.values);
    CHECK(scene.render(size, size, 0, {"normal"}).texture("depth") != 0); // normals are of the nearest sample
    check_quiet();
}

TEST_CASE("what is wanted may change with every frame, and no program is made twice") {
    auto scene = renderer(wall);
    const auto draw_all = [&] {
        for (const char* name : {"normal", "emission", "depth"})
            scene.render(size, size, 0, {name});
    };
    draw_all();
    const int before = count_objects();
    draw_all();
    CHECK(count_objects() == before);
    check_quiet();
}

TEST_CASE("normals of a sphere are those of a sphere") {
    for (const int samples : {1, 4}) {
        auto scene =
            renderer("camera: {position: [3, 0, 4], look_at: [0, 0, 0], orthographic_extent: 2.4, far: 50}\n"
                     "nodes: [{mesh: {sphere: {radius: 1, segments: 256}}}]\n",
                     samples);
        const Image normal = read(scene.render(size, size, 0, {"normal"}), "normal");
        for (const glm::ivec2 pixel : {glm::ivec2(32, 32), {40, 30}, {20, 44}, {32, 50}, {12, 30}}) {
            INFO(pixel.x << " " << pixel.y << ", samples " << samples);
            const glm::vec2 plane = (glm::vec2(pixel) + 0.5f) / static_cast<float>(size) * 2.4f - 1.2f;
            const glm::vec3 expected(plane, std::sqrt(1 - glm::dot(plane, plane)));
            // One sample of four lies up to 0.42 pixels, here 0.016 m, off the pixel's centre, more in z on
            // the flank.
            CHECK(apart(rgb(normal, pixel.x, pixel.y), expected) < (samples == 1 ? 0.004f : 0.03f));
            CHECK(glm::length(rgb(normal, pixel.x, pixel.y)) == Approx(1).epsilon(0.001));
        }
        CHECK(rgb(normal, 0, 0) == glm::vec3(0));
    }
    check_quiet();
}

TEST_CASE("ambient light is the ambient attachment, emission the emission attachment") {
    auto scene = renderer(
        "camera: {position: [0, 0, 0], look_at: [0, 0, -1], vertical_fov: 60}\n"
        "ambient: 0.5\n"
        "materials: {lamp: {diffuse: [0.5, 1, 1], specular: 0, emission: [30, 2, 0]}}\n"
        "nodes:\n"
        "  - {light: {directional: {color: [0.25, 0.25, 0.25]}}}\n"
        "  - {position: [0, 0, -8], rotation: [90, 0, 0], mesh: {plane: {size: [6, 6]}}, material: lamp}\n");
    const SceneFrame frame = scene.render(size, size, 0, {"emission", "ambient"});
    CHECK(apart(middle(read(frame, "ambient")), {0.25f, 0.5f, 0.5f}) < half_steps);
    CHECK(apart(middle(read(frame, "emission")), {30, 2, 0}) < 30 * half_steps);
    CHECK(apart(middle(read(frame, "color")), {30.375f, 2.75f, 0.75f}) < 31 * half_steps);
    CHECK(rgb(read(frame, "emission"), 0, 0) == glm::vec3(0));
    CHECK(rgb(read(frame, "ambient"), 0, 0) == glm::vec3(0));
    check_quiet();
}

TEST_CASE("a light fades as 1 / (x + y L + z L^2)") {
    for (const double distance : {1.0, 3.0, 7.0}) {
        auto scene =
            renderer("camera: {position: [0, 0, 0], look_at: [0, 0, -1], vertical_fov: 2}\n"
                     "materials: {white: {diffuse: 1, specular: 0}}\n"
                     "nodes:\n"
                     "  - {position: [0, 0, -8], rotation: [90, 0, 0], mesh: {plane: {}}, material: white}\n"
                     "  - {position: [0, 0, "
                     + std::to_string(distance - 8)
                     + "], light: {point: {intensity: 2, attenuation: [1, 0.5, 0.25]}}}\n");
        const double expected = 2 / (1 + 0.5 * distance + 0.25 * distance * distance);
        const Image color = read(scene.render(size, size, 0, {}), "color");
        CHECK(middle(color).g == Approx(expected).epsilon(0.002)); // half floats, and a degree off the axis
    }
    check_quiet();
}

TEST_CASE("a spot light ends at its angle, and what stands in it casts a shadow") {
    const std::string lit =
        "camera: {position: [0, 0, 0], look_at: [0, 0, -1], vertical_fov: 60}\n"
        "materials: {white: {diffuse: 1, specular: 0}}\n"
        "nodes:\n"
        "  - {position: [0, 0, -8], rotation: [90, 0, 0], mesh: {plane: {size: [20, 20]}}, material: white}\n"
        "  - {light: {spot: {attenuation: [1, 0, 0], inner_angle: 15, outer_angle: 20, shadow: true}}}\n";
    auto open = renderer(lit);
    const Image color = read(open.render(size, size, 0, {}), "color");
    CHECK(middle(color).g == Approx(1).epsilon(0.005));
    // 60 degrees over 64 pixels: tan(25 degrees) / tan(30 degrees) of the half is beyond the outer angle.
    CHECK(rgb(color, 32 + static_cast<int>(32 * std::tan(0.436) / std::tan(0.5236)), 32) == glm::vec3(0));

    auto blocked =
        renderer(lit + "  - {position: [0.8, 0, -3], mesh: {box: {size: [1, 3, 0.1]}}, material: white}\n");
    postfx::Camera beside = postfx::Camera::perspective(60, 0.1);
    beside.view_to_world[12] = -2; // 2 m to the left, where the shadow behind the box can be seen
    const Image shadowed = read(blocked.render(size, size, 0, {}, CameraOverride{beside, {}}), "color");
    const auto column = [](double x) { return static_cast<int>(32 + 32 * (x + 2) / 8 / std::tan(0.5236)); };
    CHECK(rgb(shadowed, column(-0.5), 32).g == Approx(1).epsilon(0.02));
    CHECK(rgb(shadowed, column(1.4), 32).g < 0.01f); // 0.3 to 1.3 at 3 m throws 0.8 to 3.5 at 8 m
    check_quiet();
}

TEST_CASE("what is transparent is blended from back to front, in whatever order it is named") {
    const std::string red =
        "  - {position: [0, 0, -3], rotation: [90, 0, 0], mesh: {plane: {}}, material: red}\n";
    const std::string green =
        "  - {position: [0, 0, -5], rotation: [90, 0, 0], mesh: {plane: {size: [2, 2]}}, material: green}\n";
    const std::string head =
        "camera: {position: [0, 0, 0], look_at: [0, 0, -1], vertical_fov: 10, near: 0.25}\n"
        "background: [0, 0, 1]\n"
        "materials:\n"
        "  red: {diffuse: 0, specular: 0, emission: [1, 0, 0], opacity: 0.5}\n"
        "  green: {diffuse: 0, specular: 0, emission: [0, 1, 0], opacity: 0.25}\n"
        "nodes:\n";
    for (const std::string& nodes : {red + green, green + red}) {
        auto scene = renderer(head + nodes);
        const SceneFrame frame = scene.render(size, size, 0, {"normal", "emission"});
        CHECK(apart(middle(read(frame, "color")), {0.5f, 0.125f, 0.375f}) < half_steps);
        CHECK(apart(middle(read(frame, "emission")), {0.5f, 0.125f, 0}) < half_steps);
        CHECK(read(frame, "color").at(size / 2, size / 2, 3) == 1.0f);
        CHECK(read(frame, "depth").at(size / 2, size / 2, 0) == 0.0f); // writes no depth
        CHECK(middle(read(frame, "normal")) == glm::vec3(0));          // normals are of opaque surfaces
    }
    check_quiet();
}

TEST_CASE("a shifted lens shows the same from the same place, moved sideways") {
    auto scene = renderer(wall);
    const Image straight = read(scene.render(size, size, 0, {}), "depth");
    const postfx::Camera camera = scene.scene().camera_at(0);
    const Image shifted = read(scene.render(size, size, 0, {}, CameraOverride{camera, {0.25, 0}}), "depth");
    int different = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size - 8; ++x)
            different += shifted.at(x, y, 0) != straight.at(x + 8, y, 0);
    }
    CHECK(different == 0); // 0.25 of half of 64 pixels is 8 whole ones
    check_quiet();
}

TEST_CASE("an off-centre camera draws the part of a larger picture") {
    constexpr int wide = 128, high = 64;
    for (const char* lens : {"vertical_fov: 60", "orthographic_extent: 4, far: 50"}) {
        SceneRenderer drawn =
            renderer("camera: {position: [0, 1, 4], look_at: [0, 0.5, 0], " + std::string(lens)
                     + "}\n"
                       "materials: {white: {diffuse: 1, specular: 0}}\n"
                       "nodes:\n"
                       "  - {position: [0.9, 0.6, 0], mesh: {sphere: {radius: 0.8}}, material: white}\n"
                       "  - {mesh: {plane: {size: [20, 20]}}, material: white}\n");
        postfx::Camera camera = drawn.scene().camera_at(0);
        const Image whole =
            read(drawn.render(wide, high, 0, {"depth"}, CameraOverride{camera, {}}), "depth", wide, high);
        camera.principal_point = {-1, 0}; // the axis lies on the left border of the right half
        const Image part = read(drawn.render(wide / 2, high, 0, {"depth"}, CameraOverride{camera, {}}),
                                "depth", wide / 2, high);
        int different = 0;
        for (int y = 0; y < high; ++y) {
            for (int x = 0; x < wide / 2; ++x) {
                const float expected = whole.at(wide / 2 + x, y, 0);
                // Interpolated from other corners of clipped triangles.
                different += std::abs(part.at(x, y, 0) - expected) > 1e-5f + 1e-4f * expected;
            }
        }
        CHECK(different <= 4); // pixels of the ball's outline, whose corners are rounded to 1/256 pixel
    }
}

TEST_CASE("time alone decides, and steady frames make no OpenGL objects") {
    auto scene =
        renderer("camera: {position: [0, 1, 5], look_at: [0, 0, 0]}\n"
                 "ambient: 0.4\n"
                 "nodes:\n"
                 "  - {mesh: {box: {}}, animate: {rotate: {axis: [0, 1, 0], degrees_per_second: 30}}}\n"
                 "  - {position: [2, 3, 1], look_at: [0, 0, 0], light: {directional: {shadow: true}}}\n");
    const Image first = read(scene.render(size, size, 0.7, {"normal"}), "color");
    const Image other = read(scene.render(size, size, 1.4, {"normal"}), "color");
    const int before = count_objects();
    const Image again = read(scene.render(size, size, 0.7, {"normal"}), "color");
    CHECK(first.values == again.values);
    CHECK(first.values != other.values);
    CHECK(count_objects() == before);
    check_quiet();
}

TEST_CASE("shipped scenes and unusual sizes draw finite pictures") {
    const std::string scenes = POSTFX_SOURCE_DIRECTORY "/configs/scenes";
    for (const SceneEntry& entry : list_scenes(scenes)) {
        INFO(entry.name);
        SceneRenderer scene(open_scene(entry.name, scenes));
        for (const glm::ivec2 at : {glm::ivec2(160, 90), {1, 1}, {7, 33}}) {
            const SceneFrame frame = scene.render(at.x, at.y, 3, postfx::attachment_names());
            for (const std::string& name : postfx::attachment_names()) {
                INFO(name);
                const Image image = read(frame, name, at.x, at.y);
                std::size_t not_finite = 0;
                for (const float value : image.values)
                    not_finite += !std::isfinite(value);
                CHECK(not_finite == 0);
            }
        }
        // What shines is far above white, and nothing is black all over.
        float brightest = 0;
        for (const float value : read(scene.render(160, 90, 0, {}), "color", 160, 90).values) {
            brightest = std::max(brightest, value);
        }
        CHECK(brightest > (scene.scene().contents().emitters ? 2.0f : 0.2f));
    }
    check_quiet();
}

TEST_CASE("models of other people draw with their textures") {
    const char* given = std::getenv("POSTFX_TEST_DATA");
    const std::filesystem::path root =
        given ? std::filesystem::path(given)
              : std::filesystem::path(POSTFX_SOURCE_DIRECTORY) / "../shared/data";
    for (const std::string name : {"cornell_box/cornell_box.obj", "FlightHelmet/FlightHelmet.gltf"}) {
        if (!std::filesystem::exists(root / name)) {
            std::cout << "skipped: there is no " << (root / name).string() << " (set POSTFX_TEST_DATA)\n";
            continue;
        }
        INFO(name);
        SceneRenderer scene(open_scene((root / name).string(), ""));
        const SceneFrame frame = scene.render(size, size, 0, {"normal"});
        const Image color = read(frame, "color"), depth = read(frame, "depth");
        std::size_t covered = 0, dark = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                if (depth.at(x, y, 0) == 0) continue;
                ++covered;
                dark += rgb(color, x, y) == glm::vec3(0);
            }
        }
        CHECK(covered > size * size / 6); // fills a good part of the picture
        CHECK(covered < size * size * 9 / 10);
        CHECK(dark < covered / 100);
    }
    check_quiet();
}

TEST_CASE("a bare model is neither burnt out nor dark, whatever it reflects") {
    const postfx::testing::TemporaryDirectory folder;
    // A room without its front wall, and the same walls closed: seen from inside or outside as their fronts say.
    const std::string corners =
        "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";
    const std::string room = "f 1 2 3 4\nf 1 5 6 2\nf 4 3 7 8\nf 1 4 8 5\nf 2 6 7 3\n";
    const std::string block = "f 4 3 2 1\nf 5 6 7 8\nf 2 6 5 1\nf 8 7 3 4\nf 5 8 4 1\nf 3 7 6 2\n";
    for (const std::string& faces : {room, block}) {
        for (const char* white : {"1 1 1", "0.73 0.73 0.73", "0.25 0.25 0.25"}) {
            INFO((faces == room ? "room" : "block") << " of " << white);
            std::ofstream(folder / "m.mtl") << "newmtl white\nKd " << white << "\nKs 0 0 0\n";
            std::ofstream(folder / "m.obj") << "mtllib m.mtl\n" << corners << "usemtl white\n" << faces;
            SceneRenderer scene(open_scene((folder / "m.obj").string(), ""));
            const SceneFrame frame = scene.render(size, size, 0, {});
            const Image color = read(frame, "color"), depth = read(frame, "depth");
            float brightest = 0;
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x) {
                    if (depth.at(x, y, 0) != 0) brightest = std::max(brightest, color.at(x, y, 1));
                }
            }
            // Below the display's white; above mid-grey (0.18), as the lit side of anything but black should be.
            CHECK(brightest < 1);
            CHECK(brightest > 0.3f);
        }
    }
    check_quiet();
}

int main(int argc, char* argv[]) {
    std::string why;
    if (!postfx::testing::has_gl(&why)) return postfx::testing::skipped(why);
    const postfx::gl::HeadlessContext context(true);
    postfx::gl::enable_debug_output();
    return Catch::Session().run(argc, argv);
}
