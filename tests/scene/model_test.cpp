// Models: what a file says is in the model, and what can't be is told.
#include "gltf_files.hpp"

#include <catch2/catch.hpp>

#include <postfx/error.hpp>
#include <scene/model.hpp>
#include <scene/model_stream.hpp>
#include <temporary_directory.hpp>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include <cmath>
#include <limits>

using namespace postfx;
using namespace postfx::host;
using namespace postfx::testing;
using Json = GltfFile::Json;

namespace {

const std::vector<std::uint8_t> red_green = {255, 0, 0, 255, 0, 255, 0, 255};

const Mesh& only_mesh(const Model& model) {
    for (const Node& node : model.nodes) {
        if (!node.parts.empty()) return *node.parts.front().mesh;
    }
    throw std::logic_error("no mesh");
}

Material material_of(const Json& source, const Json& file = Json::object()) {
    const TemporaryDirectory folder;
    write_tga(folder / "t.tga", 2, 1, red_green);
    GltfFile gltf;
    gltf.add_texture("t.tga");
    gltf.add_node({{"mesh", gltf.add_quad(source)}});
    gltf.json.update(file);
    return load_model(gltf.write(folder / "m.gltf")).materials.at(0);
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

TEST_CASE("animations: steps, straight lines and curves, held, looped") {
    const TemporaryDirectory folder;
    GltfFile gltf;
    const std::size_t mesh = gltf.add_quad(Json::object());
    for (int i = 0; i < 3; ++i)
        gltf.add_node({{"mesh", mesh}, {"scale", {2, 2, 2}}});
    const std::size_t times = gltf.floats("SCALAR", {1, 3});
    const std::size_t straight = gltf.floats("VEC3", {0, 0, 0, 8, 0, 0});
    // Tangents of 0: 3 t^2 - 2 t^3 of the way.
    const std::size_t curve = gltf.floats("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0});
    const float half = std::sqrt(0.5f);
    const std::size_t turn = gltf.floats("VEC4", {0, 0, 0, 1, 0, 0, half, half}); // 90 degrees about z
    const auto sampler = [&](std::size_t output, const char* how) {
        return Json{{"input", times}, {"output", output}, {"interpolation", how}};
    };
    const auto channel = [](int sampler_index, int node, const char* path) {
        return Json{{"sampler", sampler_index}, {"target", {{"node", node}, {"path", path}}}};
    };
    gltf.add("animations", {{"name", "all"},
                            {"samplers",
                             {sampler(straight, "LINEAR"), sampler(straight, "STEP"),
                              sampler(curve, "CUBICSPLINE"), sampler(turn, "LINEAR")}},
                            {"channels",
                             {channel(0, 0, "translation"), channel(1, 1, "translation"),
                              channel(2, 2, "translation"), channel(3, 0, "rotation")}}});
    gltf.add("animations", {{"name", "again"},
                            {"samplers", {sampler(straight, "LINEAR")}},
                            {"channels", {channel(0, 1, "translation")}}});
    gltf.add("animations", {{"name", "beside"},
                            {"samplers", {sampler(straight, "LINEAR")}},
                            {"channels", {channel(0, 1, "scale")}}});
    const Model model = load_model(gltf.write(folder / "m.gltf"));
    CHECK(model.losses
          == std::vector<std::string>{"1 animation is left out, for another moves the same nodes (again)"});
    Scene scene;
    add_model(scene, model);
    CHECK(scene.facts().moves);
    const auto x = [&](double time, std::size_t node) {
        std::vector<glm::dmat4> placed;
        scene.place_nodes(time, placed);
        return placed[node][3].x;
    };
    CHECK(x(0, 0) == 0); // before the first key
    CHECK(x(2, 0) == 4);
    CHECK(x(3, 0) == 8); // the end is the end
    CHECK(x(5, 0) == 4); // and then it begins again: 5 is 2 into the second time
    CHECK(x(2.9, 1) == 0);
    CHECK(x(3, 1) == 8);
    CHECK(x(1.5, 2) == Approx(8 * (3.0 / 16 - 2.0 / 64)));
    std::vector<glm::dmat4> placed;
    scene.place_nodes(2, placed);
    CHECK(placed[0][0].x
          == Approx(2 * std::cos(glm::radians(45.0)))); // its scale stays, and half of the turn
}

TEST_CASE("skins and shapes move vertices") {
    const TemporaryDirectory folder;
    GltfFile gltf;
    Json attributes = gltf.quad_attributes();
    attributes["JOINTS_0"] = gltf.shorts("VEC4", {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
    attributes["WEIGHTS_0"] = gltf.floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0});
    const std::size_t up = gltf.floats("VEC3", {0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0});
    const std::size_t mesh = gltf.add_quad(Json::object(), attributes, {{"targets", {{{"POSITION", up}}}}});
    gltf.json["meshes"][mesh]["weights"] = {0.5};
    const std::size_t still = gltf.add_node({{"name", "still"}});
    const std::size_t moving = gltf.add_node({{"name", "moving"}, {"translation", {0, 0, 7}}});
    gltf.add("skins", {{"joints", {still, moving}}});
    // A skinned mesh stands where its joints put it, wherever its own node is.
    const std::size_t node = gltf.add_node({{"mesh", mesh}, {"skin", 0}, {"translation", {100, 0, 0}}});
    Scene scene;
    add_model(scene, load_model(gltf.write(folder / "m.gltf")));
    std::vector<glm::dmat4> placed;
    scene.place_nodes(0, placed);
    const auto shown = scene.mesh_at(node, scene.nodes[node].parts[0].mesh, placed, 0);
    const auto world = [&](std::size_t v) {
        return glm::vec3(placed[node] * glm::dvec4(glm::dvec3(shown->vertices[v].position), 1));
    };
    CHECK(world(0) == glm::vec3(-1, -1, 0));
    CHECK(world(1) == glm::vec3(1, 0.5f, 7)); // half of the shape, and its joint
    CHECK(world(2) == glm::vec3(1, 1, 7));
    CHECK(world(3) == glm::vec3(-1, 1, 3.5f));
    gltf.json["skins"][0]["joints"] = {still};
    CHECK_THROWS_WITH(load_model(gltf.write(folder / "m.gltf")), Catch::Contains("joint"));
}

TEST_CASE("a skin and its animation in Collada, with a camera and a light") {
    const TemporaryDirectory folder;
    const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", moved = "1 0 0 0 0 1 0 2 0 0 1 0 0 0 0 1";
    const auto source = [](const std::string& id, const std::string& kind, int count, int stride,
                           const std::string& values, const std::string& type) {
        return "<source id='" + id + "'><" + kind + " id='" + id + "-a' count='"
               + std::to_string(count * stride) + "'>" + values + "</" + kind
               + "><technique_common><accessor source='#" + id + "-a' count='" + std::to_string(count)
               + "' stride='" + std::to_string(stride) + "'>" + type
               + "</accessor></technique_common></source>";
    };
    const std::string xyz =
        "<param name='X' type='float'/><param name='Y' type='float'/><param name='Z' type='float'/>";
    const std::string matrix = "<param name='TRANSFORM' type='float4x4'/>",
                      number = "<param name='WEIGHT' type='float'/>";
    std::ofstream(folder / "m.dae")
        << "<?xml version='1.0'?>"
           "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>"
           "<asset><unit name='meter' meter='1'/><up_axis>Y_UP</up_axis></asset>"
           "<library_cameras><camera id='c'><optics><technique_common><perspective><yfov>40</yfov>"
           "<aspect_ratio>1</aspect_ratio><znear>0.1</znear><zfar>9</zfar></perspective>"
           "</technique_common></optics></camera></library_cameras>"
           "<library_lights><light id='l'><technique_common><point><color>1 1 1</color></point>"
           "</technique_common></light></library_lights><library_geometries><geometry id='g'><mesh>"
        << source("p", "float_array", 3, 3, "0 0 0 1 0 0 0 1 0", xyz)
        << "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices><triangles count='1'>"
           "<input semantic='VERTEX' source='#v' offset='0'/><p>0 1 2</p></triangles></mesh></geometry>"
           "</library_geometries><library_controllers><controller id='k'><skin source='#g'>"
           "<bind_shape_matrix>"
        << identity << "</bind_shape_matrix>"
        << source("j", "Name_array", 2, 1, "still moving", "<param name='JOINT' type='name'/>")
        << source("b", "float_array", 2, 16, identity + " " + identity, matrix)
        << source("w", "float_array", 2, 1, "1 0.5", number)
        << "<joints><input semantic='JOINT' source='#j'/><input semantic='INV_BIND_MATRIX' source='#b'/>"
           "</joints><vertex_weights count='3'><input semantic='JOINT' source='#j' offset='0'/>"
           "<input semantic='WEIGHT' source='#w' offset='1'/><vcount>1 1 2</vcount><v>0 0 1 0 0 1 1 1</v>"
           "</vertex_weights></skin></controller></library_controllers>"
           "<library_animations><animation id='a'>"
        << source("t", "float_array", 2, 1, "0 1", "<param name='TIME' type='float'/>")
        << source("o", "float_array", 2, 16, identity + " " + moved, matrix)
        << source("i", "Name_array", 2, 1, "LINEAR LINEAR", "<param name='INTERPOLATION' type='name'/>")
        << "<sampler id='s'><input semantic='INPUT' source='#t'/><input semantic='OUTPUT' source='#o'/>"
           "<input semantic='INTERPOLATION' source='#i'/></sampler>"
           "<channel source='#s' target='moving/transform'/></animation></library_animations>"
           "<library_visual_scenes><visual_scene id='x'>"
           "<node id='still' sid='still' name='still' type='JOINT'><matrix sid='transform'>"
        << identity
        << "</matrix></node><node id='moving' sid='moving' name='moving' type='JOINT'>"
           "<matrix sid='transform'>"
        << identity
        << "</matrix></node><node id='body' name='body'><instance_controller url='#k'/></node>"
           "<node id='eye' name='eye'><instance_camera url='#c'/></node>"
           "<node id='lamp' name='lamp'><instance_light url='#l'/></node></visual_scene>"
           "</library_visual_scenes><scene><instance_visual_scene url='#x'/></scene></COLLADA>";
    const Model model = load_model(folder / "m.dae");
    CHECK(model.losses
          == std::vector<std::string>{"1 camera is without its field of view, and has 45 degrees (eye)",
                                      "1 light is left out, for its format has no unit for it (lamp)"});
    REQUIRE(model.cameras.size() == 1);
    CHECK(model.cameras[0].names == std::vector<std::string>{"eye"});
    CHECK(model.cameras[0].camera.vertical_fov == Approx(45));
    Scene scene;
    add_model(scene, model);
    const auto heights = [&](double time) {
        std::vector<glm::dmat4> placed;
        scene.place_nodes(time, placed);
        std::vector<float> result;
        for (std::size_t node = 0; node < scene.nodes.size(); ++node) {
            for (const Part& part : scene.nodes[node].parts) {
                for (const Vertex& vertex : scene.mesh_at(node, part.mesh, placed, time)->vertices) {
                    const glm::dvec4 place = placed[node] * glm::dvec4(glm::dvec3(vertex.position), 1);
                    result.push_back(static_cast<float>(place.y));
                }
            }
        }
        return result;
    };
    // The third vertex is half of the moving joint's. Sines of assimp's axes leave some 1e-17.
    CHECK_THAT(heights(0), Catch::Approx(std::vector<float>{0, 0, 1}).margin(1e-6f));
    CHECK_THAT(heights(1), Catch::Approx(std::vector<float>{0, 2, 2}).margin(1e-6f));
    CHECK_THAT(heights(0.5), Catch::Approx(std::vector<float>{0, 1, 1.5f}).margin(1e-6f));
}

TEST_CASE("cameras and lights of a file") {
    const TemporaryDirectory folder;
    GltfFile gltf;
    gltf.add_node({{"mesh", gltf.add_quad(Json::object())}});
    gltf.add("cameras",
             {{"type", "perspective"}, {"name", "lens"}, {"perspective", {{"yfov", 1}, {"znear", 0.25}}}});
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "directional"}, {"intensity", glm::radians(180.0f)}, {"color", {1, 0.5, 0}}},
        {{"type", "spot"}, {"range", 9}, {"spot", {{"outerConeAngle", 0.5}}}},
        {{"type", "tube"}}};
    gltf.add_node({{"name", "stand"}, {"camera", 0}, {"translation", {0, 0, 5}}});
    for (int i = 0; i < 3; ++i)
        gltf.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    const Model model = load_model(gltf.write(folder / "m.gltf"));
    REQUIRE(model.cameras.size() == 1);
    CHECK(model.cameras[0].names == std::vector<std::string>{"lens", "stand"});
    CHECK(model.cameras[0].camera.vertical_fov == Approx(glm::degrees(1.0)));
    CHECK(model.cameras[0].camera.near_plane == 0.25);
    REQUIRE(model.lights.size() == 2);
    CHECK(model.lights[0].color.r == Approx(1)); // pi lux on white give back 1
    CHECK(model.lights[0].color.g == Approx(0.5));
    CHECK(model.lights[1].range == 9);
    CHECK(model.lights[1].attenuation == glm::vec3(0, 0, 1));
    CHECK(model.lights[1].outer_angle == Approx(glm::degrees(0.5)));
    CHECK(model.losses == std::vector<std::string>{"1 light is of a kind that postfx doesn't know (tube)"});
    // A scene around it has these lights alone.
    const Scene scene = open_scene((folder / "m.gltf").string(), "");
    CHECK(scene.lights.size() == 2);
    CHECK(scene.surroundings.ambient_up == glm::vec3(0));
}

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

TEST_CASE("map_d of OBJ is the opacity") {
    const TemporaryDirectory folder;
    write_tga(folder / "color.tga", 2, 1, red_green);
    write_tga(folder / "mask.tga", 2, 1, {255, 255, 255, 255, 0, 0, 0, 255});
    write_tga(folder / "soft.tga", 2, 1, {100, 100, 100, 255, 50, 50, 50, 255});
    write_tga(folder / "both.tga", 2, 1, {9, 9, 9, 255, 9, 9, 9, 128});
    std::ofstream(folder / "m.obj")
        << "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
    const auto material = [&](const std::string& lines) {
        std::ofstream(folder / "m.mtl") << "newmtl a\n" << lines;
        return only_mesh(load_model(folder / "m.obj")).empty()
                   ? Material()
                   : load_model(folder / "m.obj").materials.back();
    };
    const auto alphas = [](const Material& of) {
        return std::vector<int>{of.diffuse_texture->rgba.at(3), of.diffuse_texture->rgba.at(7)};
    };
    const Material cut = material("map_Kd color.tga\nmap_d mask.tga\n");
    CHECK(alphas(cut) == std::vector<int>{255, 0});
    CHECK(cut.diffuse_texture->rgba.at(0) == 255);
    CHECK(cut.alpha_cutoff == 0.5f);
    const Material soft = material("map_d soft.tga\n");
    CHECK(alphas(soft) == std::vector<int>{100, 50});
    CHECK(soft.blended);
    const Material same = material("map_Kd both.tga\nmap_d both.tga\n"); // the alpha of the same file
    CHECK(alphas(same) == std::vector<int>{255, 128});
    CHECK(same.blended);
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

TEST_CASE("a node far from the origin is framed as one that is near") {
    const TemporaryDirectory folder;
    const auto scene_at = [&](double x) {
        GltfFile gltf;
        gltf.add_node({{"mesh", gltf.add_quad(Json::object())}, {"translation", {x, 0, 0}}});
        return open_scene(gltf.write(folder / "m.gltf").string(), "");
    };
    const Scene near = scene_at(0), far = scene_at(1e6);
    CHECK(far.bounds().radius() == Approx(near.bounds().radius()).epsilon(1e-9));
    CHECK(far.camera.position.x - 1e6 == Approx(near.camera.position.x).epsilon(1e-8));
}
