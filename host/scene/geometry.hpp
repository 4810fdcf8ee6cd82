// Triangle meshes and the primitives they are made from. Metres, y up, counter-clockwise fronts.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace postfx::host {

struct Vertex {
    glm::vec3 position{0};
    glm::vec3 normal{0, 1, 0}; ///< unit
    glm::vec2 uv{0};
    glm::vec3 tint{1}; ///< multiplies the material's diffuse and emission
};

/// What few meshes have besides.
struct VertexExtra {
    glm::vec2 uv{0};   ///< a second pair
    float opacity = 1; ///< multiplies the material's
};

/// Axis-aligned box; empty until something was added.
struct Bounds {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    bool empty() const { return low.x > high.x; }
    void add(glm::dvec3 point);
    void add(const Bounds& other);
    glm::dvec3 center() const { return 0.5 * (low + high); }
    /// Of the sphere around center() that holds the box.
    double radius() const { return 0.5 * glm::length(high - low); }
    /// The box around this box, transformed.
    Bounds transformed(const glm::dmat4& matrix) const;
};

/// How the vertices of a mesh move: first by shapes, each as far as its weight says, then with joints.
struct Deformation {
    struct Shape {
        std::vector<glm::vec3> positions, normals; ///< differences, one per vertex; there may be no normals
    };
    std::vector<Shape> shapes;

    std::uint32_t influences = 0;      ///< joints per vertex
    std::vector<std::uint32_t> joints; ///< `influences` per vertex, indices into the skin's joints
    std::vector<float> weights;        ///< as many; their sum is 1 for every vertex
};

struct Mesh {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;             ///< three per triangle
    std::vector<VertexExtra> extras;                ///< one per vertex, or none at all
    std::shared_ptr<const Deformation> deformation; ///< null: it keeps its shape

    bool empty() const { return indices.empty(); }
    std::uint32_t add(const Vertex& vertex);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    /// Two triangles; corners counter-clockwise seen from the front.
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
    /// A convex flat face of its own vertices; corners counter-clockwise seen from the front.
    void face(const std::vector<glm::vec3>& corners, glm::vec3 tint = glm::vec3(1));
    /// Another mesh, placed and tinted.
    void append(const Mesh& other, const glm::mat4& placement, glm::vec3 tint = glm::vec3(1));

    Bounds bounds() const;
};

/// The vertices with `weights` of the deformation's shapes and then, if there are any, with `joints`, which lead from the
/// mesh as it was bound to where it is. Missing weights are 0.
void deform(const Mesh& mesh, const std::vector<float>& weights, const std::vector<glm::mat4>& joints,
            std::vector<Vertex>& result);

/// The matrix for normals of what that matrix places, up to a factor above 0; also where it flattens.
glm::dmat3 normal_matrix(const glm::dmat4& placement);

/// Area-weighted normals from the triangles; vertices shared by triangles become smooth.
void compute_normals(Mesh& mesh);

/// Centred at the origin.
Mesh box(glm::vec3 size);
Mesh sphere(float radius, int segments);
/// Horizontal, facing up; uv 0..1.
Mesh plane(glm::vec2 size, int divisions);
/// Around the y axis, from y = 0 up, closed.
Mesh cylinder(float radius, float height, int segments);
Mesh cone(float radius, float height, int segments);
/// Around the y axis; `tube` is the radius of the ring's own circle.
Mesh torus(float radius, float tube, int segments);
/// A curve through pairs (radius, y) from bottom to top, turned around the y axis. A point that stands there twice is
/// an edge; between two edges without a point in between the way is straight. Closed if it begins and ends at radius 0.
Mesh lathe(const std::vector<glm::vec2>& points, int segments);
/// A round bar along these points, none of them twice in a row, growing from one radius to the other; its ends closed.
Mesh rod(const std::vector<glm::vec3>& points, float first_radius, float last_radius, int segments);

/// One cross-section of a loft, at z: a rounded box (superellipse) or a rounded trapezoid.
struct Section {
    float z;
    float half_width_bottom, half_width_top;
    float bottom, top; ///< y
};
/// A closed skin through sections with z growing. `roundness`: exponent of the superellipse; 2 is an ellipse,
/// larger is boxier.
Mesh loft(const std::vector<Section>& sections, int segments, float roundness);

} // namespace postfx::host
