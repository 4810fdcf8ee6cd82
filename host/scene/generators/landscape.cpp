// The ground and what lies on it: terrain, road, posts, far lights.
#include "../generators.hpp"
#include "../random.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

constexpr int cells_per_part = 16;

glm::mat4 stand(const glm::dmat4& frame, double side) {
    return glm::mat4(glm::translate(frame, {side, 0, 0}));
}

/// Call `place` for every post: where it stands, and +1 on the right of the path, -1 on the left.
template<class Place>
void along_path(const Path& path, const PostOptions& options, Place place) {
    const int count = static_cast<int>(path.length() / options.spacing);
    for (int i = 0; i < count; ++i) {
        const glm::dmat4 frame = path.frame(i * options.spacing);
        if (options.side != "left") place(stand(frame, options.offset), 1.0f);
        if (options.side != "right") place(stand(frame, -options.offset), -1.0f);
    }
}

} // namespace

MadeParts make_terrain(const Terrain& terrain) {
    const TerrainShape& shape = terrain.shape();
    const int cells = std::max(1, static_cast<int>(shape.size / shape.resolution));
    const double step = shape.size / cells;
    const auto coordinate = [&](int i) { return -0.5 * shape.size + i * step; };
    // One point more on every side, so that normals need no second evaluation of the landscape.
    const int stride = cells + 3;
    std::vector<float> heights(static_cast<std::size_t>(stride) * static_cast<std::size_t>(stride));
    const auto height = [&](int column, int row) -> float& {
        return heights[static_cast<std::size_t>(row + 1) * static_cast<std::size_t>(stride)
                       + static_cast<std::size_t>(column + 1)];
    };
    for (int row = -1; row <= cells + 1; ++row) {
        for (int column = -1; column <= cells + 1; ++column) {
            height(column, row) = static_cast<float>(terrain.height(coordinate(column), coordinate(row)));
        }
    }
    const auto vertex = [&](int column, int row) {
        const double x = coordinate(column), z = coordinate(row);
        const auto two_steps = static_cast<float>(2 * step);
        const glm::vec3 normal(height(column - 1, row) - height(column + 1, row), two_steps,
                               height(column, row - 1) - height(column, row + 1));
        const auto shade = static_cast<float>(0.5 + 0.5 * lattice_noise(x / 7, z / 7, shape.seed + 77));
        return Vertex{{static_cast<float>(x), height(column, row), static_cast<float>(z)},
                      glm::normalize(normal),
                      {static_cast<float>(x), static_cast<float>(z)},
                      glm::mix(glm::vec3(0.7f, 0.62f, 0.55f), glm::vec3(1.0f, 1.15f, 0.9f), shade)};
    };

    MadeParts parts;
    for (int row0 = 0; row0 < cells; row0 += cells_per_part) {
        for (int column0 = 0; column0 < cells; column0 += cells_per_part) {
            Mesh mesh;
            const int rows = std::min(cells_per_part, cells - row0);
            const int columns = std::min(cells_per_part, cells - column0);
            for (int row = 0; row <= rows; ++row) {
                for (int column = 0; column <= columns; ++column)
                    mesh.add(vertex(column0 + column, row0 + row));
            }
            const auto line = static_cast<std::uint32_t>(columns) + 1;
            for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row) {
                for (std::uint32_t column = 0; column + 1 < line; ++column) {
                    const std::uint32_t at = row * line + column;
                    mesh.quad(at + line, at + line + 1, at + 1, at);
                }
            }
            parts.push_back({"ground", std::move(mesh)});
        }
    }
    return parts;
}

MadeParts make_road(const Path& path, const RoadOptions& options) {
    Mesh asphalt, line;
    // A strip between two distances along the path, from `left` to `right` metres beside its middle.
    const auto strip = [&](Mesh& mesh, double start, double end, double left, double right, double lift) {
        const int pieces = std::max(1, static_cast<int>(std::ceil((end - start) / 1.5)));
        for (int i = 0; i <= pieces; ++i) {
            const double at = start + (end - start) * i / pieces;
            const glm::dmat4 frame = path.frame(at);
            for (const double side : {left, right}) {
                const auto shade = static_cast<float>(1 + 0.18 * lattice_noise(at / 2.3, side, 5));
                mesh.add({glm::vec3(frame * glm::dvec4(side, lift, 0, 1)),
                          glm::vec3(frame[1]),
                          {static_cast<float>(side), static_cast<float>(at)},
                          glm::vec3(shade)});
            }
            if (i == 0) continue;
            const auto last = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.quad(last - 4, last - 3, last - 1, last - 2);
        }
    };
    MadeParts parts;
    const double half = options.width / 2;
    constexpr int columns = 4; // so that light from a lamp varies across the road in vertex noise too
    constexpr double part_length = 60;
    for (double start = 0; start < path.length(); start += part_length) {
        Mesh piece;
        const double end = std::min(start + part_length, path.length());
        for (int column = 0; column < columns; ++column) {
            strip(piece, start, end, half * (2.0 * column / columns - 1),
                  half * (2.0 * (column + 1) / columns - 1), 0);
        }
        parts.push_back({"asphalt", std::move(piece)});
    }
    constexpr double lift =
        0.012; // above the asphalt: a reversed-Z depth buffer tells that apart at any distance
    if (options.dash_length > 0) {
        for (double at = 0; at + options.dash_length < path.length();
             at += options.dash_length + options.dash_gap) {
            strip(line, at, at + options.dash_length, -options.line_width / 2, options.line_width / 2, lift);
        }
        const double edge = half - 0.25;
        strip(line, 0, path.length(), edge - options.line_width, edge, lift);
        strip(line, 0, path.length(), -edge, options.line_width - edge, lift);
        parts.push_back({"line", std::move(line)});
    }
    return parts;
}

MadeParts make_posts(const Path& path, const PostOptions& options) {
    Mesh post, band, reflector;
    const auto h = static_cast<float>(options.height);
    const Mesh body = cylinder(0.055f, h, 8);
    const Mesh ring = cylinder(0.06f, 0.2f * h, 8);
    const Mesh glass = box({0.07f, 0.15f * h, 0.02f});
    along_path(path, options, [&](const glm::mat4& place, float) {
        post.append(body, place);
        band.append(ring, glm::translate(place, {0, 0.68f * h, 0}));
        // Seen by those who come along the path, and those who come back.
        reflector.append(glass, glm::translate(place, {0, 0.78f * h, 0.06f}));
        reflector.append(glass, glm::translate(place, {0, 0.78f * h, -0.06f}));
    });
    return {{"post", std::move(post)}, {"band", std::move(band)}, {"reflector", std::move(reflector)}};
}

MadeParts make_lamp_posts(const Path& path, const PostOptions& options) {
    Mesh pole, lamp;
    const auto h = static_cast<float>(options.height);
    const float arm = 0.28f * h;
    const Mesh upright = cylinder(0.07f, h, 8);
    const Mesh beam = box({arm, 0.07f, 0.07f});
    const Mesh head = box({0.6f, 0.1f, 0.26f});
    const Mesh glass = box({0.5f, 0.04f, 0.2f});
    along_path(path, options, [&](const glm::mat4& place, float side) {
        pole.append(upright, place);
        pole.append(beam, glm::translate(place, {-side * 0.5f * arm, h, 0}));
        pole.append(head, glm::translate(place, {-side * arm, h, 0}));
        lamp.append(glass, glm::translate(place, {-side * arm, h - 0.07f, 0}));
    });
    return {{"pole", std::move(pole)}, {"lamp", std::move(lamp)}};
}

MadeParts make_sparks(const Terrain* terrain, const SparkOptions& options) {
    Random random(options.seed);
    Mesh light;
    const Mesh ball = sphere(1, 10);
    for (int i = 0; i < options.count; ++i) {
        const float angle = random.between(0, 6.2831853f);
        const float distance = static_cast<float>(options.radius) * std::sqrt(random.unit());
        const glm::vec2 at = options.center + distance * glm::vec2(std::cos(angle), std::sin(angle));
        const float ground = terrain ? static_cast<float>(terrain->height(at.x, at.y)) : 0;
        const float y = ground + random.between(options.height_range);
        const float size = random.between(options.size_range);
        const auto pick = static_cast<std::size_t>(random.unit() * static_cast<float>(options.colors.size()));
        const glm::mat4 place = glm::scale(glm::translate(glm::mat4(1), {at.x, y, at.y}), glm::vec3(size));
        light.append(ball, place, options.colors[pick] * random.between(0.5f, 1.0f));
    }
    return {{"light", std::move(light)}};
}

} // namespace postfx::host
