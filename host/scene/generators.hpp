// Procedural models: each makes parts by slot name ("trunk", "needles", ...), the same for the same
// parameters.
#pragma once

#include "geometry.hpp"
#include "path.hpp"
#include "terrain.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace postfx::host {

/// Mesh with the slot that says what it is made of.
struct MadePart {
    std::string slot;
    Mesh mesh;
};
using MadeParts = std::vector<MadePart>;

/// Slot "ground"; cut into square parts so that what is out of view is not drawn.
MadeParts make_terrain(const Terrain& terrain);

struct RoadOptions {
    double width = 6.4;       ///< metres
    double dash_length = 3;   ///< metres of the middle line's dashes; 0 = no line
    double dash_gap = 6;      ///< metres
    double line_width = 0.13; ///< metres
};
/// Slots "asphalt" and "line".
MadeParts make_road(const Path& path, const RoadOptions& options);

struct TreeOptions {
    std::uint32_t seed = 1;
    std::string kind = "conifer"; ///< or "broadleaf"
    float height = 9;             ///< metres
};
/// One tree standing at the origin. Slots "trunk" and "needles" or "leaves".
MadeParts make_tree(const TreeOptions& options);

struct ForestOptions {
    std::uint32_t seed = 1;
    int count = 300;
    double clearance = 7;          ///< metres from the path's middle that stay free
    double depth = 60;             ///< metres further that the forest goes, thinning out
    float conifers = 0.7f;         ///< share, 0..1
    glm::vec2 height_range{6, 15}; ///< metres
};
/// Trees on both sides of a path, denser near it. Slots "trunk", "needles", "leaves".
MadeParts make_forest(const Terrain& terrain, const Path& path, const ForestOptions& options);

struct GrassOptions {
    std::uint32_t seed = 1;
    int count = 4000;                     ///< tufts
    double clearance = 3.6;               ///< metres from the path's middle
    double depth = 9;                     ///< metres further
    glm::vec2 height_range{0.15f, 0.55f}; ///< metres
};
/// Tufts of grass on both sides of a path. Slot "grass".
MadeParts make_grass(const Terrain& terrain, const Path& path, const GrassOptions& options);

struct PostOptions {
    double spacing = 25;       ///< metres along the path
    double offset = 4;         ///< metres from its middle
    double height = 1;         ///< metres
    std::string side = "both"; ///< "left", "right" or "both"
};
/// Delineator posts along a path. Slots "post", "band" and "reflector".
MadeParts make_posts(const Path& path, const PostOptions& options);
/// Lamp posts along a path, their arms over it. Slots "pole" and "lamp".
MadeParts make_lamp_posts(const Path& path, const PostOptions& options);

struct SparkOptions {
    std::uint32_t seed = 1;
    int count = 100;
    glm::vec2 center{0};              ///< x, z, metres
    double radius = 50;               ///< metres
    glm::vec2 height_range{1, 8};     ///< metres above the terrain (or above y = 0 without one)
    glm::vec2 size_range{0.2f, 0.5f}; ///< radius of a spark, metres
    std::vector<glm::vec3> colors{glm::vec3(1)};
};
/// Small lights of a far-away town, one sphere each, tinted. Slot "light". `terrain` may be null.
MadeParts make_sparks(const Terrain* terrain, const SparkOptions& options);

struct TwigOptions {
    std::uint32_t seed = 1;
    int count = 7;                         ///< stems
    float height = 0.4f;                   ///< metres that the longest reaches
    float spread = 0.35f;                  ///< how far the tips lean out, as a share of the height
    float thickness = 0.0012f;             ///< radius of a stem at its foot, metres
    glm::vec2 bud_range{0.0025f, 0.0045f}; ///< radius of the buds, metres
};
/// Dry branching stems from one foot at the origin, as in a vase. Slots "stem" and "bud".
MadeParts make_twigs(const TwigOptions& options);

struct LightStringOptions {
    std::uint32_t seed = 1;
    double spacing = 0.1; ///< metres of the path from light to light
    float size = 0.006f;  ///< radius of a light, metres
    float wire = 0.001f;  ///< radius of the wire, metres
    std::vector<glm::vec3> colors{glm::vec3(1)};
};
/// Small lights on a wire that hangs along a path. Slots "wire" and "light".
MadeParts make_light_string(const Path& path, const LightStringOptions& options);

/// A car 4.4 m long that looks along -z, wheels on y = 0.
/// Slots "paint", "glass", "tyre", "rim", "trim", "head_lamp", "tail_lamp", "indicator", "plate".
MadeParts make_car();

} // namespace postfx::host
