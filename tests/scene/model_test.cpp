// Models: what a glTF file says of surfaces and shapes is in the model, and what can't be is told.
#include "models.hpp"

#include <catch2/catch.hpp>

#include <postfx/error.hpp>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include <cmath>
#include <limits>

using namespace postfx;
using namespace postfx::host;
using namespace postfx::testing;
using Json = GltfFile::Json;

namespace {

Material material_of(const Json& source, const Json& file = Json::object()) {
    const TemporaryDirectory folder;
    write_tga(folder / "t.tga", 2, 1, red_green);
    GltfFile gltf;
    gltf.add_texture("t.tga");
    gltf.add_node({{"mesh", gltf.add_quad(source)}});
    gltf.json.update(file);
    return load_model(gltf.write(folder / "m.gltf")).materials.at(0);
}

std::string in_base64(const std::string& bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8u | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63u];
    }
    return text;
}

/// What is told of a model with a material that has an extension which the file does not list.
std::string loss_of_extension(const std::string& name) {
    const TemporaryDirectory folder;
    GltfFile gltf;
    gltf.add_node({{"mesh", gltf.add_quad({{"extensions", {{name, Json::object()}}}})}});
    const Model model = load_model(gltf.write(folder / "m.gltf"));
    return model.losses.empty() ? "" : model.losses.front();
}

} // namespace

TEST_CASE("URIs of buffers and images are percent-encoded") {
    const TemporaryDirectory folder;
    write_tga(folder / "half tone (1).tga", 2, 1, red_green);
    GltfFile gltf;
    gltf.add_node(
        {{"mesh", gltf.add_quad({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}})}});
    gltf.add_texture("half%20tone%20%281%29.tga");
    gltf.buffer_uri = "my%20b%C3%BCffer.bin";
    const Model model = load_model(gltf.write(folder / "m.gltf", "my b\xc3\xbc"
                                                                 "ffer.bin"));
    CHECK(model.losses.empty());
    CHECK(model.materials.at(0).diffuse_texture->width == 2);
    CHECK(only_mesh(model).vertices.size() == 4);
    // A file whose name has the escape in it, as careless exporters write.
    write_tga(folder / "a%20b.tga", 1, 1, {9, 9, 9, 255});
    gltf.json["images"][0]["uri"] = "a%20b.tga";
    gltf.buffer_uri.clear();
    CHECK(load_model(gltf.write(folder / "m.gltf")).materials.at(0).diffuse_texture->width == 1);
}

TEST_CASE("OPAQUE has no use for alpha, MASK cuts, BLEND blends") {
    const Json base = {{"baseColorFactor", {1, 0, 0, 0.2}}};
    const Material opaque = material_of({{"pbrMetallicRoughness", base}});
    CHECK_FALSE(opaque.blended);
    CHECK(opaque.opacity == 1);
    CHECK(opaque.alpha_cutoff == 0);
    const Material mask = material_of({{"pbrMetallicRoughness", base}, {"alphaMode", "MASK"}});
    CHECK_FALSE(mask.blended);
    CHECK(mask.alpha_cutoff == 0.5f);
    const Material blend = material_of({{"pbrMetallicRoughness", base}, {"alphaMode", "BLEND"}});
    CHECK(blend.blended);
    CHECK(blend.opacity == 0.2f);
}

TEST_CASE("a material of glTF is taken with its factors, extensions and sides") {
    const Material plain = material_of({{"doubleSided", true}});
    CHECK(plain.metal_rough);
    CHECK(plain.metalness == 1);
    CHECK(plain.roughness == 1);
    CHECK(plain.two_sided);
    const Json index = {{"index", 0}};
    Json normal = index, occlusion = index;
    normal["scale"] = 0.5;
    occlusion["strength"] = 0.25;
    const Material full = material_of(
        {{"pbrMetallicRoughness",
          {{"metallicFactor", 0.25}, {"roughnessFactor", 0.75}, {"metallicRoughnessTexture", index}}},
         {"normalTexture", normal},
         {"occlusionTexture", occlusion},
         {"emissiveFactor", {1, 0.5, 0}},
         {"extensions",
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}},
           {"KHR_materials_ior", {{"ior", 2}}},
           {"KHR_materials_specular", {{"specularFactor", 0.5}}}}}});
    CHECK_FALSE(full.two_sided);
    CHECK(full.metalness == 0.25f);
    CHECK(full.roughness == 0.75f);
    CHECK(full.normal_scale == 0.5f);
    CHECK(full.occlusion_strength == 0.25f);
    CHECK(full.emission == glm::vec3(5, 2.5f, 0));
    CHECK(full.specular.r == Approx(0.5 / 9)); // ((2 - 1) / (2 + 1))^2, half of it
    const Material unlit = material_of(
        {{"emissiveFactor", {1, 1, 1}}, {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
    CHECK(unlit.unlit);
    CHECK_FALSE(unlit.metal_rough); // its default metalness of 1 would leave nothing of the base colour
    CHECK(unlit.emission == glm::vec3(0));
    CHECK_FALSE(full.metal_roughness_texture->srgb);
    CHECK_FALSE(full.occlusion_texture->srgb);
}

TEST_CASE("samplers, texture transforms and second sets of coordinates") {
    const Material material = material_of(
        {{"pbrMetallicRoughness",
          {{"baseColorTexture",
            {{"index", 0},
             {"texCoord", 3},
             {"extensions",
              {{"KHR_texture_transform",
                {{"offset", {0, 1}}, {"rotation", std::acos(0.0)}, {"scale", {0.5, 0.5}}}}}}}}}},
         {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}},
        {{"samplers", {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9985}}}}});
    const Sampler& sampler = material.diffuse_texture.sampler;
    CHECK(sampler.wrap_u == Sampler::Wrap::clamp);
    CHECK(sampler.wrap_v == Sampler::Wrap::mirror);
    CHECK(sampler.magnify == Sampler::Filter::nearest);
    CHECK(sampler.minify == Sampler::Filter::linear);
    CHECK(sampler.mips == Sampler::Mips::nearest);
    CHECK(material.diffuse_texture.uv_set == 0);  // set 3
    CHECK(material.emission_texture.uv_set == 1); // set 1
    // The extension's own example: the lower left quadrant of the picture, turned clockwise. With v upwards its corners
    // are (0, 0) to (0.5, 0.5), and the quad's lower left corner shows the picture's lower right of it.
    const glm::mat3x2& place = material.diffuse_texture.placement;
    const glm::vec2 lower_left = place * glm::vec3(0, 0, 1), upper_left = place * glm::vec3(0, 1, 1);
    CHECK(lower_left.x == Approx(0.5).margin(1e-6f));
    CHECK(lower_left.y == Approx(0).margin(1e-6f));
    CHECK(upper_left.x == Approx(0).margin(1e-6f));
    CHECK(upper_left.y == Approx(0).margin(1e-6f));
}

TEST_CASE("a third set of coordinates in one material is a loss") {
    const TemporaryDirectory folder;
    write_tga(folder / "t.tga", 2, 1, red_green);
    GltfFile gltf;
    gltf.add_texture("t.tga");
    const auto texture = [](int set) { return Json{{"index", 0}, {"texCoord", set}}; };
    gltf.add_node({{"mesh", gltf.add_quad({{"pbrMetallicRoughness", {{"baseColorTexture", texture(0)}}},
                                           {"emissiveTexture", texture(1)},
                                           {"occlusionTexture", texture(2)}})}});
    CHECK(load_model(gltf.write(folder / "m.gltf")).losses.size() == 1);
}

TEST_CASE("required extensions that are not known refuse the file by name, others are told") {
    const TemporaryDirectory folder;
    GltfFile gltf;
    gltf.add_node({{"mesh", gltf.add_quad(Json::object())}});
    gltf.json["extensionsUsed"] = {"KHR_materials_unlit", "VENDOR_a", "VENDOR_b"};
    CHECK(load_model(gltf.write(folder / "m.gltf")).losses
          == std::vector<std::string>{"2 optional extensions are left out (first: VENDOR_a)"});
    for (const char* name : {"VENDOR_b", "KHR_texture_basisu", "EXT_meshopt_compression"}) {
        gltf.json["extensionsRequired"] = {"KHR_materials_unlit", name};
        CHECK_THROWS_WITH(load_model(gltf.write(folder / "m.gltf")),
                          Catch::Contains(name) && Catch::Contains("m.gltf"));
        CHECK_THROWS_WITH(load_model(gltf.write_glb(folder / "m.glb")), Catch::Contains(name));
    }
    CHECK(loss_of_extension("KHR_materials_clearcoat")
          == "1 optional extension is left out (KHR_materials_clearcoat)");
    CHECK(loss_of_extension("KHR_materials_unlit").empty());
}

TEST_CASE("quantized, strided and sparse numbers") {
    const TemporaryDirectory folder;
    GltfFile gltf;
    gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::vector<std::int8_t> corners = {-127, -127, 0, 0, 127,  -127, 0, 0,
                                              127,  127,  0, 0, -128, 127,  0, 0};
    const std::size_t view = gltf.view(corners);
    gltf.json["bufferViews"][view]["byteStride"] = 4;
    const std::size_t places = gltf.view(std::vector<std::uint8_t>{2}),
                      values = gltf.view(std::vector<std::int8_t>{0, 127, 0});
    Json attributes = {
        {"POSITION", gltf.add("accessors", {{"bufferView", view},
                                            {"componentType", 5120},
                                            {"normalized", true},
                                            {"count", 4},
                                            {"type", "VEC3"},
                                            {"sparse",
                                             {{"count", 1},
                                              {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                                              {"values", {{"bufferView", values}}}}}})}};
    gltf.add_node({{"mesh", gltf.add_quad(Json::object(), attributes)}});
    const Bounds bounds = only_mesh(load_model(gltf.write_glb(folder / "m.glb"))).bounds();
    CHECK(bounds.low == glm::dvec3(-1, -1, 0));
    const Mesh mesh = only_mesh(load_model(folder / "m.glb"));
    // Without normals the faces are flat, with vertices of their own: 0 1 2, 0 2 3.
    REQUIRE(mesh.vertices.size() == 6);
    CHECK(mesh.vertices[2].position == glm::vec3(0, 1, 0)); // the sparse one
    CHECK(mesh.vertices[5].position == glm::vec3(-1, 1, 0));
    CHECK(mesh.vertices[0].normal == glm::vec3(0, 0, 1));
}

TEST_CASE("meshes compressed with Draco") {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(1);
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const float corners[3][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    builder.SetAttributeValuesForFace(positions, draco::FaceIndex(0), corners[0], corners[1], corners[2]);
    const auto made = builder.Finalize();
    draco::EncoderBuffer compressed;
    REQUIRE(draco::Encoder().EncodeMeshToBuffer(*made, &compressed).ok());
    std::vector<char> bytes(compressed.data(), compressed.data() + compressed.size());

    const TemporaryDirectory folder;
    const auto write = [&] {
        GltfFile gltf;
        gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
        const std::size_t view = gltf.view(bytes);
        const std::size_t accessor =
            gltf.add("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
        const Json extension = {{"bufferView", view},
                                {"attributes", {{"POSITION", made->attribute(positions)->unique_id()}}}};
        const Json primitive = {{"attributes", {{"POSITION", accessor}}},
                                {"extensions", {{"KHR_draco_mesh_compression", extension}}}};
        gltf.add_node({{"mesh", gltf.add("meshes", {{"primitives", {primitive}}})}});
        return gltf.write(folder / "m.gltf");
    };
    const Mesh mesh = only_mesh(load_model(write()));
    CHECK(mesh.indices.size() == 3);
    CHECK(mesh.bounds().high.x == Approx(2));
    CHECK(mesh.bounds().high.y == Approx(3));
    bytes.resize(bytes.size() / 2);
    CHECK_THROWS_WITH(load_model(write()), Catch::Contains("m.gltf: ") && Catch::Contains("Draco"));
}

TEST_CASE("strips and fans are triangles") {
    const TemporaryDirectory folder;
    for (const int mode : {5, 6}) {
        GltfFile gltf;
        const std::size_t order = gltf.shorts("SCALAR", mode == 5 ? std::vector<std::uint16_t>{0, 1, 3, 2}
                                                                  : std::vector<std::uint16_t>{0, 1, 2, 3});
        gltf.add_node({{"mesh", gltf.add_quad(Json::object(), {}, {{"mode", mode}, {"indices", order}})}});
        const Mesh mesh = only_mesh(load_model(gltf.write(folder / "m.gltf")));
        REQUIRE(mesh.indices.size() == 6);
        for (std::size_t i = 0; i < 6; i += 3) {
            const auto at = [&](std::size_t k) { return mesh.vertices[mesh.indices[i + k]].position; };
            CHECK(glm::cross(at(1) - at(0), at(2) - at(0)).z > 0); // facing as their normals say
        }
    }
}

TEST_CASE("URIs have queries, and data URIs line breaks, escapes and capitals") {
    const TemporaryDirectory folder;
    write_tga(folder / "t.tga", 2, 1, red_green);
    std::ifstream stream(folder / "t.tga", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    const auto width = [&](const std::string& uri) {
        GltfFile gltf;
        gltf.add_node(
            {{"mesh", gltf.add_quad({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}})}});
        gltf.add_texture(uri);
        const Texture texture = load_model(gltf.write(folder / "m.gltf")).materials.at(0).diffuse_texture;
        return texture ? texture->width : 0;
    };
    CHECK(width("t.tga?version=3") == 2);
    CHECK(width("t.tga#top") == 2);
    const std::string base64 = in_base64(bytes);
    CHECK(width("data:image/x-tga;base64," + base64) == 2);
    CHECK(width("DATA:image/x-tga;BASE64," + base64) == 2);
    CHECK(width("data:;base64," + base64.substr(0, 8) + "\r\n" + base64.substr(8)) == 2);
    std::string escaped;
    for (const char c : base64)
        escaped += c == '=' ? "%3D" : c == '+' ? "%2B" : c == '/' ? "%2F" : std::string(1, c);
    CHECK(width("data:;base64," + escaped) == 2);
}

TEST_CASE("normals without any direction are those of the faces") {
    const TemporaryDirectory folder;
    GltfFile gltf;
    Json attributes = gltf.quad_attributes();
    attributes["NORMAL"] = gltf.floats("VEC3", std::vector<float>(12, 0.0f));
    gltf.add_node({{"mesh", gltf.add_quad(Json::object(), attributes)}});
    const Model model = load_model(gltf.write(folder / "m.gltf"));
    for (const Vertex& vertex : only_mesh(model).vertices)
        CHECK(vertex.normal == glm::vec3(0, 0, 1));
}
