#include "geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace postfx::host {
namespace {

constexpr float two_pi = 2 * std::numbers::pi_v<float>;

/// A point of a profile that is turned around the y axis.
struct ProfilePoint {
    float radius, y;
    glm::vec2 normal; ///< outward: away from the axis, up
    float v;
};

/// Turn pairs of profile points (bottom to top, each pair one smooth band) around the y axis.
void revolve(Mesh& mesh, const std::vector<ProfilePoint>& profile, int segments) {
    for (std::size_t band = 0; band + 1 < profile.size(); band += 2) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int i = 0; i <= segments; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(segments);
            const glm::vec2 around(std::cos(two_pi * u), -std::sin(two_pi * u));
            for (std::size_t k = band; k < band + 2; ++k) {
                const ProfilePoint& p = profile[k];
                mesh.add({{p.radius * around.x, p.y, p.radius * around.y},
                          glm::normalize(glm::vec3(p.normal.x * around.x, p.normal.y, p.normal.x * around.y)),
                          {u, p.v}});
            }
        }
        for (int i = 0; i < segments; ++i) {
            const std::uint32_t at = first + 2 * static_cast<std::uint32_t>(i);
            if (profile[band].radius > 0) mesh.triangle(at, at + 2, at + 3);
            if (profile[band + 1].radius > 0) mesh.triangle(at, at + 3, at + 1);
        }
    }
}

/// Three more points on the Catmull-Rom spline between each pair; runs end where a point is repeated.
std::vector<glm::vec2> smoothed(const std::vector<glm::vec2>& points) {
    constexpr int pieces = 4;
    std::vector<glm::vec2> result;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const glm::vec2 b = points[i], c = points[i + 1];
        result.push_back(b);
        if (b == c) continue;
        const glm::vec2 a = i > 0 && points[i - 1] != b ? points[i - 1] : 2.0f * b - c;
        const glm::vec2 d = i + 2 < points.size() && points[i + 2] != c ? points[i + 2] : 2.0f * c - b;
        for (int k = 1; k < pieces; ++k) {
            const float t = static_cast<float>(k) / pieces;
            const glm::vec2 point =
                b
                + 0.5f * t
                      * (c - a + t * (2.0f * a - 5.0f * b + 4.0f * c - d + t * (3.0f * (b - c) + d - a)));
            result.emplace_back(std::max(point.x, 0.0f), point.y);
        }
    }
    result.push_back(points.back());
    return result;
}

} // namespace

void Bounds::add(glm::dvec3 point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
}

void Bounds::add(const Bounds& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
}

Bounds Bounds::transformed(const glm::dmat4& matrix) const {
    Bounds result;
    if (empty()) return result;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                               corner & 4 ? high.z : low.z);
        result.add(glm::dvec3(matrix * glm::dvec4(point, 1)));
    }
    return result;
}

std::uint32_t Mesh::add(const Vertex& vertex) {
    vertices.push_back(vertex);
    return static_cast<std::uint32_t>(vertices.size() - 1);
}

void Mesh::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    indices.insert(indices.end(), {a, b, c});
}

void Mesh::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    indices.insert(indices.end(), {a, b, c, a, c, d});
}

void Mesh::face(const std::vector<glm::vec3>& corners, glm::vec3 tint) {
    // Newell's sum: right for any flat polygon, and an average for one that is slightly bent.
    glm::vec3 normal(0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normal += glm::cross(corners[i], corners[(i + 1) % corners.size()]);
    }
    normal = glm::dot(normal, normal) > 0 ? glm::normalize(normal) : glm::vec3(0, 1, 0);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        add({corners[i], normal, {i == 1 || i == 2 ? 1.0f : 0.0f, i >= 2 ? 1.0f : 0.0f}, tint});
        if (i >= 2)
            triangle(first, first + static_cast<std::uint32_t>(i) - 1, first + static_cast<std::uint32_t>(i));
    }
}

void Mesh::append(const Mesh& other, const glm::mat4& placement, glm::vec3 tint) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const glm::mat3 normals = glm::transpose(glm::inverse(glm::mat3(placement)));
    for (const Vertex& vertex : other.vertices) {
        vertices.push_back({glm::vec3(placement * glm::vec4(vertex.position, 1)),
                            glm::normalize(normals * vertex.normal), vertex.uv, vertex.tint * tint});
    }
    const bool mirrored = glm::determinant(glm::mat3(placement)) < 0;
    for (std::size_t i = 0; i + 2 < other.indices.size(); i += 3) {
        const std::uint32_t a = first + other.indices[i], b = first + other.indices[i + 1],
                            c = first + other.indices[i + 2];
        mirrored ? triangle(a, c, b) : triangle(a, b, c);
    }
}

Bounds Mesh::bounds() const {
    Bounds result;
    for (const Vertex& vertex : vertices)
        result.add(glm::dvec3(vertex.position));
    return result;
}

void compute_normals(Mesh& mesh) {
    for (Vertex& vertex : mesh.vertices)
        vertex.normal = glm::vec3(0);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        Vertex& a = mesh.vertices[mesh.indices[i]];
        Vertex& b = mesh.vertices[mesh.indices[i + 1]];
        Vertex& c = mesh.vertices[mesh.indices[i + 2]];
        const glm::vec3 area = glm::cross(b.position - a.position, c.position - a.position);
        a.normal += area;
        b.normal += area;
        c.normal += area;
    }
    for (Vertex& vertex : mesh.vertices) {
        const float length = glm::length(vertex.normal);
        vertex.normal = length > 0 ? vertex.normal / length : glm::vec3(0, 1, 0);
    }
}

Mesh box(glm::vec3 size) {
    const glm::vec3 h = 0.5f * size;
    Mesh mesh;
    mesh.face({{-h.x, -h.y, h.z}, {h.x, -h.y, h.z}, {h.x, h.y, h.z}, {-h.x, h.y, h.z}});
    mesh.face({{h.x, -h.y, -h.z}, {-h.x, -h.y, -h.z}, {-h.x, h.y, -h.z}, {h.x, h.y, -h.z}});
    mesh.face({{h.x, -h.y, h.z}, {h.x, -h.y, -h.z}, {h.x, h.y, -h.z}, {h.x, h.y, h.z}});
    mesh.face({{-h.x, -h.y, -h.z}, {-h.x, -h.y, h.z}, {-h.x, h.y, h.z}, {-h.x, h.y, -h.z}});
    mesh.face({{-h.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, -h.z}, {-h.x, h.y, -h.z}});
    mesh.face({{-h.x, -h.y, -h.z}, {h.x, -h.y, -h.z}, {h.x, -h.y, h.z}, {-h.x, -h.y, h.z}});
    return mesh;
}

Mesh sphere(float radius, int segments) {
    const int rings = segments / 2 < 2 ? 2 : segments / 2;
    std::vector<ProfilePoint> profile;
    const auto point = [&](int ring) {
        const float v = static_cast<float>(ring) / static_cast<float>(rings);
        const float angle = (v - 0.5f) * std::numbers::pi_v<float>;
        const glm::vec2 normal(std::cos(angle), std::sin(angle));
        const bool pole = ring == 0 || ring == rings;
        return ProfilePoint{pole ? 0 : radius * normal.x, radius * normal.y,
                            pole ? glm::vec2(0, normal.y) : normal, v};
    };
    for (int ring = 0; ring < rings; ++ring) {
        profile.push_back(point(ring));
        profile.push_back(point(ring + 1));
    }
    Mesh mesh;
    revolve(mesh, profile, segments);
    return mesh;
}

Mesh plane(glm::vec2 size, int divisions) {
    Mesh mesh;
    for (int row = 0; row <= divisions; ++row) {
        for (int column = 0; column <= divisions; ++column) {
            const glm::vec2 uv = glm::vec2(column, row) / static_cast<float>(divisions);
            mesh.add({{size.x * (uv.x - 0.5f), 0, size.y * (0.5f - uv.y)}, {0, 1, 0}, uv});
        }
    }
    const auto stride = static_cast<std::uint32_t>(divisions) + 1;
    for (std::uint32_t row = 0; row + 1 < stride; ++row) {
        for (std::uint32_t column = 0; column + 1 < stride; ++column) {
            const std::uint32_t at = row * stride + column;
            mesh.quad(at, at + 1, at + stride + 1, at + stride);
        }
    }
    return mesh;
}

Mesh cylinder(float radius, float height, int segments) {
    Mesh mesh;
    revolve(mesh,
            {{0, 0, {0, -1}, 0},
             {radius, 0, {0, -1}, 0},
             {radius, 0, {1, 0}, 0},
             {radius, height, {1, 0}, 1},
             {radius, height, {0, 1}, 1},
             {0, height, {0, 1}, 1}},
            segments);
    return mesh;
}

Mesh cone(float radius, float height, int segments) {
    Mesh mesh;
    const glm::vec2 slope(height, radius);
    revolve(mesh, {{0, 0, {0, -1}, 0}, {radius, 0, {0, -1}, 0}, {radius, 0, slope, 0}, {0, height, slope, 1}},
            segments);
    return mesh;
}

Mesh torus(float radius, float tube, int segments) {
    std::vector<ProfilePoint> profile;
    const int around = segments / 2 < 3 ? 3 : segments / 2;
    const auto point = [&](int i) {
        const float v = static_cast<float>(i) / static_cast<float>(around);
        const glm::vec2 normal(std::cos(two_pi * v), std::sin(two_pi * v));
        return ProfilePoint{radius + tube * normal.x, tube * normal.y, normal, v};
    };
    for (int i = 0; i < around; ++i) {
        profile.push_back(point(i));
        profile.push_back(point(i + 1));
    }
    Mesh mesh;
    revolve(mesh, profile, segments);
    return mesh;
}

Mesh lathe(const std::vector<glm::vec2>& points, int segments) {
    const std::vector<glm::vec2> profile = smoothed(points);
    const std::size_t count = profile.size();
    // Right of the way up is outside.
    const auto outward = [&](std::size_t from) {
        const glm::vec2 way = profile[from + 1] - profile[from];
        const float length = glm::length(way);
        return length > 0 ? glm::vec2(way.y, -way.x) / length : glm::vec2(0);
    };
    const auto point = [&](std::size_t i, glm::vec2 band_normal, glm::vec2 other_normal) {
        const glm::vec2 normal =
            glm::length(band_normal + other_normal) > 1e-3f ? band_normal + other_normal : band_normal;
        return ProfilePoint{profile[i].x, profile[i].y, normal,
                            static_cast<float>(i) / static_cast<float>(count - 1)};
    };
    std::vector<ProfilePoint> bands;
    for (std::size_t i = 0; i + 1 < count; ++i) {
        const glm::vec2 normal = outward(i);
        if (normal == glm::vec2(0)) continue;
        bands.push_back(point(i, normal, i > 0 ? outward(i - 1) : glm::vec2(0)));
        bands.push_back(point(i + 1, normal, i + 2 < count ? outward(i + 1) : glm::vec2(0)));
    }
    Mesh mesh;
    revolve(mesh, bands, segments);
    return mesh;
}

Mesh rod(const std::vector<glm::vec3>& points, float first_radius, float last_radius, int segments) {
    Mesh mesh;
    const auto count = static_cast<std::uint32_t>(segments);
    const auto last = static_cast<std::uint32_t>(points.size()) - 1;
    const auto along = [&](std::uint32_t i) {
        return glm::normalize(points[std::min(i + 1, last)] - points[i > 0 ? i - 1 : 0]);
    };
    const glm::vec3 start = along(0);
    glm::vec3 side = std::abs(start.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    for (std::uint32_t i = 0; i <= last; ++i) {
        const glm::vec3 forward = along(i);
        side = glm::normalize(side
                              - glm::dot(side, forward) * forward); // turns with the rod without twisting it
        const glm::vec3 other = glm::cross(forward, side);
        const float t = static_cast<float>(i) / static_cast<float>(last);
        for (std::uint32_t k = 0; k < count; ++k) {
            const float angle = two_pi * static_cast<float>(k) / static_cast<float>(segments);
            const glm::vec3 normal = std::cos(angle) * side + std::sin(angle) * other;
            mesh.add({points[i] + glm::mix(first_radius, last_radius, t) * normal,
                      normal,
                      {static_cast<float>(k) / static_cast<float>(segments), t}});
        }
    }
    for (std::uint32_t i = 0; i < last; ++i) {
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::uint32_t a = i * count + k, b = i * count + (k + 1) % count;
            mesh.quad(a, b, b + count, a + count);
        }
    }
    std::vector<glm::vec3> begin, end;
    for (std::uint32_t k = 0; k < count; ++k) {
        begin.push_back(mesh.vertices[count - 1 - k].position);
        end.push_back(mesh.vertices[last * count + k].position);
    }
    mesh.face(begin);
    mesh.face(end);
    return mesh;
}

Mesh loft(const std::vector<Section>& sections, int segments, float roundness) {
    Mesh mesh;
    const auto rounded = [&](float x) { return std::copysign(std::pow(std::abs(x), 2 / roundness), x); };
    const auto count = static_cast<std::uint32_t>(segments);
    for (const Section& section : sections) {
        for (int i = 0; i < segments; ++i) {
            const float angle = two_pi * (static_cast<float>(i) + 0.5f) / static_cast<float>(segments);
            const float up = 0.5f + 0.5f * rounded(std::sin(angle));
            const float half_width = glm::mix(section.half_width_bottom, section.half_width_top, up);
            mesh.add({{half_width * rounded(std::cos(angle)), glm::mix(section.bottom, section.top, up),
                       section.z}});
        }
    }
    for (std::uint32_t ring = 0; ring + 1 < sections.size(); ++ring) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t a = ring * count + i, b = ring * count + (i + 1) % count;
            mesh.quad(a, b, b + count, a + count);
        }
    }
    compute_normals(mesh);
    // Caps with vertices of their own, so that their edges stay sharp.
    std::vector<glm::vec3> back, front;
    for (std::uint32_t i = 0; i < count; ++i) {
        back.push_back(mesh.vertices[count - 1 - i].position);
        front.push_back(
            mesh.vertices[(static_cast<std::uint32_t>(sections.size()) - 1) * count + i].position);
    }
    mesh.face(back);
    mesh.face(front);
    return mesh;
}

} // namespace postfx::host
