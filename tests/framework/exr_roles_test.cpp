// Which layer serves which role: by the names that programs document, never by their order.
#include <image/exr_roles.hpp>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace postfx;
using namespace postfx::formats;

namespace {

ExrPart part_with(const std::vector<std::string>& channels, const std::string& name = "",
                  const std::string& view = "") {
    ExrPart part{.name = name, .view = view, .channels = {}};
    for (const std::string& channel : channels)
        part.channels.push_back({.name = channel, .type = "half", .subsampled = false});
    return part;
}

ExrContents single(const std::vector<std::string>& channels,
                   const std::vector<std::string>& multi_view = {}) {
    return contents_of({part_with(channels)}, multi_view, {});
}

/// "layer" or "layer@view", or "!" and why there is none.
std::string chosen(const ExrContents& contents, const LayerWish& wish) {
    const LayerChoice choice = choose_layer(contents, wish);
    CHECK(choice.refusal.empty() == choice.layer.has_value());
    if (!choice.layer) return "!" + choice.refusal;
    return choice.layer->label() + (choice.layer->view.empty() ? "" : "@" + choice.layer->view);
}

bool refuses(const ExrContents& contents, const LayerWish& wish, const std::vector<std::string>& words) {
    const std::string answer = chosen(contents, wish);
    INFO(answer);
    return answer.starts_with("!") && std::all_of(words.begin(), words.end(), [&](const std::string& word) {
               return answer.find(word) != std::string::npos;
           });
}

/// `prefix` with each of `components`.
std::vector<std::string> channels(const std::string& prefix, const std::string& components) {
    std::vector<std::string> names;
    for (const char component : components)
        names.push_back(prefix + "." + component);
    return names;
}

std::vector<std::string> all(const std::vector<std::vector<std::string>>& lists) {
    std::vector<std::string> names;
    for (const auto& list : lists)
        names.insert(names.end(), list.begin(), list.end());
    return names;
}

/// What each role takes, "" where it is refused.
struct Expected {
    std::string color, depth, normal, emission, ambient;
};

void check_roles(const ExrContents& contents, const Expected& expected) {
    const auto check = [&](Role role, const std::string& layer) {
        CAPTURE(name_of(role));
        const std::string answer = chosen(contents, {.role = role, .beside = expected.color});
        CAPTURE(answer);
        CHECK((layer.empty() ? answer.starts_with("!") : answer == layer));
    };
    check(Role::color, expected.color);
    check(Role::depth, expected.depth);
    check(Role::normal, expected.normal);
    check(Role::emission, expected.emission);
    check(Role::ambient, expected.ambient);
}

} // namespace

TEST_CASE("Blender: a view layer and its passes") {
    const std::string layer = GENERATE("ViewLayer", "View Layer", "RenderLayer", "Zebra.001");
    const auto pass = [&](const char* name, const char* components) {
        return channels(layer + "." + name, components);
    };
    const auto contents =
        single(all({pass("AO", "RGB"), pass("Combined", "RGBA"), pass("Denoising Depth", "Z"),
                    pass("Denoising Normal", "XYZ"), pass("Depth", "Z"), pass("DiffCol", "RGB"),
                    pass("DiffInd", "RGB"), pass("Emit", "RGB"), pass("Env", "RGB"), pass("IndexOB", "X"),
                    pass("Mist", "Z"), pass("Normal", "XYZ"), pass("Position", "XYZ"), pass("Vector", "XYZW"),
                    pass("CryptoObject00", "rgba")}));
    check_roles(contents, {layer + ".Combined", layer + ".Depth", layer + ".Normal", layer + ".Emit", ""});
    CHECK(has_world_normals(*choose_layer(contents, {.role = Role::normal}).layer, "") == true);
}

TEST_CASE("Blender: parts called by layer and pass") {
    const auto contents = contents_of(
        {part_with({"R", "G", "B"}, "ViewLayer.Ambient Occlusion"),
         part_with({"R", "G", "B", "A"}, "ViewLayer.Combined"), part_with({"V"}, "ViewLayer.Depth"),
         part_with({"X", "Y", "Z"}, "ViewLayer.Normal"), part_with({"R", "G", "B"}, "ViewLayer.Emission")},
        {}, {});
    check_roles(contents,
                {"ViewLayer.Combined", "ViewLayer.Depth", "ViewLayer.Normal", "ViewLayer.Emission", ""});
}

TEST_CASE("Blender: two view layers are two families") {
    const auto contents =
        single(all({channels("Background.Combined", "RGBA"), channels("ViewLayer.Combined", "RGBA"),
                    channels("ViewLayer.Depth", "Z"), channels("Other.Depth", "Z")}));
    CHECK(refuses(contents, {.role = Role::color},
                  {"\"Background.Combined\"", "\"ViewLayer.Combined\"", "--color-layer"}));
    CHECK(refuses(contents, {.role = Role::depth},
                  {"\"ViewLayer.Depth\"", "\"Other.Depth\"", "--depth-layer"}));
    CHECK(chosen(contents, {.role = Role::color, .layer = "ViewLayer"}) == "ViewLayer.Combined");
    CHECK(chosen(contents, {.role = Role::depth, .beside = "ViewLayer.Combined"}) == "ViewLayer.Depth");
    // The depth of what the colour doesn't show is none of its.
    CHECK(refuses(contents, {.role = Role::depth, .beside = "Background.Combined"},
                  {"beside \"Background.Combined\"", "--depth-layer"}));
    CHECK(chosen(contents, {.role = Role::depth, .layer = "Other.Depth", .beside = "Background.Combined"})
          == "Other.Depth");
}

TEST_CASE("Blender: the compositor's picture goes with its only view layer") {
    const auto contents =
        single(all({channels("Composite.Combined", "RGBA"), channels("ViewLayer.Combined", "RGBA"),
                    channels("ViewLayer.Depth", "Z")}));
    check_roles(contents, {"Composite.Combined", "ViewLayer.Depth", "", "", ""});
}

TEST_CASE("Blender: stereo in one file, views before the channel") {
    const auto eye = [](const std::string& view) {
        return all(
            {channels("ViewLayer.Combined." + view, "RGBA"), channels("ViewLayer.Depth." + view, "Z")});
    };
    const auto contents = single(all({eye("left"), eye("right")}), {"left", "right"});
    CHECK(chosen(contents, {.role = Role::color}) == "ViewLayer.Combined@left");
    CHECK(chosen(contents, {.role = Role::depth, .view = "right", .beside = "ViewLayer.Combined"})
          == "ViewLayer.Depth@right");
}

TEST_CASE("Nuke") {
    const auto contents = single(all({{"R", "G", "B", "A"},
                                      {"depth.Z"},
                                      {"forward.u", "forward.v"},
                                      {"mask.a"},
                                      channels("ao", "RGB"),
                                      channels("normal", "XYZ"),
                                      channels("emission", "RGB")}));
    check_roles(contents, {"R,G,B,A", "depth", "normal", "emission", ""});
    const auto long_names = single({"rgba.red", "rgba.green", "rgba.blue", "rgba.alpha", "ao.red", "ao.green",
                                    "ao.blue", "depth.Z", "N.red", "N.green", "N.blue"});
    check_roles(long_names, {"rgba", "depth", "N", "", ""});
    CHECK(choose_layer(long_names, {}).layer->channels
          == std::vector<std::string>{"rgba.red", "rgba.green", "rgba.blue", "rgba.alpha"});
}

TEST_CASE("Nuke: a part for each layer and view") {
    const auto contents = contents_of(
        {part_with({"R", "G", "B"}, "ao.left", "left"), part_with({"R", "G", "B", "A"}, "rgba.left", "left"),
         part_with({"Z"}, "depth.left", "left"), part_with({"R", "G", "B", "A"}, "rgba.right", "right"),
         part_with({"R", "G", "B"}, "ao.right", "right")},
        {}, {});
    CHECK(chosen(contents, {}) == "rgba@left");
    CHECK(chosen(contents, {.role = Role::depth, .beside = "rgba"}) == "depth@left");
    CHECK(chosen(contents, {.view = "right"}) == "rgba@right");
    CHECK(refuses(contents, {.role = Role::depth, .view = "right"},
                  {"no depth", "\"right\"", "\"left\"", "--view"}));
    CHECK(refuses(contents, {.view = "rigth"}, {"did you mean \"right\""}));
}

TEST_CASE("Arnold") {
    const auto contents = single(all({{"R", "G", "B", "A", "Z", "volume_Z"},
                                      channels("N", "XYZ"),
                                      channels("P", "XYZ"),
                                      channels("N_denoise", "RGB"),
                                      channels("emission", "RGB"),
                                      channels("indirect", "RGB"),
                                      channels("direct", "RGB"),
                                      channels("AO", "RGB"),
                                      channels("albedo", "RGB"),
                                      channels("RGBA_denoise", "RGBA"),
                                      channels("crypto_object00", "RGBA")}));
    check_roles(contents, {"R,G,B,A", "Z", "N", "emission", "indirect"});
    const ExrLayer normals = *choose_layer(contents, {.role = Role::normal}).layer;
    CHECK(has_world_normals(normals, "Arnold") == true);
    CHECK_FALSE(has_world_normals(normals, "")); // Mantra's N is in camera space: the name alone says nothing
    const auto merged =
        single(all({channels("RGBA", "RGBA"), channels("N", "RGB"), {"Z.Z"}, channels("AO", "RGB")}));
    check_roles(merged, {"RGBA", "Z", "N", "", ""});
}

TEST_CASE("V-Ray") {
    const auto contents = single(all({{"R", "G", "B", "A", "Z"},
                                      channels("VRayZDepth", "RGB"),
                                      channels("normals", "XYZ"),
                                      channels("bumpNormals", "XYZ"),
                                      channels("selfIllum", "RGB"),
                                      channels("GI", "RGB"),
                                      channels("rawGI", "RGB"),
                                      channels("lighting", "RGB"),
                                      channels("multimatte", "RGB"),
                                      channels("effectsResult", "RGB")}));
    check_roles(contents, {"R,G,B,A", "Z", "normals", "selfIllum", "GI"});
    CHECK(has_world_normals(*choose_layer(contents, {.role = Role::normal}).layer, "V-Ray") == false);
    const auto only_grey =
        single(all({{"R", "G", "B"}, channels("ZDepth", "RGB"), channels("VRayNormals", "RGB")}));
    check_roles(only_grey, {"R,G,B", "ZDepth", "VRayNormals", "", ""});
}

TEST_CASE("Houdini") {
    const auto karma = single(all({channels("C", "RGBA"),
                                   {"depth.Z"},
                                   channels("N", "XYZ"),
                                   channels("P", "XYZ"),
                                   channels("albedo", "RGB"),
                                   channels("emission", "RGB"),
                                   channels("indirectdiffuse", "RGB"),
                                   channels("directdiffuse", "RGB")}));
    check_roles(karma, {"C", "depth", "N", "emission", "indirectdiffuse"});
    const auto mantra =
        single(all({{"R", "G", "B", "A", "Pz"}, channels("N", "XYZ"), channels("Ce", "RGB")}));
    check_roles(mantra, {"R,G,B,A", "Pz", "N", "Ce", ""});
    const auto beauty = single(all({channels("beauty", "RGBA"), channels("background", "RGB"), {"depth.z"}}));
    check_roles(beauty, {"beauty", "depth", "", "", ""});
}

TEST_CASE("Unreal's Movie Render Queue") {
    const std::string pass = GENERATE("FinalImageMovieRenderQueue_", "FinalImageMoviePipeline_");
    const bool queue = pass == "FinalImageMovieRenderQueue_";
    const auto contents = single(all({{"R", "G", "B", "A"},
                                      channels(pass + "AmbientOcclusion", "RGBA"),
                                      channels(pass + "WorldDepth", "RGBA"),
                                      channels(pass + "WorldNormal", "RGBA"),
                                      channels("ActorHitProxyMask00", "RGBA")}));
    if (queue) check_roles(contents, {"R,G,B,A", pass + "WorldDepth", pass + "WorldNormal", "", ""});
    if (queue) CHECK(has_world_normals(*choose_layer(contents, {.role = Role::normal}).layer, "") == true);
    CHECK(chosen(contents, {}) == "R,G,B,A");
    const auto named = single(all({channels("MaterialAO", "RGBA"), channels("FinalImage", "RGBA"),
                                   channels("SceneDepth", "RGBA"), channels("WorldNormal", "RGBA")}));
    check_roles(named, {"FinalImage", "SceneDepth", "WorldNormal", "", ""});
}

TEST_CASE("RenderMan") {
    const auto contents = single(all({channels("Ci", "rgba"),
                                      {"z"},
                                      channels("Nn", "xyz"),
                                      channels("albedo", "rgb"),
                                      channels("emissive", "rgb")}));
    check_roles(contents, {"Ci", "z", "Nn", "emissive", ""});
}

TEST_CASE("Z beside R, G, B is depth; Z of a vector is not") {
    const auto with_z = single({"R", "G", "B", "Z"});
    CHECK(chosen(with_z, {}) == "R,G,B");
    CHECK(chosen(with_z, {.role = Role::depth}) == "Z");
    CHECK(chosen(with_z, {.role = Role::normal}) == "R,G,B");
    check_roles(with_z, {"R,G,B", "Z", "", "", ""}); // what is the colour already is nothing else
    for (const auto& contents : {single({"X", "Y", "Z"}), single({"N.X", "N.Y", "N.Z"})}) {
        CHECK(chosen(contents, {.role = Role::normal}) == contents.layers.front().label());
        CHECK(refuses(contents, {.role = Role::depth}, {"Z", "--depth-layer"}));
    }
    CHECK(chosen(single({"X", "Y", "Z", "R", "G", "B", "id"}), {.role = Role::normal}) == "X,Y,Z");
    check_roles(single({"R", "G", "B", "N.X", "N.Y", "N.Z"}), {"R,G,B", "", "N", "", ""});
    CHECK(chosen(single({"R", "G", "B", "N.X", "N.Y", "N.Z"}), {.role = Role::depth, .layer = "N.Z"})
          == "N.Z");
}

TEST_CASE("A single layer serves any role that its channels allow") {
    for (const Role role :
         {Role::color, Role::depth, Role::normal, Role::emission, Role::ambient, Role::data}) {
        CHECK(chosen(single(channels("AO", "RGB")), {.role = role}) == "AO");
        CHECK(chosen(single({"R", "G", "B", "A"}), {.role = role}) == "R,G,B,A");
        const bool three = role == Role::normal;
        CHECK(chosen(single({"whatever"}), {.role = role}).starts_with("!") == three);
    }
}

TEST_CASE("Components that are channels of names of their own") {
    for (const std::string name : {"N", "n", "normal_", "Normal"}) {
        INFO(name);
        const ExrContents file = single({"R", "G", "B", "Z", name + "x", name + "y", name + "z"});
        CHECK(chosen(file, {.role = Role::normal}) == (name == "normal_" ? "normal" : name));
        CHECK(chosen(file, {.role = Role::depth}) == "Z");
    }
    // Mantra's depth beside the rest of a place.
    CHECK(chosen(single({"R", "G", "B", "Px", "Py", "Pz"}), {.role = Role::depth}) == "Pz");
    // Two of three are no vector.
    CHECK(refuses(single({"R", "G", "B", "Nx", "Ny"}), {.role = Role::normal, .layer = "N"}, {"N"}));
}

TEST_CASE("What is no colour is not taken for one") {
    auto part =
        part_with(all({channels("id", "RGB"), channels("crypto00", "RGBA"), channels("hash01", "RGBA")}));
    for (auto& channel : part.channels)
        if (channel.name.starts_with("id")) channel.type = "uint";
    CHECK(refuses(contents_of({part}, {}, {"hash"}), {}, {"no color"}));
    // The only picture is taken, and told.
    const LayerChoice choice = choose_layer(single(all({channels("AO", "RGB"), channels("N", "XYZ")})), {});
    REQUIRE(choice.layer);
    CHECK(choice.layer->name == "AO");
    REQUIRE(choice.warnings.size() == 1);
    CHECK(choice.warnings[0].find("\"AO\"") != std::string::npos);
    CHECK(refuses(single(all({channels("AO", "RGB"), channels("diffuse", "RGB")})), {},
                  {"AO", "diffuse", "--color-layer"}));
    CHECK(chosen(single(all({channels("AO", "RGB"), channels("hero", "RGB")})), {}) == "hero");
}

TEST_CASE("Names that don't fit are told") {
    const auto contents =
        single(all({{"R", "G", "B", "Z"}, channels("forward", "uv"), channels("light", "RGB")}));
    CHECK(refuses(contents, {.role = Role::depth, .layer = "forward"},
                  {"forward.u, forward.v", "--depth-layer"}));
    CHECK(refuses(contents, {.role = Role::normal, .layer = "Z"}, {"normals have three"}));
    CHECK(refuses(contents, {.layer = "lihgt"}, {"did you mean \"light\"", "forward.u"}));
    CHECK(chosen(contents, {.layer = "LIGHT"}) == "light");
    CHECK(chosen(contents, {.layer = "rgba"}) == "R,G,B");
    CHECK(chosen(contents, {.role = Role::depth, .layer = "forward.u"}) == "forward.u");
    CHECK(refuses(contents, {.view = "left"}, {"no views"}));
}

TEST_CASE("Two depths of the same standing") {
    const auto contents = single({"R", "G", "B", "Z", "depth.Z"});
    CHECK(refuses(contents, {.role = Role::depth}, {"\"Z\"", "\"depth\"", "--depth-layer"}));
}

TEST_CASE("Parts that hold the same layers are families") {
    const auto contents =
        contents_of({part_with({"Combined.R", "Combined.G", "Combined.B", "Depth.Z"}, "Hero"),
                     part_with({"Combined.R", "Combined.G", "Combined.B"}, "Back")},
                    {}, {});
    CHECK(refuses(contents, {}, {"\"Hero.Combined\"", "\"Back.Combined\""}));
    CHECK(chosen(contents, {.role = Role::depth, .beside = "Hero.Combined"}) == "Hero.Depth");
    CHECK(refuses(contents, {.role = Role::depth, .beside = "Back.Combined"}, {"no depth"}));
}

TEST_CASE("Views by name where no attribute tells them") {
    const auto contents = single(all({channels("left", "RGBZ"), channels("right", "RGBZ")}));
    CHECK(contents.views == std::vector<std::string>{"left", "right"});
    CHECK(chosen(contents, {}) == "R,G,B@left");
    CHECK(chosen(contents, {.role = Role::depth, .view = "right"}) == "Z@right");
    CHECK(chosen(contents, {.role = Role::depth, .layer = "right.Z"}) == "Z@right");
    CHECK(chosen(contents, {.role = Role::data, .layer = "right"}) == "R,G,B@right");
    // A depth that belongs to no view goes with the default one.
    const auto shared =
        single(all({channels("left", "RGB"), channels("right", "RGB"), {"depth.Z"}}), {"right", "left"});
    CHECK(chosen(shared, {.role = Role::depth}) == "depth");
    CHECK(refuses(shared, {.role = Role::depth, .view = "left"}, {"no depth", "\"left\"", "\"right\""}));
    CHECK(chosen(shared, {.role = Role::depth, .layer = "depth", .view = "left"}) == "depth");
}
