// Models: animation, skins, shapes, cameras and lights.
#include "models.hpp"

#include <catch2/catch.hpp>

#include <postfx/error.hpp>

#include <cmath>
#include <limits>

using namespace postfx;
using namespace postfx::host;
using namespace postfx::testing;
using Json = GltfFile::Json;

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
    CHECK(scene.contents().moves);
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
                const auto mesh = scene.mesh_at(node, part.mesh, placed, time);
                for (const Vertex& vertex : mesh->vertices) {
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
