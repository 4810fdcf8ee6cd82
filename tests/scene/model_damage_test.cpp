// Models with parts that are missing or damaged, and what of them reaches another process.
#include "models.hpp"

#include <catch2/catch.hpp>

#include <postfx/error.hpp>
#include <scene/model_stream.hpp>

#include <cmath>
#include <limits>

using namespace postfx;
using namespace postfx::host;
using namespace postfx::testing;
using Json = GltfFile::Json;

TEST_CASE("missing textures and libraries leave the rest, and are counted by files") {
    const TemporaryDirectory folder;
    GltfFile gltf;
    for (const char* name : {"x%20y.png", "x%20y.png", "z.png"})
        gltf.add_texture(name);
    for (int i = 0; i < 3; ++i) {
        gltf.add_node({{"mesh", gltf.add_quad({{"pbrMetallicRoughness",
                                                {{"baseColorFactor", {0.5, 0, 0, 1}},
                                                 {"baseColorTexture", {{"index", i}}}}}})}});
    }
    const Model model = load_model(gltf.write(folder / "m.gltf"));
    CHECK(model.losses == std::vector<std::string>{"2 textures are missing (first: x y.png)"});
    CHECK_FALSE(model.materials[0].diffuse_texture);
    CHECK(model.materials[0].diffuse == glm::vec3(0.5f, 0, 0));

    std::ofstream(folder / "m.obj") << "mtllib not there.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    CHECK(load_model(folder / "m.obj").losses
          == std::vector<std::string>{"1 material library is missing (not there.mtl)"});
    std::ofstream(folder / "not there.mtl") << "newmtl a\nKd 1 0 0\nmap_Kd gone.png\n";
    CHECK(load_model(folder / "m.obj").losses == std::vector<std::string>{"1 texture is missing (gone.png)"});
}

TEST_CASE("a texture of a kind that is not read is told, a damaged one refuses the model") {
    const TemporaryDirectory folder;
    GltfFile gltf;
    gltf.add_texture("t.dds");
    gltf.add_node(
        {{"mesh", gltf.add_quad({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}})}});
    gltf.write(folder / "m.gltf");
    std::ofstream(folder / "t.dds") << "DDS |and so on and on";
    CHECK(load_model(folder / "m.gltf").losses
          == std::vector<std::string>{"1 texture is of a kind that postfx doesn't read (t.dds: DDS)"});
    std::ofstream(folder / "t.dds") << "neither of them";
    CHECK_THROWS_WITH(load_model(folder / "m.gltf"), Catch::Contains("t.dds"));
}

TEST_CASE("triangles with vertices that are nowhere are left out and counted") {
    const TemporaryDirectory folder;
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
        GltfFile gltf;
        Json attributes = gltf.quad_attributes();
        attributes["POSITION"] = gltf.floats("VEC3", {-1, -1, 0, bad, -1, 0, 1, 1, 0, -1, 1, 0});
        gltf.add_node({{"mesh", gltf.add_quad(Json::object(), attributes)}});
        const Model model = load_model(gltf.write(folder / "m.gltf"));
        CHECK(only_mesh(model).indices.size() == 3);
        CHECK(model.losses
              == std::vector<std::string>{"1 triangle is left out, for a vertex of it is not finite"});
        CHECK(only_mesh(model).bounds().radius() < 2);
    }
    GltfFile gltf;
    gltf.add_node({{"mesh", gltf.add_quad(Json::object(), {},
                                          {{"indices", gltf.shorts("SCALAR", {0, 1, 2, 0, 2, 9})}})}});
    CHECK(load_model(gltf.write(folder / "m.gltf")).losses.size() == 1);

    std::ofstream(folder / "m.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\n";
    const Model obj = load_model(folder / "m.obj");
    CHECK(only_mesh(obj).indices.size() == 3);
    REQUIRE(obj.losses.size() == 1);
    CHECK_THAT(obj.losses[0], Catch::StartsWith("1 triangle is left out"));
}

TEST_CASE("files that lie about themselves are refused") {
    const TemporaryDirectory folder;
    const auto refused = [&](const std::function<void(GltfFile&)>& damage, const std::string& words) {
        GltfFile gltf;
        gltf.add_node({{"mesh", gltf.add_quad(Json::object())}});
        damage(gltf);
        CHECK_THROWS_WITH(load_model(gltf.write(folder / "m.gltf")),
                          Catch::Contains("m.gltf: ") && Catch::Contains(words));
    };
    refused([](GltfFile& f) { f.json["nodes"][0]["children"] = {0}; }, "ancestor");
    refused(
        [](GltfFile& f) {
            f.add_node({{"children", {2, 2}}});
            f.add("nodes", Json::object());
        },
        "two parents");
    refused([](GltfFile& f) { f.json["nodes"][0]["mesh"] = 7; }, "meshes[7]");
    refused([](GltfFile& f) { f.json["nodes"][0]["mesh"] = -1; }, "\"mesh\" is -1");
    refused([](GltfFile& f) { f.json["accessors"][0]["count"] = 1000000000; }, "accessors[0]");
    refused(
        [](GltfFile& f) {
            f.json["accessors"][0].erase("bufferView"), f.json["accessors"][0]["count"] = 1u << 31;
        },
        "accessors[0]");
    refused([](GltfFile& f) { f.json["bufferViews"][0]["byteOffset"] = 1u << 30; }, "bufferViews[0]");
    refused([](GltfFile& f) { f.json["bufferViews"][0]["byteStride"] = 0; }, "bufferViews[0]");
    refused([](GltfFile& f) { f.json["asset"]["version"] = "3.0"; }, "3.0");
    refused([](GltfFile& f) { f.json["materials"][0]["emissiveFactor"] = {1, 2}; }, "emissiveFactor");
    refused(
        [](GltfFile& f) {
            f.json["scenes"] = 3;
            f.json["nodes"][0]["translation"] = "x";
        },
        "translation");
    // Header of a .glb whose chunk says that it has 4 GB.
    std::ofstream(folder / "b.glb", std::ios::binary)
        << std::string("glTF\2\0\0\0\xff\xff\xff\xff\xf0\xff\xff\xffJSON{{{{{{{{", 28);
    CHECK_THROWS_WITH(load_model(folder / "b.glb"), Catch::Contains("b.glb: ") && Catch::Contains("chunk"));
}

TEST_CASE("a model survives the way between processes, and damage on the way does no harm") {
    const TemporaryDirectory folder;
    write_tga(folder / "t.tga", 2, 1, red_green);
    GltfFile gltf;
    gltf.add_texture("t.tga");
    Json attributes = gltf.quad_attributes();
    attributes["JOINTS_0"] = gltf.shorts("VEC4", std::vector<std::uint16_t>(16, 0));
    attributes["WEIGHTS_0"] = gltf.floats("VEC4", std::vector<float>(16, 0.25f));
    const std::size_t mesh =
        gltf.add_quad({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}, attributes);
    gltf.add_node({{"mesh", mesh}, {"skin", 0}, {"name", "n"}});
    gltf.add_node({{"mesh", mesh}});
    gltf.add("skins", {{"joints", {0}}});
    const std::size_t times = gltf.floats("SCALAR", {0, 1}), moves = gltf.floats("VEC3", {0, 0, 0, 1, 0, 0});
    gltf.add("animations",
             {{"samplers", {{{"input", times}, {"output", moves}}}},
              {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
    gltf.write(folder / "m.gltf");

    std::vector<std::uint8_t> bytes;
    ModelWriter writer([&](const void* data, std::size_t size) {
        const auto* begin = static_cast<const std::uint8_t*>(data);
        bytes.insert(bytes.end(), begin, begin + size);
    });
    ReadingHooks hooks;
    hooks.picture = [&](const PicturePtr& picture) { return writer.picture(picture); };
    writer.model(load_model(folder / "m.gltf", hooks));

    const auto read = [](const std::vector<std::uint8_t>& from, std::size_t limit = 1u << 20) {
        std::size_t at = 0;
        return read_model_stream(
            [&](void* to, std::size_t size) {
                if (size > from.size() - at) throw std::runtime_error("the end");
                std::memcpy(to, from.data() + at, size);
                at += size;
            },
            limit);
    };
    const Model model = read(bytes), expected = load_model(folder / "m.gltf");
    CHECK(model.materials[0].diffuse_texture->rgba == expected.materials[0].diffuse_texture->rgba);
    CHECK(model.nodes[0].name == "n");
    CHECK(model.nodes[0].parts[0].mesh == model.nodes[1].parts[0].mesh); // shared, as before
    CHECK(only_mesh(model).indices == only_mesh(expected).indices);
    CHECK(only_mesh(model).deformation->joints == only_mesh(expected).deformation->joints);
    CHECK(model.nodes[1].keys->local(0.5)[3].x == 0.5);
    CHECK_THROWS_AS(read(bytes, 100), std::bad_alloc);

    for (std::size_t length = 0; length < bytes.size(); length += 7)
        CHECK_THROWS_AS(read({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}),
                        std::runtime_error);
    // Any byte may be any other: what comes out is a model that can be used or an error.
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::vector<std::uint8_t> damaged = bytes;
        damaged[i] = static_cast<std::uint8_t>(damaged[i] ^ 0xff);
        try {
            Scene scene;
            add_model(scene, read(damaged));
            scene.bounds(0.5);
        } catch (const std::runtime_error&) {
        } catch (const std::bad_alloc&) {
        }
    }
    SUCCEED("no damage does harm");
}
