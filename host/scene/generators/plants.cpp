// Trees and grass, low in triangles and high in outline: at night the outline is what is seen.
#include "../generators.hpp"
#include "../random.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

namespace postfx::host {
namespace {

constexpr float two_pi = 2 * std::numbers::pi_v<float>;
constexpr double cell_size = 40; ///< metres of ground whose plants are one part

glm::vec3 varied(Random& random, float spread) {
    return glm::vec3(1)
           + spread * glm::vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
}

/// One whorl of drooping branches: a star-shaped skirt around the trunk.
void add_whorl(Mesh& mesh, Random& random, float y, float radius, float rise, glm::vec3 tint) {
    constexpr int branches = 9;
    const float turn = random.between(0, two_pi);
    const auto apex = mesh.add({{0, y + rise, 0}, {0, 1, 0}, {0, 0}, tint * 0.7f});
    for (int i = 0; i < 2 * branches; ++i) {
        const float angle =
            turn + two_pi * (static_cast<float>(i) + random.between(-0.25f, 0.25f)) / (2 * branches);
        const bool tip = i % 2 == 0;
        const float reach = radius * (tip ? random.between(0.8f, 1.12f) : random.between(0.42f, 0.6f));
        const float droop = y + (tip ? random.between(-0.1f, 0.06f) : random.between(0.12f, 0.22f)) * radius;
        mesh.add({{reach * std::cos(angle), droop, -reach * std::sin(angle)},
                  {0, 1, 0},
                  {0, 0},
                  tint * (tip ? 1.15f : 0.6f)});
    }
    for (std::uint32_t i = 0; i < 2 * branches; ++i) {
        mesh.triangle(apex, apex + 1 + i, apex + 1 + (i + 1) % (2 * branches));
    }
}

MadeParts conifer(Random& random, float height) {
    Mesh trunk = cone(0.028f * height, 0.9f * height, 6);
    Mesh needles;
    const glm::vec3 tint = varied(random, 0.2f);
    const float foot = random.between(0.08f, 0.2f), girth = random.between(0.19f, 0.27f);
    const int whorls = std::clamp(static_cast<int>(height * 0.75f), 5, 11);
    for (int i = 0; i < whorls; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(whorls);
        const float radius = height * girth * std::pow(1 - t, 0.85f) + 0.03f * height;
        const float y = height * (foot + (0.97f - foot) * t);
        add_whorl(needles, random, y, radius, height * (0.95f - foot) / static_cast<float>(whorls) * 1.6f,
                  tint);
    }
    compute_normals(needles);
    return {{"trunk", std::move(trunk)}, {"needles", std::move(needles)}};
}

/// A ball pushed in and out by noise, in one skin so that its light is smooth.
Mesh crown(Random& random, float radius) {
    constexpr int around = 14, up = 8;
    const auto seed = random.next();
    Mesh mesh;
    for (int row = 0; row <= up; ++row) {
        const float polar = std::numbers::pi_v<float> * (static_cast<float>(row) / up - 0.5f);
        for (int column = 0; column < around; ++column) {
            const float angle =
                two_pi * (static_cast<float>(column) + 0.5f * static_cast<float>(row % 2)) / around;
            const glm::vec3 p(std::cos(polar) * std::cos(angle), std::sin(polar),
                              -std::cos(polar) * std::sin(angle));
            // Slices of plane noise: continuous over the sphere.
            const auto bump = [&](float scale, std::uint32_t octave) {
                return lattice_noise(scale * (p.x + 1.3f * p.y), scale * p.z, seed + octave)
                       + lattice_noise(scale * (p.y - p.x), scale * (p.z + 1.1f * p.y), seed + octave + 1);
            };
            const auto swell = static_cast<float>(0.19 * bump(1.9f, 0) + 0.13 * bump(5.3f, 2));
            mesh.add({radius * p * (1 + swell), p, {0, 0}, glm::vec3(0.7f + 0.3f * p.y + 1.4f * swell)});
        }
    }
    for (std::uint32_t row = 0; row < up; ++row) {
        for (std::uint32_t column = 0; column < around; ++column) {
            const std::uint32_t a = row * around + column, b = row * around + (column + 1) % around;
            mesh.quad(a, b, b + around, a + around);
        }
    }
    compute_normals(mesh);
    for (Vertex& vertex : mesh.vertices)
        vertex.tint = glm::max(vertex.tint, glm::vec3(0.25f));
    return mesh;
}

MadeParts broadleaf(Random& random, float height) {
    Mesh trunk = cylinder(0.024f * height, 0.6f * height, 6);
    Mesh leaves;
    const glm::vec3 tint = varied(random, 0.25f);
    const int crowns = 6 + static_cast<int>(random.unit() * 3);
    for (int i = 0; i < crowns; ++i) {
        const float angle = two_pi * (static_cast<float>(i) + random.unit()) / static_cast<float>(crowns);
        const float away = i == 0 ? 0 : height * random.between(0.1f, 0.2f);
        const float y = height * (i == 0 ? 0.78f : random.between(0.48f, 0.74f));
        const glm::vec3 at(away * std::cos(angle), y, away * std::sin(angle));
        if (i > 0) { // a branch that carries it
            const glm::vec3 foot(0, 0.36f * height, 0);
            const glm::vec3 up = glm::normalize(at - foot);
            const glm::vec3 right = glm::normalize(glm::cross(up, glm::vec3(0.3f, 0.1f, 0.9f)));
            const glm::mat4 place(glm::vec4(right, 0), glm::vec4(up, 0), glm::vec4(glm::cross(right, up), 0),
                                  glm::vec4(foot, 1));
            trunk.append(cone(0.012f * height, glm::length(at - foot), 5), place);
        }
        leaves.append(crown(random, height * random.between(0.13f, 0.21f)), glm::translate(glm::mat4(1), at),
                      tint);
    }
    return {{"trunk", std::move(trunk)}, {"leaves", std::move(leaves)}};
}

/// Parts by ground cell and slot, so that what is out of view is not drawn.
class Cells {
public:
    Mesh& at(const glm::dvec3& place, const std::string& slot) {
        const auto cell = [](double x) { return static_cast<int>(std::floor(x / cell_size)); };
        return meshes_[{cell(place.x), cell(place.z), slot}];
    }
    MadeParts take() {
        MadeParts parts;
        for (auto& [key, mesh] : meshes_)
            parts.push_back({std::get<2>(key), std::move(mesh)});
        return parts;
    }

private:
    std::map<std::tuple<int, int, std::string>, Mesh> meshes_;
};

/// A random place beside the path, on the ground; `evenness` 1 spreads evenly up to clearance + depth, larger
/// values crowd near the path. Nothing when it came too near another stretch of the path.
std::optional<glm::dvec3> place_beside(Random& random, const Terrain& terrain, const Path& path,
                                       double clearance, double depth, double evenness) {
    const double along = random.unit() * path.length();
    const double away = clearance + depth * std::pow(static_cast<double>(random.unit()), evenness);
    const double side = random.unit() < 0.5f ? -away : away;
    const glm::dvec3 place(path.frame(along) * glm::dvec4(side, 0, 0, 1));
    const double half = terrain.shape().size / 2;
    if (std::abs(place.x) > half || std::abs(place.z) > half) return std::nullopt;
    if (path.nearest(place.x, place.z).distance < clearance) return std::nullopt;
    return glm::dvec3(place.x, terrain.height(place.x, place.z), place.z);
}

} // namespace

MadeParts make_tree(const TreeOptions& options) {
    Random random(options.seed);
    return options.kind == "broadleaf" ? broadleaf(random, options.height) : conifer(random, options.height);
}

MadeParts make_forest(const Terrain& terrain, const Path& path, const ForestOptions& options) {
    // A few individuals, planted many times with other sizes, turns and tints.
    constexpr std::uint32_t individuals = 12;
    constexpr float model_height = 10;
    std::vector<MadeParts> conifers, broadleaves;
    for (std::uint32_t i = 0; i < individuals; ++i) {
        conifers.push_back(make_tree({options.seed * 131 + i, "conifer", model_height}));
        broadleaves.push_back(make_tree({options.seed * 137 + i, "broadleaf", model_height}));
    }
    Random random(options.seed);
    Cells cells;
    for (int i = 0; i < options.count; ++i) {
        const auto place = place_beside(random, terrain, path, options.clearance, options.depth, 1.7);
        const bool is_conifer = random.unit() < options.conifers;
        const auto individual = static_cast<std::size_t>(random.unit() * individuals);
        const float scale = random.between(options.height_range) / model_height;
        const float turn = random.between(0, two_pi);
        const glm::vec3 tint = varied(random, 0.18f) * random.between(0.75f, 1.2f);
        if (!place) continue;
        glm::mat4 matrix = glm::translate(glm::mat4(1), glm::vec3(*place) - glm::vec3(0, 0.1f, 0));
        matrix = glm::scale(glm::rotate(matrix, turn, {0, 1, 0}), glm::vec3(scale));
        for (const MadePart& part : (is_conifer ? conifers : broadleaves)[individual]) {
            cells.at(*place, part.slot).append(part.mesh, matrix, tint);
        }
    }
    return cells.take();
}

MadeParts make_grass(const Terrain& terrain, const Path& path, const GrassOptions& options) {
    Random random(options.seed);
    Cells cells;
    constexpr int blades = 5;
    for (int i = 0; i < options.count; ++i) {
        const auto place = place_beside(random, terrain, path, options.clearance, options.depth, 1.3);
        if (!place) continue;
        Mesh tuft;
        const glm::vec3 foot(*place);
        const float height = random.between(options.height_range);
        const glm::vec3 tint = varied(random, 0.2f) * random.between(0.7f, 1.3f);
        for (int blade = 0; blade < blades; ++blade) {
            const float angle = random.between(0, two_pi);
            const glm::vec3 out(std::cos(angle), 0, std::sin(angle));
            const glm::vec3 across(-out.z, 0, out.x);
            const glm::vec3 root = foot + out * random.between(0, 0.25f * height);
            const glm::vec3 tip = root + out * height * random.between(0.2f, 0.7f) + glm::vec3(0, height, 0);
            const float half = 0.05f * height + 0.006f;
            // Lit like the ground under it: blade normals of their own would sparkle.
            const glm::vec3 normal = glm::normalize(glm::vec3(0, 1, 0) + 0.35f * out);
            const auto a = tuft.add({root - half * across, normal, {0, 0}, tint * 0.5f});
            const auto b = tuft.add({root + half * across, normal, {1, 0}, tint * 0.5f});
            const auto c = tuft.add({tip, normal, {0.5f, 1}, tint});
            tuft.triangle(a, b, c);
        }
        cells.at(*place, "grass").append(tuft, glm::mat4(1));
    }
    return cells.take();
}

} // namespace postfx::host
