#include "gltf_reader.hpp"
#include "mesh_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace postfx::host {
namespace {

using Json = GltfDocument::Json;

/// A primitive's attributes, compressed or not.
class Attributes {
public:
    Attributes(const GltfDocument& document, const Json& primitive)
        : document_(document), primitive_(primitive) {
        if (!primitive.is_object() || !primitive.contains("attributes")
            || !primitive.at("attributes").is_object())
            document.fail("a primitive has no attributes");
        if (const Json* draco = GltfDocument::extension(primitive, "KHR_draco_mesh_compression"))
            draco_ = read_draco(document, *draco);
    }

    bool has(const std::string& name) const { return primitive_.at("attributes").contains(name); }
    std::size_t width(const std::string& name) const {
        if (const auto found = decompressed(name)) return found->width;
        return accessor_width(document_, accessor(name));
    }
    std::vector<float> numbers(const std::string& name, std::size_t width) const {
        if (const auto found = decompressed(name)) {
            if (found->width != width)
                document_.fail(
                    fmt::format("{} has {} numbers to a vertex, expected {}", name, found->width, width));
            return found->values;
        }
        return read_numbers(document_, accessor(name), width);
    }
    std::vector<std::uint32_t> integers(const std::string& name, std::size_t width) const {
        if (!decompressed(name)) return read_integers(document_, accessor(name), width);
        std::vector<std::uint32_t> result;
        for (const float value : numbers(name, width))
            result.push_back(static_cast<std::uint32_t>(std::max(value, 0.0f)));
        return result;
    }
    /// Of points as they come, without an index list, so many.
    std::vector<std::uint32_t> indices(std::size_t vertices) const {
        if (draco_) return draco_->indices;
        if (const auto list = document_.find_index(primitive_, "indices"))
            return read_integers(document_, *list, 1);
        std::vector<std::uint32_t> result(vertices);
        std::iota(result.begin(), result.end(), 0u);
        return result;
    }

private:
    std::size_t accessor(const std::string& name) const {
        return document_.index(primitive_.at("attributes"), name.c_str());
    }
    const DracoMesh::Attribute* decompressed(const std::string& name) const {
        if (!draco_) return nullptr;
        const auto found = draco_->attributes.find(name);
        return found == draco_->attributes.end() ? nullptr : &found->second;
    }

    const GltfDocument& document_;
    const Json& primitive_;
    std::optional<DracoMesh> draco_;
};

/// Triangles, strips and fans as triangles; nothing of points and lines.
std::vector<std::uint32_t> triangles_of(std::size_t mode, std::vector<std::uint32_t> list) {
    constexpr std::size_t triangles = 4, strip = 5, fan = 6;
    if (mode == triangles) return list;
    std::vector<std::uint32_t> result;
    for (std::size_t i = 0; i + 2 < list.size(); ++i) {
        if (mode == strip) {
            const std::size_t odd = i % 2;
            result.insert(result.end(), {list[i], list[i + 1 + odd], list[i + 2 - odd]});
        } else if (mode == fan) {
            result.insert(result.end(), {list[0], list[i + 1], list[i + 2]});
        }
    }
    return result;
}

void check_count(const GltfDocument& document, const std::string& name, std::size_t count,
                 std::size_t expected) {
    if (count != expected)
        document.fail(fmt::format("{} is there for {} vertices, and POSITION for {}", name, count, expected));
}

std::vector<glm::vec2> read_uvs(const GltfDocument& document, const Attributes& attributes, std::size_t set,
                                std::size_t count) {
    const std::string name = fmt::format("TEXCOORD_{}", set);
    std::vector<glm::vec2> result(count, glm::vec2(0));
    if (!attributes.has(name)) return result;
    const std::vector<float> values = attributes.numbers(name, 2);
    check_count(document, name, values.size() / 2, count);
    for (std::size_t i = 0; i < count; ++i)
        result[i] = {values[2 * i], 1 - values[2 * i + 1]}; // glTF counts v downwards
    return result;
}

void read_colors(const GltfDocument& document, const Attributes& attributes, Mesh& mesh) {
    if (!attributes.has("COLOR_0")) return;
    const std::size_t width = attributes.width("COLOR_0");
    if (width != 3 && width != 4) document.fail("COLOR_0 has neither 3 nor 4 numbers to a vertex");
    const std::vector<float> values = attributes.numbers("COLOR_0", width);
    check_count(document, "COLOR_0", values.size() / width, mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const float* color = &values[width * i];
        mesh.vertices[i].tint = {color[0], color[1], color[2]};
        if (width == 4 && color[3] != 1) {
            mesh.extras.resize(mesh.vertices.size());
            mesh.extras[i].opacity = color[3];
        }
    }
}

void read_texture_coordinates(const GltfDocument& document, const Attributes& attributes,
                              const std::vector<std::size_t>& sets, Mesh& mesh) {
    if (sets.empty()) return;
    const std::vector<glm::vec2> first = read_uvs(document, attributes, sets[0], mesh.vertices.size());
    for (std::size_t i = 0; i < first.size(); ++i)
        mesh.vertices[i].uv = first[i];
    if (sets.size() < 2) return;
    const std::vector<glm::vec2> second = read_uvs(document, attributes, sets[1], mesh.vertices.size());
    mesh.extras.resize(mesh.vertices.size());
    for (std::size_t i = 0; i < second.size(); ++i)
        mesh.extras[i].uv = second[i];
}

std::vector<glm::vec3> read_vectors(const GltfDocument& document, std::size_t accessor, std::size_t count,
                                    const std::string& name) {
    const std::vector<float> values = read_numbers(document, accessor, 3);
    check_count(document, name, values.size() / 3, count);
    std::vector<glm::vec3> result(count);
    for (std::size_t i = 0; i < count; ++i)
        result[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return result;
}

void read_shapes(const GltfDocument& document, const Json& primitive, std::size_t count,
                 Deformation& deformation) {
    const auto targets = primitive.find("targets");
    if (targets == primitive.end()) return;
    for (const Json& target : *targets) {
        Deformation::Shape shape;
        shape.positions.resize(count);
        if (const auto positions = document.find_index(target, "POSITION"))
            shape.positions = read_vectors(document, *positions, count, "a target's POSITION");
        if (const auto normals = document.find_index(target, "NORMAL"))
            shape.normals = read_vectors(document, *normals, count, "a target's NORMAL");
        deformation.shapes.push_back(std::move(shape));
    }
}

void read_joints(const GltfDocument& document, const Attributes& attributes, std::size_t count,
                 Deformation& deformation) {
    std::vector<std::vector<std::uint32_t>> joints;
    std::vector<std::vector<float>> weights;
    for (std::size_t set = 0; attributes.has(fmt::format("JOINTS_{}", set)); ++set) {
        joints.push_back(attributes.integers(fmt::format("JOINTS_{}", set), 4));
        weights.push_back(attributes.numbers(fmt::format("WEIGHTS_{}", set), 4));
        check_count(document, "JOINTS", joints.back().size() / 4, count);
        check_count(document, "WEIGHTS", weights.back().size() / 4, count);
    }
    deformation.influences = static_cast<std::uint32_t>(4 * joints.size());
    for (std::size_t v = 0; v < count && !joints.empty(); ++v) {
        const std::size_t first = deformation.weights.size();
        float sum = 0;
        for (std::size_t set = 0; set < joints.size(); ++set) {
            for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
                const float weight = std::isfinite(weights[set][i]) ? std::max(weights[set][i], 0.0f) : 0;
                deformation.joints.push_back(weight > 0 ? joints[set][i] : 0);
                deformation.weights.push_back(weight);
                sum += weight;
            }
        }
        if (sum <= 0) deformation.weights[first] = sum = 1;
        for (std::size_t i = first; i < deformation.weights.size(); ++i)
            deformation.weights[i] /= sum;
    }
}

} // namespace

Mesh read_gltf_primitive(const GltfDocument& document, const Json& primitive,
                         const std::vector<std::size_t>& uv_sets, Losses& losses) {
    static const LossKind thin{"primitive of points or lines is left out",
                               "primitives of points or lines are left out"};
    Mesh mesh;
    const Attributes attributes(document, primitive);
    const std::size_t mode = document.find_index(primitive, "mode").value_or(4);
    if (mode < 4) losses.add(thin, "");
    if (mode < 4 || !attributes.has("POSITION")) return mesh;
    const std::vector<float> positions = attributes.numbers("POSITION", 3);
    const std::size_t count = positions.size() / 3;
    mesh.vertices.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        mesh.vertices[i].position = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    bool has_normals = false;
    if (attributes.has("NORMAL")) {
        const std::vector<float> normals = attributes.numbers("NORMAL", 3);
        has_normals = std::any_of(normals.begin(), normals.end(),
                                  [](float value) { return value != 0 && std::isfinite(value); });
        check_count(document, "NORMAL", normals.size() / 3, count);
        for (std::size_t i = 0; i < count; ++i)
            mesh.vertices[i].normal = {normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]};
    }
    read_texture_coordinates(document, attributes, uv_sets, mesh);
    read_colors(document, attributes, mesh);
    auto deformation = std::make_shared<Deformation>();
    read_shapes(document, primitive, count, *deformation);
    read_joints(document, attributes, count, *deformation);
    if (!deformation->shapes.empty() || deformation->influences > 0)
        mesh.deformation = std::move(deformation);
    mesh.indices = triangles_of(mode, attributes.indices(count));
    drop_broken_triangles(mesh, "", losses);
    if (!has_normals) make_flat(mesh);
    return mesh;
}

} // namespace postfx::host
