#include "read_parts.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <cmath>

namespace postfx::host {
namespace {

constexpr double high_light = 1e6; ///< brightest radiance that a file may name

PicturePtr read_picture(const YamlMap& map, const std::string& key, bool srgb) {
    const auto name = map.find(key);
    if (!name) return nullptr;
    return load_picture(name->named_file("a texture"), srgb);
}

glm::dvec3 unit(const YamlValue& value) {
    const glm::dvec3 direction = value.vector(any_length);
    if (glm::length(direction) < 1e-9) value.fail("expected a direction, found [0, 0, 0]");
    return glm::normalize(direction);
}

Animation::Turn read_turn(const YamlValue& value, const std::string& what, bool has_center) {
    std::vector<std::string> keys{"axis", "degrees_per_second"};
    if (has_center) keys.emplace_back("center");
    const YamlMap map(value, what, keys);
    Animation::Turn turn;
    map.read("center", turn.center, any_length);
    if (const auto axis = map.find("axis")) turn.axis = unit(*axis);
    turn.degrees_per_second = map.at("degrees_per_second").number(degrees);
    return turn;
}

} // namespace

std::size_t find_named(const YamlValue& name, const std::map<std::string, std::size_t>& names,
                       const std::string& what) {
    const std::string wanted = name.text();
    if (const auto found = names.find(wanted); found != names.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [known_name, index] : names)
        known.push_back(known_name);
    name.fail(fmt::format("there is no {} \"{}\"{}", what, wanted, did_you_mean(wanted, known)));
}

Material read_material(const std::string& name, const YamlValue& value) {
    const YamlMap map(value, "material",
                      {"diffuse", "specular", "shininess", "emission", "opacity", "two_sided", "alpha_cutoff",
                       "diffuse_texture", "normal_texture", "emission_texture", "metal_roughness_texture"});
    Material material;
    material.name = name;
    map.read_color("diffuse", material.diffuse, 1);
    map.read_color("specular", material.specular, 1);
    map.read("shininess", material.shininess, {1, 10000});
    map.read_color("emission", material.emission, high_light);
    map.read("opacity", material.opacity, share);
    map.read("two_sided", material.two_sided);
    map.read("alpha_cutoff", material.alpha_cutoff, share);
    material.blended = material.opacity < 1;
    material.diffuse_texture = read_picture(map, "diffuse_texture", true);
    material.normal_texture = read_picture(map, "normal_texture", false);
    material.emission_texture = read_picture(map, "emission_texture", true);
    material.metal_roughness_texture = read_picture(map, "metal_roughness_texture", false);
    material.metal_rough = bool(material.metal_roughness_texture);
    return material;
}

Terrain read_terrain(const YamlValue& value) {
    const YamlMap map(value, "terrain",
                      {"size", "resolution", "seed", "height", "feature_size", "hill_height", "hill_radius",
                       "verge", "blend"});
    TerrainShape shape;
    map.read("size", shape.size, {1, 1e5});
    map.read("resolution", shape.resolution, {0.1, 1e4});
    map.read("seed", shape.seed);
    map.read("height", shape.height, from_zero);
    map.read("feature_size", shape.feature_size, {0.1, 1e6});
    map.read("hill_height", shape.hill_height, any_length);
    map.read("hill_radius", shape.hill_radius, {0.1, 1e6});
    map.read("verge", shape.verge, from_zero);
    map.read("blend", shape.blend, {0.1, 1e6});
    if (shape.size / shape.resolution > 1000) {
        value.fail(fmt::format("size / resolution is {:.0f} points a side, expected at most 1000",
                               shape.size / shape.resolution));
    }
    return Terrain(shape);
}

Path read_path(const YamlValue& value, const std::optional<Terrain>& terrain) {
    const YamlMap map(value, "path", {"closed", "on_terrain", "points"});
    bool closed = false, on_terrain = false;
    map.read("closed", closed);
    map.read("on_terrain", on_terrain);
    if (on_terrain && !terrain) map.at("on_terrain").fail("the scene has no \"terrain\"");
    const YamlValue list = map.at("points");
    std::vector<glm::dvec3> points;
    for (const YamlValue& item : list.list()) {
        if (on_terrain) {
            const glm::dvec2 xz = item.pair(any_length);
            points.emplace_back(xz.x, terrain->natural_height(xz.x, xz.y), xz.y);
        } else {
            points.push_back(item.vector(any_length));
        }
        if (points.size() > 1 && glm::length(points.back() - points[points.size() - 2]) < 1e-6) {
            item.fail("this point is the one before it");
        }
    }
    const std::size_t least = closed ? 3 : 2;
    if (points.size() < least || points.size() > 10000) {
        list.fail(fmt::format("expected {} to 10000 points, found {}", least, points.size()));
    }
    return Path(points, closed);
}

Surroundings read_surroundings(const std::optional<YamlValue>& background,
                               const std::optional<YamlValue>& ambient) {
    Surroundings result;
    if (background && !background->is_map()) {
        result.zenith = result.horizon = result.ground = background->color(high_light);
    } else if (background) {
        const YamlMap map(*background, "background", {"zenith", "horizon", "ground", "stars", "disc"});
        map.read_color("zenith", result.zenith, high_light);
        map.read_color("horizon", result.horizon, high_light);
        result.ground = result.horizon;
        map.read_color("ground", result.ground, high_light);
        map.read("stars", result.stars, {0, high_light});
        if (const auto value = map.find("disc")) {
            const YamlMap disc_map(*value, "disc", {"direction", "angular_radius", "color", "halo"});
            Surroundings::Disc disc;
            disc.direction = glm::vec3(unit(disc_map.at("direction")));
            disc_map.read("angular_radius", disc.angular_radius, {0.01, 30});
            disc_map.read_color("color", disc.color, high_light);
            disc_map.read("halo", disc.halo, share);
            result.disc = disc;
        }
    }
    if (ambient && !ambient->is_map()) {
        result.ambient_up = result.ambient_down = ambient->color(high_light);
    } else if (ambient) {
        const YamlMap map(*ambient, "ambient", {"above", "below"});
        result.ambient_up = map.at("above").color(high_light);
        result.ambient_down = map.at("below").color(high_light);
    }
    return result;
}

Light read_light(const YamlValue& value) {
    const auto entries = value.entries();
    if (entries.size() != 1) value.fail("expected one light, as in \"point: {color: [1, 1, 1]}\"");
    const std::string kind = entries.front().first.choice({"directional", "point", "spot"});
    std::vector<std::string> keys{"color", "intensity"};
    Light light;
    if (kind == "directional") {
        light.kind = Light::Kind::directional;
        keys.insert(keys.end(), {"shadow", "shadow_softness", "shadow_extent"});
    } else {
        light.kind = kind == "spot" ? Light::Kind::spot : Light::Kind::point;
        keys.emplace_back("attenuation");
        light.attenuation = {1, 0, 1};
        if (kind == "spot")
            keys.insert(keys.end(), {"inner_angle", "outer_angle", "shadow", "shadow_softness"});
    }
    const YamlMap map(entries.front().second, kind + " light", keys);
    float intensity = 1;
    map.read_color("color", light.color, high_light);
    map.read("intensity", intensity, {0, high_light});
    light.color *= intensity;
    map.read("attenuation", light.attenuation, from_zero);
    if (light.attenuation == glm::vec3(0))
        map.at("attenuation").fail("expected [x, y, z] of which one is above 0");
    map.read("outer_angle", light.outer_angle, {0.1, 90});
    light.inner_angle = std::min(light.inner_angle, 0.7f * light.outer_angle);
    map.read("inner_angle", light.inner_angle, {0, 90});
    if (light.inner_angle > light.outer_angle) {
        map.at("inner_angle").fail("the inner angle is larger than the outer one");
    }
    map.read("shadow", light.casts_shadow);
    map.read("shadow_softness", light.shadow_softness, {0.5, 20});
    map.read("shadow_extent", light.shadow_extent, {0.1, 1e5});
    return light;
}

Animation read_animation(const YamlValue& value, const Library& library) {
    const YamlMap map(value, "animate", {"rotate", "orbit", "follow"});
    Animation animation;
    if (const auto rotate = map.find("rotate")) animation.rotate = read_turn(*rotate, "rotate", false);
    if (const auto orbit = map.find("orbit")) animation.orbit = read_turn(*orbit, "orbit", true);
    if (const auto follow_value = map.find("follow")) {
        const YamlMap follow_map(*follow_value, "follow", {"path", "speed", "start", "side", "height"});
        Animation::Follow follow;
        follow.path = find_named(follow_map.at("path"), library.paths, "path");
        follow_map.read("speed", follow.speed, any_length);
        follow_map.read("start", follow.start, any_length);
        follow_map.read("side", follow.side, any_length);
        follow_map.read("height", follow.height, any_length);
        animation.follow = follow;
    }
    return animation;
}

} // namespace postfx::host
