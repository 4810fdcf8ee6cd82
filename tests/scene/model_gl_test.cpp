// Models as they are drawn: what their files say of surfaces, sizes, places and time is seen.
#define CATCH_CONFIG_RUNNER
#include "gltf_files.hpp"

#include <catch2/catch.hpp>

#include <gl/context.hpp>
#include <gl/objects.hpp>
#include <scene/model.hpp>
#include <scene/renderer.hpp>
#include <scene/view_bounds.hpp>
#include <temporary_directory.hpp>
#include <testing.hpp>

#include <glm/gtc/type_ptr.hpp>

#include <cmath>
#include <functional>
#include <iostream>

using namespace postfx::host;
using namespace postfx::testing;
using postfx::Image;
using Json = GltfFile::Json;

namespace {

constexpr int size = 48;

struct Frame {
    Image color, depth;
    postfx::Camera camera;

    /// The pixel that shows the place (x, y, 0) of the world.
    glm::ivec2 pixel(double x, double y) const {
        const glm::dmat4 view_to_world = glm::make_mat4(camera.view_to_world.data());
        const glm::dvec4 seen = glm::inverse(view_to_world) * glm::dvec4(x, y, 0, 1);
        const double half = -seen.z * camera.tan_half_fov();
        return {static_cast<int>((seen.x / half * 0.5 + 0.5) * size),
                static_cast<int>((seen.y / half * 0.5 + 0.5) * size)};
    }
    glm::vec3 at(double x, double y) const {
        const glm::ivec2 p = pixel(x, y);
        return {color.at(p.x, p.y, 0), color.at(p.x, p.y, 1), color.at(p.x, p.y, 2)};
    }
    bool covers(double x, double y) const {
        const glm::ivec2 p = pixel(x, y);
        return depth.at(p.x, p.y, 0) > 0;
    }
};

Image read(const SceneFrame& frame, const std::string& name) {
    for (const SceneAttachment& attachment : frame.attachments) {
        if (attachment.name == name)
            return postfx::gl::read_texture(attachment.texture, size, size, attachment.format);
    }
    throw std::logic_error("no attachment " + name);
}

Frame draw(Scene scene, double time = 0) {
    SceneRenderer renderer(std::move(scene));
    const SceneFrame frame = renderer.render(size, size, time, {"depth"});
    Frame result{read(frame, "color"), read(frame, "depth"), frame.camera};
    for (const std::string& message : postfx::gl::take_debug_messages())
        FAIL_CHECK("OpenGL says: " << message);
    return result;
}

/// A scene around the model that `make` fills, with pictures two.tga (red, green), rough.tga (as it says) beside it.
Scene scene_of(const std::function<void(GltfFile&)>& make) {
    const TemporaryDirectory folder;
    write_tga(folder / "two.tga", 2, 1, {255, 0, 0, 255, 0, 255, 0, 255});
    write_tga(folder / "white.tga", 1, 1, {255, 255, 255, 255});
    write_tga(folder / "grey.tga", 1, 1, {128, 128, 128, 255});
    write_tga(folder / "tilted.tga", 1, 1, {218, 128, 218, 255}); // a normal of (0.7, 0, 0.7)
    write_tga(folder / "mask.tga", 2, 1, {255, 0, 0, 255, 255, 0, 0, 0});
    GltfFile gltf;
    make(gltf);
    return open_scene(gltf.write(folder / "m.gltf").string(), "");
}

/// A quad that shows its base colour alone.
Json unlit(Json material = Json::object()) {
    material["extensions"]["KHR_materials_unlit"] = Json::object();
    return material;
}

Json textured(int index, Json info = Json::object()) {
    info["index"] = index;
    return {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", info}}}};
}

glm::vec3 middle(const Image& image) {
    return {image.at(size / 2, size / 2, 0), image.at(size / 2, size / 2, 1),
            image.at(size / 2, size / 2, 2)};
}

double largest_difference(const Image& a, const Image& b) {
    double result = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        result =
            std::max(result, std::abs(static_cast<double>(a.values[i]) - static_cast<double>(b.values[i])));
    return result;
}

std::size_t count_different(const Image& a, const Image& b, float by) {
    std::size_t result = 0;
    for (std::size_t pixel = 0; pixel < a.pixel_count(); ++pixel) {
        float most = 0;
        for (std::size_t c = 0; c < static_cast<std::size_t>(a.channels); ++c) {
            const std::size_t i = pixel * static_cast<std::size_t>(a.channels) + c;
            most = std::max(most, std::abs(a.values[i] - b.values[i]));
        }
        result += most > by;
    }
    return result;
}

/// Two quads of which one throws its shadow on the other.
void add_stairs(GltfFile& gltf, double scale, const glm::dvec3& at = glm::dvec3(0)) {
    const Json material = {{"doubleSided", true},
                           {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.5}}}};
    const std::size_t mesh = gltf.add_quad(material);
    gltf.add("nodes", {{"mesh", mesh}});
    gltf.add("nodes", {{"mesh", mesh}, {"scale", {0.4, 0.4, 0.4}}, {"translation", {-0.2, 0.3, 0.6}}});
    gltf.add_node(
        {{"children", {0, 1}}, {"scale", {scale, scale, scale}}, {"translation", {at.x, at.y, at.z}}});
}

} // namespace

TEST_CASE("models from a millimetre to a hundred kilometres look alike") {
    const Frame reference = draw(scene_of([](GltfFile& gltf) { add_stairs(gltf, 1); }));
    CHECK(middle(reference.color).g > 0.1f);
    for (const double scale : {1e-3, 0.007, 30.0, 1e5}) {
        INFO(scale);
        const Frame scaled = draw(scene_of([&](GltfFile& gltf) { add_stairs(gltf, scale); }));
        // Rounded elsewhere: pixels at edges, of quads and of the shadow's filter, may fall on the other side.
        CHECK(count_different(reference.color, scaled.color, 0.01f) < size);
        CHECK(count_different(reference.depth, scaled.depth, 1e-5f) < size);
    }
    // The kind of light matters too: a lamp close to a tiny model is as bright as one far from a large one.
    const auto lamp = [](double scale) {
        return draw(scene_of([&](GltfFile& gltf) {
            add_stairs(gltf, scale);
            gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
                {{"type", "point"}, {"intensity", 9 * scale * scale}}};
            gltf.add_node({{"translation", {scale, scale, 2 * scale}},
                           {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        }));
    };
    CHECK(count_different(lamp(1).color, lamp(1e-3).color, 0.01f) < size);
}

TEST_CASE("a model keeps its shape far from the origin") {
    const Frame near = draw(scene_of([](GltfFile& gltf) { add_stairs(gltf, 1); }));
    for (const glm::dvec3 at : {glm::dvec3(1e6, 0, 0), glm::dvec3(-1e6, 1e6, 1e6)}) {
        const Frame far = draw(scene_of([&](GltfFile& gltf) { add_stairs(gltf, 1, at); }));
        CHECK(count_different(near.color, far.color, 0.01f) < size);
        CHECK(count_different(near.depth, far.depth, 1e-5f) < size);
    }
}

TEST_CASE("wrap and filter of samplers") {
    // u from -1 to 2 over the quad: its thirds are -1..0, 0..1, 1..2.
    const auto shown = [](const Json& sampler) {
        return draw(scene_of([&](GltfFile& gltf) {
            gltf.add_texture("two.tga", sampler);
            Json attributes = gltf.quad_attributes();
            attributes["TEXCOORD_0"] = gltf.floats("VEC2", {-1, 1, 2, 1, 2, 0, -1, 0});
            gltf.add_node({{"mesh", gltf.add_quad(unlit(textured(0)), attributes)}});
        }));
    };
    const auto reds = [](const Frame& frame) {
        std::string result; // from the left to the right of the quad
        for (int sixth = 0; sixth < 6; ++sixth)
            result += frame.at(-1 + (sixth + 0.5) / 3, 0).r > 0.5f ? 'r' : 'g';
        return result;
    };
    const Json nearest = {{"magFilter", 9728}, {"minFilter", 9728}};
    Json clamp = nearest, mirror = nearest, repeat = nearest;
    clamp["wrapS"] = 33071;
    mirror["wrapS"] = 33648;
    CHECK(reds(shown(repeat)) == "rgrgrg");
    CHECK(reds(shown(clamp)) == "rrrggg");
    CHECK(reds(shown(mirror)) == "grrggr");
    // Filtered, the colours mix; nearest, they don't.
    const glm::vec3 mixed = shown({{"wrapS", 33071}}).at(0, 0), plain = shown(clamp).at(0, 0);
    CHECK(std::min(mixed.r, mixed.g) > 0.1f);
    CHECK(std::min(plain.r, plain.g) < 0.01f);
}

TEST_CASE("texture transforms and the second set of coordinates") {
    const auto shown = [](const Json& info, bool second) {
        return draw(scene_of([&](GltfFile& gltf) {
            gltf.add_texture("two.tga", {{"magFilter", 9728}, {"minFilter", 9728}});
            Json attributes = gltf.quad_attributes();
            if (second) attributes["TEXCOORD_1"] = gltf.floats("VEC2", {1, 1, 0, 1, 0, 0, 1, 0});
            Json material = unlit(textured(0, info));
            if (second) material["occlusionTexture"] = {{"index", 0}}; // so that both sets are used
            gltf.add_node({{"mesh", gltf.add_quad(material, attributes)}});
        }));
    };
    const auto left_is_red = [](const Frame& frame) {
        return frame.at(-0.5, 0).r > 0.5f && frame.at(0.5, 0).g > 0.5f;
    };
    const auto left_is_green = [](const Frame& frame) {
        return frame.at(-0.5, 0).g > 0.5f && frame.at(0.5, 0).r > 0.5f;
    };
    CHECK(left_is_red(shown(Json::object(), false)));
    CHECK(left_is_green(shown({{"texCoord", 1}}, true)));
    const auto transform = [](const Json& values) {
        return Json{{"extensions", {{"KHR_texture_transform", values}}}};
    };
    CHECK(left_is_green(shown(transform({{"offset", {0.5, 0}}}), false)));
    CHECK(left_is_green(shown(transform({{"texCoord", 1}}), true)));
    // Turned by 90 degrees red and green lie one above the other.
    const Frame turned = shown(transform({{"rotation", std::acos(0.0)}}), false);
    CHECK(turned.at(-0.5, 0.5).r > 0.5f);
    CHECK(turned.at(0.5, 0.5).r > 0.5f);
    CHECK(turned.at(-0.5, -0.5).g > 0.5f);
    CHECK(turned.at(0.5, -0.5).g > 0.5f);
}

TEST_CASE("alpha is for MASK and BLEND alone, and vertices have it too") {
    const auto covered = [](const Json& more, float vertex_alpha = 1) {
        const Frame frame = draw(scene_of([&](GltfFile& gltf) {
            gltf.add_texture("mask.tga", {{"magFilter", 9728}, {"minFilter", 9728}});
            Json material = unlit(textured(0));
            material.update(more);
            Json attributes = gltf.quad_attributes();
            std::vector<float> colors;
            for (int i = 0; i < 4; ++i)
                colors.insert(colors.end(), {1, 1, 1, vertex_alpha});
            attributes["COLOR_0"] = gltf.floats("VEC4", colors);
            gltf.add_node({{"mesh", gltf.add_quad(material, attributes)}});
        }));
        return std::pair(frame.covers(-0.5, 0), frame.covers(0.5, 0));
    };
    CHECK(covered(Json::object()) == std::pair(true, true));
    CHECK(covered({{"alphaMode", "MASK"}}) == std::pair(true, false));
    CHECK(covered({{"alphaMode", "MASK"}}, 0.25f) == std::pair(false, false));
    CHECK(covered({{"alphaMode", "MASK"}, {"alphaCutoff", 0.2}}, 0.25f) == std::pair(true, false));
    CHECK(covered({{"alphaMode", "BLEND"}}) == std::pair(false, false)); // what is blended leaves no depth
}

TEST_CASE("what MASK cuts away throws no shadow") {
    // A lamp shines through a small quad upon a large one, whose middle the camera sees from beside.
    const auto lit = [](double alpha) {
        Scene scene = scene_of([&](GltfFile& gltf) {
            const Json white = {{"metallicFactor", 0}, {"roughnessFactor", 1}};
            gltf.add_node({{"mesh", gltf.add_quad({{"pbrMetallicRoughness", white}})}});
            const Json pane = {{"alphaMode", "MASK"},
                               {"doubleSided", true},
                               {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, alpha}}}}};
            gltf.add_node(
                {{"mesh", gltf.add_quad(pane)}, {"scale", {0.3, 0.3, 1}}, {"translation", {0, 0, 2}}});
            gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
                {{"type", "spot"}, {"intensity", 50}, {"spot", {{"outerConeAngle", 0.6}}}}};
            gltf.add_node(
                {{"translation", {0, 0, 4}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        });
        scene.camera.position = {3, 0, 1};
        scene.camera.look_at = {0, 0, 0};
        return draw(std::move(scene)).at(0, 0).g;
    };
    CHECK(lit(0.9) < 0.1f);
    CHECK(lit(0.1) > 0.5f);
}

TEST_CASE("metalness and roughness are factors times a texture") {
    const auto shown = [](double metalness, double roughness, const char* picture) {
        return draw(scene_of([&](GltfFile& gltf) {
                   Json pbr = {{"baseColorFactor", {0.8, 0.2, 0.2, 1}},
                               {"metallicFactor", metalness},
                               {"roughnessFactor", roughness}};
                   if (picture) {
                       gltf.add_texture(picture);
                       pbr["metallicRoughnessTexture"] = {{"index", 0}};
                   }
                   gltf.add_node({{"mesh", gltf.add_quad({{"pbrMetallicRoughness", pbr}})}});
               }))
            .color;
    };
    CHECK(largest_difference(shown(0, 0.2, "white.tga"), shown(0, 0.2, nullptr)) < 0.002);
    CHECK(largest_difference(shown(0.5, 0.6, "white.tga"), shown(0.5, 0.6, nullptr))
          > 0.01); // lit for another reflectance
    constexpr double grey = 128.0 / 255;
    CHECK(largest_difference(shown(1, 1, "grey.tga"), shown(grey, grey, "white.tga")) < 0.002);
    CHECK(largest_difference(shown(1, 1, "grey.tga"), shown(1, 1, "white.tga")) > 0.05);
}

TEST_CASE("normal maps have a scale, occlusion a strength, emission a strength, unlit surfaces no light") {
    const auto shown = [](Json material) {
        return middle(draw(scene_of([&](GltfFile& gltf) {
                          gltf.add_texture("tilted.tga");
                          gltf.add_texture("grey.tga");
                          if (!material.contains("pbrMetallicRoughness"))
                              material["pbrMetallicRoughness"] = {{"metallicFactor", 0},
                                                                  {"baseColorFactor", {0.5, 0.5, 0.5, 1}}};
                          gltf.add_node({{"mesh", gltf.add_quad(material)}});
                      })).color);
    };
    const glm::vec3 plain = shown(Json::object());
    // 128 / 255 is not quite the middle: a tilt of 0.2 degrees.
    CHECK(shown({{"normalTexture", {{"index", 0}, {"scale", 0}}}}).g == Approx(plain.g).epsilon(0.01));
    const float full = shown({{"normalTexture", {{"index", 0}}}}).g,
                part = shown({{"normalTexture", {{"index", 0}, {"scale", 0.3}}}}).g;
    CHECK(std::abs(full - plain.g) > 0.02f);
    CHECK(part != Approx(full).epsilon(0.01));
    const float dark = shown({{"occlusionTexture", {{"index", 1}}}}).g,
                half = shown({{"occlusionTexture", {{"index", 1}, {"strength", 0.5}}}}).g;
    CHECK(dark < half);
    CHECK(half < plain.g);
    CHECK(half == Approx((dark + plain.g) / 2).epsilon(0.005));
    const glm::vec3 glow =
        shown({{"emissiveFactor", {1, 0, 0}},
               {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}}}}});
    CHECK(glow.r - plain.r == Approx(5).epsilon(0.01));
    const glm::vec3 bare = shown(unlit({{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 1, 1}}}}}));
    CHECK(bare.r == Approx(0.25).epsilon(0.001));
    CHECK(bare.b == Approx(1).epsilon(0.001));
}

TEST_CASE("one-sided surfaces are not seen from behind") {
    for (const bool both : {false, true}) {
        for (const bool turned : {false, true}) {
            Scene scene = scene_of([&](GltfFile& gltf) {
                const std::size_t mesh = gltf.add_quad({{"doubleSided", both}});
                gltf.add_node({{"mesh", mesh}, {"rotation", {0, turned ? 1 : 0, 0, turned ? 0 : 1}}});
                gltf.add("cameras",
                         {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
                gltf.add_node({{"camera", 0}, {"translation", {0, 0, 5}}});
            });
            scene.camera = scene.cameras.at(0).camera;
            CHECK(draw(scene).covers(0, 0) == (both || !turned));
        }
    }
}

TEST_CASE("animation and skins are drawn at their time, and what is said of a frame holds") {
    const Scene scene = scene_of([](GltfFile& gltf) {
        Json attributes = gltf.quad_attributes();
        attributes["JOINTS_0"] = gltf.shorts("VEC4", {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
        attributes["WEIGHTS_0"] = gltf.floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
        const std::size_t mesh = gltf.add_quad(unlit({{"doubleSided", true}}), attributes);
        const std::size_t still = gltf.add_node(Json::object()), moving = gltf.add_node(Json::object());
        gltf.add("skins", {{"joints", {still, moving}}});
        gltf.add_node({{"mesh", mesh}, {"skin", 0}});
        const std::size_t times = gltf.floats("SCALAR", {0, 2}),
                          moves = gltf.floats("VEC3", {0, 0, 0, -1.8f, 0, -3});
        gltf.add("animations",
                 {{"samplers", {{{"input", times}, {"output", moves}}}},
                  {"channels", {{{"sampler", 0}, {"target", {{"node", moving}, {"path", "translation"}}}}}}});
    });
    const auto covered = [&](double time) {
        const Image depth = draw(scene, time).depth;
        return std::count_if(depth.values.begin(), depth.values.end(), [](float value) { return value > 0; });
    };
    CHECK(covered(0) > covered(1));
    CHECK(covered(1) > covered(2));
    CHECK(covered(2) > 0);
    CHECK(covered(3) == covered(1)); // in the second round
    ViewBounds bounds(scene);
    for (const double time : {0.0, 1.0, 2.0}) {
        const postfx::Camera camera = scene.camera_at(time);
        const auto said = bounds.at(time, camera, size, size);
        const Image depth = draw(scene, time).depth;
        for (const float value : depth.values) {
            if (value == 0) continue;
            const double z = camera.view_z(static_cast<double>(value));
            CHECK(z >= said.nearest);
            CHECK(z <= said.farthest);
        }
    }
}

int main(int argc, char* argv[]) {
    std::string why;
    if (!has_gl(&why)) {
        std::cout << "skipped: " << why << "\n";
        return 77;
    }
    const postfx::gl::HeadlessContext context(true);
    postfx::gl::enable_debug_output();
    return Catch::Session().run(argc, argv);
}
