#include "mesh_checks.hpp"

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

/// Beyond it squares of float32 are infinite.
constexpr float largest_coordinate = 1e18f;

bool is_usable(glm::vec3 v) {
    return std::abs(v.x) < largest_coordinate && std::abs(v.y) < largest_coordinate
           && std::abs(v.z) < largest_coordinate; // NaN is not below
}

/// Not even a shape may move it to where there is no place.
bool is_usable(const Mesh& mesh, std::size_t vertex) {
    if (!is_usable(mesh.vertices[vertex].position)) return false;
    if (!mesh.deformation) return true;
    const auto& shapes = mesh.deformation->shapes;
    return std::all_of(shapes.begin(), shapes.end(),
                       [&](const auto& shape) { return is_usable(shape.positions[vertex]); });
}

void repair(Vertex& vertex) {
    const float length = glm::length(vertex.normal);
    vertex.normal = length > 0 && std::isfinite(length) ? vertex.normal / length : glm::vec3(0, 1, 0);
    if (!std::isfinite(vertex.uv.x + vertex.uv.y)) vertex.uv = glm::vec2(0);
    if (!is_usable(vertex.tint)) vertex.tint = glm::vec3(1);
}

template<class T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& from, std::size_t width = 1) {
    if (values.empty()) return;
    std::vector<T> result;
    result.reserve(from.size() * width);
    for (const std::uint32_t index : from) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(index * width);
        result.insert(result.end(), first, first + static_cast<std::ptrdiff_t>(width));
    }
    values = std::move(result);
}

} // namespace

void drop_broken_triangles(Mesh& mesh, const std::string& what, Losses& losses) {
    static const LossKind not_finite{"triangle is left out, for a vertex of it is not finite",
                                     "triangles are left out, for vertices of theirs are not finite"};
    static const LossKind not_there{"triangle is left out, for a vertex of it is not there",
                                    "triangles are left out, for vertices of theirs are not there"};
    std::vector<std::uint32_t> kept;
    std::size_t infinite = 0, absent = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto corners = mesh.indices.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::any_of(corners, corners + 3, [&](std::uint32_t v) { return v >= mesh.vertices.size(); })) {
            ++absent;
        } else if (!std::all_of(corners, corners + 3, [&](std::uint32_t v) { return is_usable(mesh, v); })) {
            ++infinite;
        } else {
            kept.insert(kept.end(), corners, corners + 3);
        }
    }
    losses.add(not_finite, what, infinite);
    losses.add(not_there, what, absent);
    mesh.indices = std::move(kept);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        repair(mesh.vertices[v]);
        // No triangle has it any more, but boxes are made around all vertices.
        if (!is_usable(mesh, v))
            mesh.vertices[v].position =
                mesh.indices.empty() ? glm::vec3(0) : mesh.vertices[mesh.indices[0]].position;
    }
    for (VertexExtra& extra : mesh.extras) {
        if (!std::isfinite(extra.uv.x + extra.uv.y)) extra.uv = glm::vec2(0);
        if (!std::isfinite(extra.opacity)) extra.opacity = 1;
    }
}

void make_flat(Mesh& mesh) {
    gather(mesh.vertices, mesh.indices);
    gather(mesh.extras, mesh.indices);
    if (mesh.deformation) {
        auto deformation = std::make_shared<Deformation>(*mesh.deformation);
        for (Deformation::Shape& shape : deformation->shapes) {
            gather(shape.positions, mesh.indices);
            gather(shape.normals, mesh.indices);
        }
        gather(deformation->joints, mesh.indices, deformation->influences);
        gather(deformation->weights, mesh.indices, deformation->influences);
        mesh.deformation = std::move(deformation);
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        mesh.indices[i] = static_cast<std::uint32_t>(i);
    for (std::size_t i = 0; i + 2 < mesh.vertices.size(); i += 3) {
        const glm::dvec3 a(mesh.vertices[i].position), b(mesh.vertices[i + 1].position),
            c(mesh.vertices[i + 2].position);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double length = glm::length(normal);
        for (std::size_t corner = i; corner < i + 3; ++corner)
            mesh.vertices[corner].normal = length > 0 ? glm::vec3(normal / length) : glm::vec3(0, 1, 0);
    }
}

} // namespace postfx::host
