// Scenes without OpenGL: what files may say, what geometry is made, where things are.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include <postfx/error.hpp>
#include <scene/generators.hpp>
#include <scene/model.hpp>
#include <scene/scene.hpp>
#include <temporary_directory.hpp>

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <string>
#include <thread>

#include <sys/stat.h>

using namespace postfx::host;

namespace {

const std::filesystem::path scenes = std::filesystem::path(POSTFX_SOURCE_DIRECTORY) / "configs/scenes";

/// A file of the collection of other people's data, or "" (and a line that says so) where there is none.
std::filesystem::path test_data(const std::string& name) {
    const char* given = std::getenv("POSTFX_TEST_DATA");
    const std::filesystem::path root =
        given ? std::filesystem::path(given)
              : std::filesystem::path(POSTFX_SOURCE_DIRECTORY) / "../shared/data";
    if (std::filesystem::exists(root / name)) return root / name;
    std::cout << "skipped: there is no " << (root / name).string() << " (set POSTFX_TEST_DATA)\n";
    return {};
}

std::string message_of(const std::string& yaml) {
    try {
        parse_scene(yaml, "s.yaml");
    } catch (const postfx::Error& error) {
        return error.what();
    }
    return "no error";
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position),
            b(mesh.vertices[mesh.indices[i + 1]].position), c(mesh.vertices[mesh.indices[i + 2]].position);
        sum += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return sum;
}

/// By the divergence theorem: right, and positive, only for a closed mesh whose fronts are outside.
double volume(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position),
            b(mesh.vertices[mesh.indices[i + 1]].position), c(mesh.vertices[mesh.indices[i + 2]].position);
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}

/// The same about another point: equal only if the mesh has no hole.
double volume_from_elsewhere(Mesh mesh) {
    for (Vertex& vertex : mesh.vertices)
        vertex.position += glm::vec3(3, -2, 5);
    return volume(mesh);
}

void check_sane(const Mesh& mesh) {
    REQUIRE_FALSE(mesh.empty());
    REQUIRE(mesh.indices.size() % 3 == 0);
    std::size_t wrong_normals = 0, wrong_indices = 0, not_finite = 0;
    for (const Vertex& vertex : mesh.vertices) {
        if (std::abs(glm::length(vertex.normal) - 1) > 1e-4f)
            ++wrong_normals; // float rounding of a normalize
        if (!std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z)) ++not_finite;
    }
    for (const std::uint32_t index : mesh.indices)
        wrong_indices += index >= mesh.vertices.size();
    CHECK(wrong_normals == 0);
    CHECK(not_finite == 0);
    CHECK(wrong_indices == 0);
}

} // namespace

TEST_CASE("a mistake in a scene file is one message with its place") {
    struct Row {
        std::string yaml, message;
    };
    const std::vector<Row> rows = {
        {"nodse: []", "s.yaml:1:1: unknown key \"nodse\" in scene; did you mean \"nodes\"?"},
        {"nodes:\n  - mesh: {box: {sise: [1, 1, 1]}}",
         "s.yaml:2:18: unknown key \"sise\" in box; did you mean \"size\"?"},
        {"nodes:\n  - mesh: {bocks: {}}",
         "s.yaml:2:12: unknown word \"bocks\", expected one of model, box, sphere, plane, cylinder, cone, "
         "torus, faces, "
         "road, terrain, tree, forest, grass, posts, car, lamp_posts, sparks, lathe, twigs, "
         "light_string"},
        {"nodes:\n  - mesh: {box: {size: [1, 2]}}", "s.yaml:2:24: expected [x, y, z], found a list"},
        {"nodes:\n  - mesh: {box: {size: [1, 2, -1]}}",
         "s.yaml:2:31: -1 is out of range, expected 1e-06 to 1000000"},
        {"nodes:\n  - position: up", "s.yaml:2:15: expected [x, y, z], found \"up\""},
        {"nodes:\n  - mesh: {sphere: {segments: 7.5}}", "s.yaml:2:31: expected a whole number, found 7.5"},
        {"nodes:\n  - {name: a}\n  - {name: a}", "s.yaml:3:12: there is already a node \"a\""},
        {"nodes:\n  - scale: 0", "s.yaml:2:12: a scale of 0 leaves nothing"},
        {"nodes:\n  - material: red", "s.yaml:2:15: a node without a mesh has no material"},
        {"materials: {red: {}}\nnodes:\n  - {mesh: {box: {}}, material: rde}",
         "s.yaml:3:33: there is no material \"rde\"; did you mean \"red\"?"},
        {"materials:\n  a: {diffuse: [2, 0, 0]}", "s.yaml:2:17: 2 is out of range, expected 0 to 1"},
        {"materials:\n  a: {emission: .inf}", "s.yaml:2:17: expected a number, found \".inf\""},
        {"materials:\n  a: {diffuse_texture: no.png}", "s.yaml:2:24: can't read no.png: no such file"},
        {"nodes:\n  - mesh: {model: no.obj}", "s.yaml:2:19: can't read no.obj: no such file"},
        {"nodes:\n  - mesh: {terrain: {}}",
         "s.yaml:2:21: this stands on the terrain, and the scene has no \"terrain\""},
        {"nodes:\n  - light: {lamp: {}}",
         "s.yaml:2:13: unknown word \"lamp\", expected one of directional, point, spot"},
        {"nodes:\n  - light: {point: {attenuation: [0, 0, 0]}}",
         "s.yaml:2:34: expected [x, y, z] of which one is above 0"},
        {"nodes:\n  - light: {spot: {inner_angle: 40, outer_angle: 30}}",
         "s.yaml:2:33: the inner angle is larger than the outer one"},
        {"camera: {far: 10}", "s.yaml:1:15: only an orthographic camera has a far plane"},
        {"camera: {parent: car}", "s.yaml:1:18: there is no node \"car\""},
        {"camera: {position: [1, 1, 1], look_at: [1, 1, 1]}",
         "s.yaml:1:9: the camera looks at its own position"},
        {"camera: {near: 1, near: 2}", "s.yaml:1:19: \"near\" stands here a second time"},
        {"paths: {a: {points: [[0, 0, 0]]}}", "s.yaml:1:21: expected 2 to 10000 points, found 1"},
        {"nodes:\n  - animate: {orbit: {}}", "s.yaml:2:22: orbit needs \"degrees_per_second\""},
        {"nodes: [&a {light: {spot: {shadow: true}}}, *a, *a, *a, *a]",
         "s.yaml:1:20: at most 4 lights of a scene cast shadows"},
        {"include: missing.yaml", "s.yaml:1:10: can't read missing.yaml: no such file"},
        {"nodes: [", "s.yaml:1:8: this is not YAML: the \"[\" that opens here is never closed"},
        {"nodes:\n  - {name: \"a}\n  - {name: \"b\"}",
         "s.yaml:2:12: this is not YAML: the quote that opens here is not closed on its line"},
        {"nodes:\n\t- {name: a}", "s.yaml:2:1: this is not YAML: a tab indents this line; YAML wants spaces"},
        {"nodes:\n  - mesh {box: {}}", "s.yaml:2:5: this is not YAML: a colon is missing behind \"mesh\""},
        {"nodes:\n  - mesh: {box: {size 1}}",
         "s.yaml:2:18: unknown key \"size 1\" in box; a colon is missing behind \"size\""},
        {"camera:\n  near 1",
         "s.yaml:2:3: expected a map, found \"near 1\"; a colon is missing behind \"near\""},
        {"nodes:\n  - light: {spot: {shadow: yes}}",
         "s.yaml:2:28: expected true or false, found \"yes\"; write true"},
        {"camera:\n  near: 0,5",
         "s.yaml:2:9: expected a number, found \"0,5\"; decimals are written with a point: 0.5"},
        {"camera: {near: 0,5}",
         "s.yaml:1:16: expected a number, found \"0,5\"; decimals are written with a point: 0.5"},
        {"camera: {position: [0,5, 1, 2]}",
         "s.yaml:1:20: expected [x, y, z], found a list; decimals are written with a point: 0.5"},
        {"camera: {near: '1'}", "s.yaml:1:16: expected a number, found \"1\""},
        {"camera: {near: \x04}", "s.yaml:1:16: expected plain text in UTF-8, found the byte 0x04"},
    };
    for (const Row& row : rows) {
        INFO(row.yaml);
        CHECK(message_of(row.yaml) == row.message);
    }
}

TEST_CASE("a scene's words and numbers are those of YAML's core schema") {
    for (const char* word : {"true", "True", "TRUE"}) {
        const Scene scene =
            parse_scene(std::string("nodes: [{light: {spot: {shadow: ") + word + "}}}]", "s.yaml");
        CHECK(scene.lights.at(0).casts_shadow);
    }
    for (const auto& [text, value] : std::vector<std::pair<std::string, double>>{
             {".5", 0.5}, {"1e-1", 0.1}, {"0x10", 16}, {"0o17", 15}, {"017", 17}})
        CHECK(parse_scene("camera: {near: " + text + "}", "s.yaml").camera.near_plane == value);
}

TEST_CASE("an unknown scene name gives the nearest, a missing file its name") {
    CHECK_THROWS_WITH(open_scene("cornel", scenes), Catch::Contains("did you mean \"cornell\"?"));
    CHECK_THROWS_WITH(open_scene("no/such.yaml", scenes), "no/such.yaml: no such file");
    CHECK_THROWS_WITH(open_scene(POSTFX_SOURCE_DIRECTORY "/CMakeLists.txt", scenes),
                      Catch::Contains("expected a scene"));
}

namespace {

void put(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

std::string error_of_scene(const std::filesystem::path& file) {
    try {
        open_scene(file.string(), scenes);
    } catch (const postfx::Error& error) {
        return error.message();
    }
    return "no error";
}

constexpr const char* triangle_obj = "# a triangle\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr const char* triangle_ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
    "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
constexpr const char* triangle_stl = "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                     "vertex 0 1 0\nendloop\nendfacet\nendsolid t\n";
/// The corners are 36 bytes; `uri` says where they are, or nothing of those that come along.
std::string triangle_gltf(const std::string& uri) {
    return R"({"buffers": [{)" + uri
           + R"("byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],)"
             R"( "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",)"
             R"( "min": [0, 0, 0], "max": [1, 1, 0]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],)"
             R"( "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0, "asset": {"version": "2.0"}})";
}
const std::string triangle_in_gltf = triangle_gltf(R"("uri": "data:application/octet-stream;base64,)"
                                                   R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA", )");

std::string little_endian(std::uint32_t x) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8)
        bytes += static_cast<char>(x >> shift);
    return bytes;
}

/// Its JSON and its corners in one file.
std::string triangle_in_glb() {
    std::string json = triangle_gltf("");
    json.resize((json.size() + 3) / 4 * 4, ' ');
    constexpr float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::string bytes(reinterpret_cast<const char*>(corners), sizeof(corners));
    const auto chunk = [](const std::string& type, const std::string& content) {
        return little_endian(static_cast<std::uint32_t>(content.size())) + type + content;
    };
    const std::string chunks = chunk("JSON", json) + chunk(std::string("BIN\0", 4), bytes);
    return "glTF" + little_endian(2) + little_endian(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

} // namespace

TEST_CASE("whether a file is a scene or a model, and of which format, its content says") {
    const postfx::testing::TemporaryDirectory folder;
    const std::string yaml = "nodes:\n  - {mesh: {box: {}}}\n";
    const std::vector<std::pair<std::string, std::string>> models = {{"obj", triangle_obj},
                                                                     {"ply", triangle_ply},
                                                                     {"stl", triangle_stl},
                                                                     {"gltf", triangle_in_gltf},
                                                                     {"glb", triangle_in_glb()}};
    for (const auto& [format, content] : models) {
        for (const std::string& ending : {"." + format, std::string(".dat"), std::string(),
                                          std::string(".obj"), std::string(".yaml"), std::string(".glb")}) {
            const std::filesystem::path file = folder / ("model" + ending);
            INFO(format << " as " << file.filename());
            put(file, content);
            CHECK(open_scene(file.string(), scenes).contents().triangles == 1);
        }
    }
    for (const char* name : {"scene.yaml", "scene.txt", "scene", "scene.obj2"}) {
        INFO(name);
        put(folder / name, yaml);
        CHECK(open_scene((folder / name).string(), scenes).contents().triangles == 12);
    }
    put(folder / "scene.json", R"({"nodes": [{"mesh": {"box": {}}}]})");
    CHECK(open_scene((folder / "scene.json").string(), scenes).contents().triangles == 12);

    put(folder / "a.yaml", "\x89PNG\r\n\x1a\n");
    CHECK_THAT(error_of_scene(folder / "a.yaml"), Catch::Contains("is a PNG image, expected a scene"));
    put(folder / "b.dat", std::string("\x01\x02\x03", 3));
    CHECK_THAT(error_of_scene(folder / "b.dat"), Catch::StartsWith("expected a scene"));
    put(folder / "c.yaml", "");
    CHECK_THAT(error_of_scene(folder / "c.yaml"), Catch::Contains("is empty, expected a scene"));
    CHECK_THAT(error_of_scene(folder.path()), Catch::Contains("is a directory, expected a scene"));
    CHECK_THAT(error_of_scene(folder / "scene.yam"), Catch::Contains("did you mean \"scene.yaml\"?"));
}

TEST_CASE("scenes and models come through pipes") {
    const postfx::testing::TemporaryDirectory folder;
    put(folder / "triangle.obj", triangle_obj);
    const auto through_pipe = [&](const std::string& content) {
        const std::filesystem::path pipe = folder / "pipe";
        std::filesystem::remove(pipe);
        REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
        const std::jthread writer([&] { put(pipe, content); });
        const Scene scene = open_scene(pipe.string(), scenes);
        CHECK(scene.content == content);
        return scene.contents().triangles;
    };
    CHECK(through_pipe("nodes:\n  - {mesh: {box: {}}}\n  - {mesh: {model: triangle.obj}}\n") == 13);
    for (const std::string& model :
         {std::string(triangle_obj), std::string(triangle_ply), triangle_in_gltf, triangle_in_glb()})
        CHECK(through_pipe(model) == 1);
}

TEST_CASE("closed primitives have unit normals, no hole and their measure") {
    struct Row {
        std::string name;
        Mesh mesh;
        double area, volume;
    };
    constexpr double pi = std::numbers::pi;
    const std::vector<Row> rows = {
        {"box", box({1, 2, 3}), 22, 6},
        {"sphere", sphere(2, 96), 16 * pi, 32 * pi / 3},
        {"cylinder", cylinder(1, 2, 96), 6 * pi, 2 * pi},
        {"cone", cone(1, 2, 96), pi * (1 + std::sqrt(5.0)), 2 * pi / 3},
        {"torus", torus(2, 0.5f, 96), 4 * pi * pi, pi * pi},
        {"lathe", lathe({{0, 0}, {1, 0}, {1, 0}, {1, 2}, {1, 2}, {0, 3}}, 96), pi * (5 + std::sqrt(2.0)),
         7 * pi / 3},
        {"rod", rod({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, 1, 1, 96), 6 * pi, 2 * pi},
    };
    for (const Row& row : rows) {
        INFO(row.name);
        check_sane(row.mesh);
        // 96 chords around lie inside of the circle by (pi/96)^2/2 = 0.05 %; the torus has half as many
        // around its tube, so that both directions together stay below 0.5 %.
        CHECK(area(row.mesh) == Approx(row.area).epsilon(0.005));
        CHECK(volume(row.mesh) == Approx(row.volume).epsilon(0.005));
        CHECK(volume_from_elsewhere(row.mesh) == Approx(volume(row.mesh)).epsilon(1e-3));
    }
    const Mesh ground = plane({4, 6}, 3);
    check_sane(ground);
    CHECK(area(ground) == Approx(24));
    CHECK(ground.vertices.front().normal == glm::vec3(0, 1, 0));
}

TEST_CASE("a normal points to the front of its triangle") {
    for (const Mesh& mesh : {box({1, 1, 1}), sphere(1, 24), cylinder(1, 1, 24), torus(1, 0.3f, 24),
                             plane({1, 1}, 2), lathe({{0, -1}, {1, 0}, {0.4f, 1}, {0, 1}}, 24),
                             rod({{0, 0, 0}, {0.3f, 1, 0}, {0, 2, 0.5f}}, 0.3f, 0.1f, 24)}) {
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vertex &a = mesh.vertices[mesh.indices[i]], &b = mesh.vertices[mesh.indices[i + 1]],
                         &c = mesh.vertices[mesh.indices[i + 2]];
            const glm::vec3 front = glm::cross(b.position - a.position, c.position - a.position);
            wrong += glm::dot(front, a.normal + b.normal + c.normal) <= 0;
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("a mirrored copy stays closed with its fronts outside") {
    Mesh mirrored;
    mirrored.append(box({1, 2, 3}), glm::scale(glm::mat4(1), {-1, 1, 1}));
    CHECK(volume(mirrored) == Approx(6));
}

TEST_CASE("generators are sane and the same every time") {
    Terrain terrain({.size = 120, .resolution = 3, .seed = 3});
    const Path path({{-50, 0, 0}, {0, 2, 10}, {50, 0, 0}}, false);
    terrain.level(path, 0.1);
    const auto all = [&] {
        std::vector<MadeParts> made;
        made.push_back(make_terrain(terrain));
        made.push_back(make_road(path, {}));
        made.push_back(make_tree({}));
        made.push_back(make_tree({5, "broadleaf", 8}));
        made.push_back(make_forest(terrain, path, {.count = 40}));
        made.push_back(make_grass(terrain, path, {.count = 50}));
        made.push_back(make_posts(path, {}));
        made.push_back(make_lamp_posts(path, {}));
        made.push_back(make_sparks(&terrain, {}));
        made.push_back(make_car());
        made.push_back(make_twigs({}));
        made.push_back(make_light_string(path, {.spacing = 5}));
        return made;
    };
    const auto first = all(), second = all();
    for (std::size_t i = 0; i < first.size(); ++i) {
        REQUIRE(first[i].size() == second[i].size());
        for (std::size_t k = 0; k < first[i].size(); ++k) {
            INFO(i << " " << first[i][k].slot);
            check_sane(first[i][k].mesh);
            CHECK(first[i][k].mesh.indices == second[i][k].mesh.indices);
            CHECK(first[i][k].mesh.vertices.back().position == second[i][k].mesh.vertices.back().position);
        }
    }
}

TEST_CASE("trees keep off the road, and the ground stays under it") {
    Terrain terrain({.size = 200, .resolution = 3, .seed = 8, .height = 12});
    const Path path({{-80, 4, 0}, {0, 8, 30}, {80, 2, 0}}, false);
    terrain.level(path, 0.1);
    for (double at = 0; at < path.length(); at += 3.7) {
        const glm::dvec3 middle = path.at(at).position;
        CHECK(terrain.height(middle.x, middle.z) == Approx(middle.y - 0.1).margin(1e-6));
    }
    for (const MadePart& part : make_forest(terrain, path, {.count = 200, .clearance = 9})) {
        if (part.slot != "trunk") continue;
        double nearest = 1e9;
        for (const Vertex& vertex : part.mesh.vertices) {
            nearest = std::min(nearest, path.nearest(vertex.position.x, vertex.position.z).distance);
        }
        CHECK(nearest > 6); // clearance less the branches' reach
    }
}

TEST_CASE("a path is followed at even speed and closed ones go round") {
    const Path open({{0, 0, 0}, {10, 0, 0}, {10, 0, 10}}, false);
    CHECK(glm::length(open.at(-5).position - glm::dvec3(0, 0, 0)) < 1e-9);
    CHECK(glm::length(open.at(1e9).position - glm::dvec3(10, 0, 10)) < 1e-9);
    const Path ring({{10, 0, 0}, {0, 0, 10}, {-10, 0, 0}, {0, 0, -10}}, true);
    for (double at = 0; at < ring.length(); at += 1) {
        // A metre along a curve of this bend is a chord of nearly a metre.
        CHECK(glm::length(ring.at(at + 1).position - ring.at(at).position) == Approx(1).epsilon(0.02));
        CHECK(glm::length(ring.at(at + 3 * ring.length()).position - ring.at(at).position) < 1e-6);
    }
}

TEST_CASE("hierarchy and movement are functions of time alone") {
    const Scene scene =
        parse_scene("nodes:\n"
                    "  - name: hub\n"
                    "    position: [1, 0, 0]\n"
                    "    animate: {rotate: {axis: [0, 1, 0], degrees_per_second: 90}}\n"
                    "    children:\n"
                    "      - {position: [2, 0, 0], mesh: {box: {}}}\n"
                    "camera: {parent: hub, position: [0, 1, 0], look_at: [0, 1, -4], vertical_fov: 60}\n",
                    "s.yaml");
    std::vector<glm::dmat4> placed;
    scene.place_nodes(0, placed);
    CHECK(glm::length(glm::dvec3(placed[1][3]) - glm::dvec3(3, 0, 0)) < 1e-12);
    scene.place_nodes(1, placed);
    CHECK(glm::length(glm::dvec3(placed[1][3]) - glm::dvec3(1, 0, -2)) < 1e-12);
    // A month later, a whole number of turns: the same to the digits that seconds have left in double.
    scene.place_nodes(1 + 4.0 * 648000, placed);
    CHECK(glm::length(glm::dvec3(placed[1][3]) - glm::dvec3(1, 0, -2)) < 1e-6);

    const postfx::Camera camera = scene.camera_at(1); // looked along -z, turned by 90 degrees to -x
    CHECK(camera.view_to_world[8] == Approx(1).margin(1e-12));
    CHECK(camera.view_to_world[12] == Approx(1));
    CHECK(camera.view_to_world[13] == Approx(1));
    CHECK(camera.vertical_fov == 60);
    CHECK(scene.contents().moves);
}

TEST_CASE("an including file replaces what has the same name") {
    const Scene plain = open_scene("cornell", scenes), glow = open_scene("cornell_glow", scenes);
    CHECK(plain.contents().triangles == 32); // 5 walls, the lamp and 5 sides each of two boxes, as quads
    CHECK(glow.contents().triangles == 32);
    CHECK(plain.lights.size() == 4);
    CHECK(glow.lights.size() == 7);
    CHECK(plain.camera.focus_distance == glow.camera.focus_distance);
    const auto emission = [](const Scene& scene, const std::string& name) {
        for (const Material& material : scene.materials) {
            if (material.name == name) return material.emission;
        }
        return glm::vec3(-1);
    };
    CHECK(emission(plain, "tall_block") == glm::vec3(0));
    CHECK(emission(glow, "tall_block").b > 1);
}

TEST_CASE("every shipped scene opens and says what it is") {
    const auto entries = list_scenes(scenes);
    REQUIRE(entries.size() >= 4);
    for (const SceneEntry& entry : entries) {
        INFO(entry.name);
        const Scene scene = open_scene(entry.name, scenes);
        CHECK_FALSE(scene.description.empty());
        CHECK(scene.description == entry.description);
        // By one of them at least something is seen.
        CHECK((scene.contents().emitters || scene.contents().lights > 0 || scene.contents().sky));
    }
}

TEST_CASE("a Cornell box in OBJ opens with a camera that sees all of it") {
    const auto file = test_data("cornell_box/cornell_box.obj");
    if (file.empty()) return;
    const Scene scene = open_scene(file.string(), scenes);
    // 3 + 1 + 1 + 1 + 1 + 1 quads of the room, its front face being commented out, and 10 of the boxes.
    CHECK(scene.contents().triangles == 36);
    const Bounds bounds = scene.bounds();
    CHECK(bounds.high.x == Approx(556));
    CHECK(bounds.high.y == Approx(548.8));
    CHECK(scene.camera.position.z < -100); // in front of the wall that is not there
    const glm::dmat4 to_view =
        glm::inverse(look_at_matrix(scene.camera.position, scene.camera.look_at, scene.camera.up));
    const double tan_half = std::tan(glm::radians(scene.camera.vertical_fov / 2));
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 seen =
            to_view
            * glm::dvec4(corner & 1 ? bounds.high.x : bounds.low.x, corner & 2 ? bounds.high.y : bounds.low.y,
                         corner & 4 ? bounds.high.z : bounds.low.z, 1);
        CHECK(std::max(std::abs(seen.x), std::abs(seen.y)) < -seen.z * tan_half); // within a square picture
    }
    for (const Node& node : scene.nodes) {
        for (const Part& part : node.parts)
            check_sane(*part.mesh);
    }
}

TEST_CASE("FlightHelmet opens with its textures") {
    const auto file = test_data("FlightHelmet/FlightHelmet.gltf");
    if (file.empty()) return;
    const Model model = load_model(file);
    CHECK(model.part_count() == 6);
    CHECK(model.losses.empty());
    std::size_t blended = 0;
    for (const Node& node : model.nodes) {
        for (const Part& part : node.parts) {
            check_sane(*part.mesh);
            const Material& material = model.materials[part.material];
            INFO(material.name);
            REQUIRE(material.diffuse_texture);
            CHECK(material.diffuse_texture->srgb);
            REQUIRE(material.normal_texture);
            CHECK_FALSE(material.normal_texture->srgb);
            CHECK(material.metal_roughness_texture);
            CHECK(material.occlusion_texture);
            blended += material.blended;
        }
    }
    CHECK(blended == 1); // the lenses
}
