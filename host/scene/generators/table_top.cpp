// Fine things for a still life: thin stems and strings of lights.
#include "../generators.hpp"
#include "../random.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace postfx::host {
namespace {

constexpr float two_pi = 2 * std::numbers::pi_v<float>;
constexpr int stem_points = 9;

/// From `foot` upwards, bending towards `tip` and wavering a little.
std::vector<glm::vec3> bent(Random& random, glm::vec3 foot, glm::vec3 tip) {
    const float length = glm::length(tip - foot);
    const glm::vec3 waver = 0.05f * length * glm::vec3(random.between(-1, 1), 0, random.between(-1, 1));
    std::vector<glm::vec3> points;
    for (int i = 0; i < stem_points; ++i) {
        const float t = static_cast<float>(i) / (stem_points - 1);
        const glm::vec3 out = glm::vec3(tip.x - foot.x, 0, tip.z - foot.z) * std::pow(t, 1.6f);
        points.emplace_back(foot.x + out.x + waver.x * std::sin(two_pi * t), foot.y + (tip.y - foot.y) * t,
                            foot.z + out.z + waver.z * std::sin(two_pi * t));
    }
    return points;
}

} // namespace

MadeParts make_twigs(const TwigOptions& options) {
    Random random(options.seed);
    Mesh stem, bud;
    const auto add_bud = [&](glm::vec3 at) {
        const glm::mat4 place = glm::scale(glm::translate(glm::mat4(1), at),
                                           random.between(options.bud_range) * glm::vec3(1, 1.3f, 1));
        bud.append(sphere(1, 8), place, glm::vec3(random.between(0.75f, 1.1f)));
    };
    for (int i = 0; i < options.count; ++i) {
        const float angle = two_pi * (static_cast<float>(i) + random.between(-0.3f, 0.3f))
                            / static_cast<float>(options.count);
        const float height = options.height * random.between(0.7f, 1.0f);
        const float lean = height * options.spread * random.between(0.5f, 1.0f);
        const auto points = bent(random, {0, 0, 0}, {lean * std::cos(angle), height, lean * std::sin(angle)});
        stem.append(rod(points, options.thickness, 0.5f * options.thickness, 6), glm::mat4(1));
        add_bud(points.back());
        // Side twigs on the upper half, to both sides in turn.
        for (int k = stem_points / 2; k + 1 < stem_points; ++k) {
            const glm::vec3 foot = points[static_cast<std::size_t>(k)];
            const float way = angle + (k % 2 ? 1.0f : -1.0f) * random.between(0.6f, 1.3f);
            const float length = options.height * random.between(0.08f, 0.16f);
            const glm::vec3 tip =
                foot
                + length
                      * glm::vec3(0.55f * std::cos(way), random.between(0.6f, 1.0f), 0.55f * std::sin(way));
            stem.append(rod(bent(random, foot, tip), 0.6f * options.thickness, 0.35f * options.thickness, 5),
                        glm::mat4(1));
            add_bud(tip);
            add_bud(glm::mix(foot, tip, 0.6f));
        }
    }
    return {{"stem", std::move(stem)}, {"bud", std::move(bud)}};
}

MadeParts make_light_string(const Path& path, const LightStringOptions& options) {
    Random random(options.seed);
    Mesh light;
    std::vector<glm::vec3> points;
    const int steps = std::clamp(static_cast<int>(path.length() / (0.25 * options.spacing)), 2, 4000);
    for (int i = 0; i <= steps - (path.closed() ? 1 : 0); ++i)
        points.emplace_back(path.at(path.length() * i / steps).position);
    if (path.closed()) points.push_back(points.front());
    const Mesh ball = sphere(1, 12);
    for (double along = 0.5 * options.spacing; along < path.length(); along += options.spacing) {
        const glm::vec3 at(path.at(along).position);
        const glm::mat4 place = glm::scale(glm::translate(glm::mat4(1), at - glm::vec3(0, options.size, 0)),
                                           glm::vec3(options.size));
        const auto pick = static_cast<std::size_t>(random.unit() * static_cast<float>(options.colors.size()));
        light.append(ball, place, options.colors[pick] * random.between(0.6f, 1.0f));
    }
    return {{"wire", rod(points, options.wire, options.wire, 5)}, {"light", std::move(light)}};
}

} // namespace postfx::host
