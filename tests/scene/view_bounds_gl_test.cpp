// What is said of a view beforehand, against the pixels that are drawn then.
#include <scene/renderer.hpp>
#include <scene/view_bounds.hpp>

#include <gl/clock.hpp>
#include <gl/objects.hpp>
#include <testing.hpp>

#include <catch2/catch.hpp>

#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

using namespace postfx;
using namespace postfx::host;

namespace {

const std::string scenes = POSTFX_SOURCE_DIRECTORY "/configs/scenes";

bool says_empty(const SceneBounds& bounds, const std::string& attachment) {
    return std::find(bounds.empty.begin(), bounds.empty.end(), attachment) != bounds.empty.end();
}

/// The same figures, from the pixels; nothing where there is only sky.
std::optional<SceneBounds> measured(const Image& depth, const Camera& camera) {
    const glm::dmat4 to_world = glm::make_mat4(camera.view_to_world.data());
    SceneBounds found{SceneBounds::infinity, 0, 0, SceneBounds::infinity, -SceneBounds::infinity, {}};
    bool any = false;
    for (int y = 0; y < depth.height; ++y) {
        for (int x = 0; x < depth.width; ++x) {
            const auto sample = static_cast<double>(depth.at(x, y, 0));
            if (sample == camera.sky_depth) continue;
            any = true;
            const double z = camera.view_z(sample);
            const auto [right, up] = camera.view_plane(x + 0.5, y + 0.5, depth.width, depth.height);
            const glm::dvec2 at(right, up);
            const glm::dvec3 point(camera.orthographic ? at : at * z, -z);
            const double height = (to_world * glm::dvec4(point, 1)).y;
            found.nearest = std::min(found.nearest, z);
            found.farthest = std::max(found.farthest, z);
            found.reach = std::max(found.reach, camera.orthographic ? z : glm::length(point));
            found.lowest = std::min(found.lowest, height);
            found.highest = std::max(found.highest, height);
        }
    }
    return any ? std::optional(found) : std::nullopt;
}

void check_view(SceneRenderer& renderer, ViewBounds& view_bounds, double time, glm::ivec2 size,
                const std::optional<Camera>& own_camera = std::nullopt) {
    const Camera camera = own_camera.value_or(renderer.scene().camera_at(time));
    const SceneBounds said = view_bounds.at(time, camera, size.x, size.y);
    const SceneFrame frame =
        renderer.render(size.x, size.y, time, postfx::attachment_names(), CameraOverride{camera, {}});
    INFO(renderer.scene().name << " at " << time << " s, " << size.x << "x" << size.y);
    for (const SceneAttachment& attachment : frame.attachments) {
        if (!says_empty(said, attachment.name)) continue;
        INFO(attachment.name);
        const Image image = gl::read_texture(attachment.texture, size.x, size.y, attachment.format);
        bool zero = true; // alpha apart, which says where surfaces are
        for (std::size_t i = 0; i < image.values.size(); ++i)
            zero = zero && (image.values[i] == 0 || (image.channels == 4 && i % 4 == 3));
        CHECK(zero);
    }
    const auto found =
        measured(gl::read_texture(frame.texture("depth"), size.x, size.y, Format::depth32f), camera);
    if (!found) return;
    CHECK_FALSE(says_empty(said, "depth"));
    CHECK(said.nearest <= found->nearest);
    CHECK(said.farthest >= found->farthest);
    CHECK(said.reach >= found->reach);
    CHECK(said.lowest <= found->lowest);
    CHECK(said.highest >= found->highest);
}

/// `yaml` as a scene, seen by its camera at 96x64.
SceneBounds bounds_of(const std::string& yaml) {
    const Scene scene = parse_scene(yaml, "test.yaml");
    return ViewBounds(scene).at(0, scene.camera_at(0), 96, 64);
}

const std::string camera_of_90 =
    "camera: {position: [0, 0, 0], look_at: [0, 0, -1], vertical_fov: 90, near: 0.25}\n";

} // namespace

TEST_CASE("bounds hold for every pixel of the shipped scenes") {
    for (const SceneEntry& entry : list_scenes(scenes)) {
        const Scene scene = open_scene(entry.name, scenes);
        ViewBounds view_bounds(scene);
        for (const int samples : {1, 4}) {
            SceneRenderer renderer(scene, {samples});
            for (const double time : {0.0, 1.7, 13.0, 3601.5}) {
                check_view(renderer, view_bounds, time, {320, 180});
                check_view(renderer, view_bounds, time, {37, 61});
            }
        }
    }
}

TEST_CASE("bounds hold wherever the camera looks") {
    const unsigned seed = 4;
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (const SceneEntry& entry : list_scenes(scenes)) {
        const Scene scene = open_scene(entry.name, scenes);
        ViewBounds view_bounds(scene);
        SceneRenderer renderer(scene);
        for (int i = 0; i < 25; ++i) {
            INFO("seed " << seed << ", view " << i);
            Camera camera = i % 5 == 4 ? Camera::parallel(between(0.5, 40), 0.1, between(1, 400))
                                       : Camera::perspective(between(5, 120), std::pow(10, between(-2, 1)));
            if (i % 2 == 1) camera.principal_point = {between(-1.5, 1.5), between(-1.5, 1.5)};
            const Camera own = scene.camera_at(between(0, 50));
            const glm::dvec3 eye = glm::dvec3(glm::make_mat4(own.view_to_world.data())[3])
                                   + glm::dvec3(between(-8, 8), between(-1, 8), between(-8, 8));
            const glm::dmat4 frame = look_at_matrix(
                eye, eye + glm::dvec3(between(-1, 1), between(-1, 0.6), between(-1, 1)), {0, 1, 0});
            std::copy_n(glm::value_ptr(frame), 16, camera.view_to_world.begin());
            check_view(renderer, view_bounds, 0.5 * i, {64, 48}, camera);
        }
    }
}

TEST_CASE("bounds are tight where boxes are all that there is") {
    // 1 % is left for rounding and for pixels beside their samples (half a pixel of 64 is 1.6 % of the half height).
    SECTION("in front") {
        const SceneBounds box =
            bounds_of(camera_of_90 + "nodes: [{position: [0, 0, -8], mesh: {box: {size: [2, 4, 6]}}}]\n");
        CHECK(box.nearest == Approx(5).epsilon(0.001));
        CHECK(box.farthest == Approx(11).epsilon(0.001));
        CHECK(box.reach == Approx(std::sqrt(1 + 4 + 121)).epsilon(0.03));
        CHECK(box.lowest == Approx(-2).margin(0.3));
        CHECK(box.highest == Approx(2).margin(0.3));
    }
    SECTION("only what is within the view counts") {
        // The ground, 2 m below, comes into view where the lower edge of the picture meets it: 45 degrees down.
        const SceneBounds ground =
            bounds_of(camera_of_90 + "nodes: [{position: [0, -2, 0], mesh: {plane: {size: [200, 60]}}}]\n");
        CHECK(ground.nearest == Approx(2).epsilon(0.01));
        CHECK(ground.farthest == Approx(30).epsilon(0.01));
        CHECK(ground.highest < -1);
    }
    SECTION("inside of a box, the near plane bounds") {
        const SceneBounds inside = bounds_of(camera_of_90 + "nodes: [{mesh: {box: {size: [20, 20, 20]}}}]\n");
        CHECK(inside.nearest == 0.25);
        CHECK(inside.farthest == Approx(10).epsilon(0.001));
    }
    SECTION("parallel") {
        const SceneBounds box = bounds_of(
            "camera: {position: [0, 0, 0], look_at: [0, 0, -1], orthographic_extent: 8, near: 1, far: 9}\n"
            "nodes: [{position: [0, 3.5, -8], mesh: {box: {size: [2, 3, 6]}}}]\n");
        CHECK(box.nearest == Approx(5).epsilon(0.001));
        CHECK(box.farthest == Approx(9).epsilon(0.001));
        CHECK(box.reach == box.farthest);
        CHECK(box.lowest == Approx(2).margin(0.1));
        CHECK(box.highest == Approx(4).margin(0.1));
    }
}

TEST_CASE("what can't be in an attachment is known") {
    using Names = std::vector<std::string>;
    const std::string lamp =
        "materials: {lamp: {emission: [1, 1, 1]}, glass: {opacity: 0.5}, dark: {diffuse: 0}}\n";
    const auto empty = [&](const std::string& yaml) { return bounds_of(camera_of_90 + lamp + yaml).empty; };
    CHECK(empty("background: [1, 1, 1]\n") == Names{"depth", "normal", "emission", "ambient"});
    CHECK(empty("nodes: [{position: [0, 0, -5], mesh: {box: {}}}]\n") == Names{"emission", "ambient"});
    CHECK(empty("ambient: 0.1\nnodes: [{position: [0, 0, -5], mesh: {box: {}}}]\n") == Names{"emission"});
    CHECK(empty("ambient: 0.1\nnodes: [{position: [0, 0, -5], mesh: {box: {}}, material: dark}]\n")
          == Names{"emission", "ambient"});
    // The background is mirrored.
    CHECK(empty("background: [0, 0, 1]\nnodes: [{position: [0, 0, -5], mesh: {box: {}}, material: dark}]\n")
          == Names{"emission"});
    CHECK(empty("nodes: [{position: [0, 0, -5], mesh: {box: {}}, material: lamp}]\n") == Names{"ambient"});
    // A lamp behind the camera shines on nobody's picture.
    CHECK(empty("nodes: [{position: [0, 0, 5], mesh: {box: {}}, material: lamp}]\n")
          == Names{"depth", "normal", "emission", "ambient"});
    // What is blended leaves no depth, but light.
    CHECK(empty("ambient: 0.1\nnodes: [{position: [0, 0, -5], mesh: {box: {}}, material: glass}]\n")
          == Names{"depth", "normal", "emission"});
}

TEST_CASE("bounds of a large scene cost far less than a frame") {
    const Scene scene = open_scene("night_drive", scenes);
    ViewBounds view_bounds(scene);
    const Camera camera = scene.camera_at(0);
    constexpr int rounds = 20;
    double best = 1e9; // others may use the machine meanwhile
    for (int i = 0; i < rounds; ++i) {
        const gl::HostTime start = gl::HostTime::now();
        view_bounds.at(0.1 * i, camera, 1280, 720);
        best = std::min(best, gl::HostTime::now().cpu_ms - start.cpu_ms);
    }
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__)
    CHECK(best < 1); // ms
#else
    CHECK(best < 100); // unoptimised; only an accident is caught
#endif
}
