// A compact saloon from two lofts and a few boxes. Front at -z, the driver sees +x on the right.
#include "../generators.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

namespace postfx::host {
namespace {

glm::mat4 at(glm::vec3 position) {
    return glm::translate(glm::mat4(1), position);
}

/// Lower body: nose to tail.
Mesh body() {
    return loft({{-2.20f, 0.60f, 0.58f, 0.36f, 0.56f},
                 {-2.14f, 0.76f, 0.72f, 0.27f, 0.66f},
                 {-1.95f, 0.85f, 0.80f, 0.22f, 0.73f},
                 {-1.40f, 0.90f, 0.84f, 0.20f, 0.83f},
                 {-0.80f, 0.91f, 0.86f, 0.19f, 0.90f},
                 {0.20f, 0.91f, 0.87f, 0.19f, 0.94f},
                 {1.30f, 0.91f, 0.87f, 0.20f, 0.97f},
                 {1.85f, 0.89f, 0.84f, 0.23f, 0.98f},
                 {2.10f, 0.84f, 0.80f, 0.28f, 0.96f},
                 {2.19f, 0.76f, 0.74f, 0.34f, 0.92f}},
                40, 5.5f);
}

/// Windows and roof in one skin; the part that looks up between the screens is roof.
void add_cabin(Mesh& paint, Mesh& glass) {
    const Mesh skin = loft({{-0.95f, 0.80f, 0.74f, 0.60f, 0.89f},
                            {-0.45f, 0.83f, 0.68f, 0.60f, 1.16f},
                            {-0.05f, 0.84f, 0.63f, 0.60f, 1.37f},
                            {0.25f, 0.84f, 0.61f, 0.60f, 1.43f},
                            {0.75f, 0.84f, 0.60f, 0.60f, 1.43f},
                            {1.15f, 0.83f, 0.59f, 0.60f, 1.38f},
                            {1.55f, 0.81f, 0.64f, 0.60f, 1.18f},
                            {1.92f, 0.78f, 0.70f, 0.60f, 0.96f}},
                           40, 5.0f);
    for (std::size_t i = 0; i < skin.indices.size(); i += 3) {
        const Vertex *corners[3], *first = skin.vertices.data();
        glm::vec3 middle(0), normal(0);
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = first + skin.indices[i + k];
            middle += corners[k]->position / 3.0f;
            normal += corners[k]->normal / 3.0f;
        }
        const bool roof = normal.y > 0.55f && middle.z > -0.1f && middle.z < 1.18f;
        const bool pillar =
            std::abs(middle.x) > 0.5f && (middle.z < -0.3f || middle.z > 1.25f) && normal.y > 0.3f;
        Mesh& target = roof || pillar ? paint : glass;
        const std::uint32_t a = target.add(*corners[0]), b = target.add(*corners[1]),
                            c = target.add(*corners[2]);
        target.triangle(a, b, c);
    }
}

void add_wheels(Mesh& tyre, Mesh& rim) {
    const glm::mat4 lying = glm::rotate(glm::mat4(1), std::numbers::pi_v<float> / 2, glm::vec3(0, 0, 1));
    const Mesh rubber = torus(0.235f, 0.085f, 28), disc = cylinder(0.2f, 0.06f, 20),
               arch = cylinder(0.36f, 0.2f, 24);
    for (const float z : {-1.36f, 1.34f}) {
        for (const float side : {-1.0f, 1.0f}) {
            // Scaled along its axis so that the ring becomes a tyre's flat tread.
            const glm::mat4 hub = at({side * 0.8f, 0.32f, z}) * lying;
            tyre.append(rubber, glm::scale(hub, {1, 1.25f, 1}));
            tyre.append(arch, at({side * 0.81f + 0.1f, 0.34f, z}) * lying);
            rim.append(disc, at({side * 0.88f + 0.03f, 0.32f, z}) * lying);
        }
    }
}

} // namespace

MadeParts make_car() {
    Mesh paint = body(), glass, tyre, rim, trim, head_lamp, tail_lamp, indicator, plate;
    add_cabin(paint, glass);
    add_wheels(tyre, rim);

    const auto both_sides = [](Mesh& mesh, const Mesh& piece, glm::vec3 right, float yaw_degrees = 0) {
        for (const float side : {-1.0f, 1.0f}) {
            mesh.append(piece, glm::rotate(at({side * right.x, right.y, right.z}),
                                           glm::radians(side * yaw_degrees), glm::vec3(0, 1, 0)));
        }
    };
    // Rear: wide lamps with a thin bar between them, indicators under them, plate, bumper, reflectors.
    both_sides(tail_lamp, box({0.36f, 0.13f, 0.05f}), {0.57f, 0.79f, 2.185f}, 12);
    tail_lamp.append(box({0.86f, 0.025f, 0.03f}), at({0, 0.83f, 2.195f}));
    tail_lamp.append(box({0.34f, 0.025f, 0.03f}),
                     at({0, 1.30f, 1.36f})); // third brake light, under the roof's edge
    both_sides(indicator, box({0.30f, 0.035f, 0.05f}), {0.58f, 0.69f, 2.185f}, 12);
    plate.append(box({0.52f, 0.11f, 0.02f}), at({0, 0.66f, 2.2f}));
    trim.append(box({1.46f, 0.14f, 0.1f}), at({0, 0.36f, 2.16f}));
    both_sides(trim, cylinder(0.04f, 0.12f, 10), {0.5f, 0.27f, 2.1f});
    // Front.
    both_sides(head_lamp, box({0.34f, 0.11f, 0.06f}), {0.56f, 0.58f, -2.12f}, -14);
    trim.append(box({0.8f, 0.16f, 0.06f}), at({0, 0.42f, -2.18f}));
    plate.append(box({0.52f, 0.11f, 0.02f}), at({0, 0.44f, -2.22f}));
    // Mirrors and sills.
    both_sides(paint, loft({{-0.62f, 0.09f, 0.08f, 0.94f, 1.06f}, {-0.5f, 0.11f, 0.1f, 0.93f, 1.08f}}, 16, 4),
               {0.93f, 0, 0});
    both_sides(trim, box({0.05f, 0.1f, 1.9f}), {0.89f, 0.22f, 0});

    MadeParts parts;
    parts.push_back({"paint", std::move(paint)});
    parts.push_back({"glass", std::move(glass)});
    parts.push_back({"tyre", std::move(tyre)});
    parts.push_back({"rim", std::move(rim)});
    parts.push_back({"trim", std::move(trim)});
    parts.push_back({"head_lamp", std::move(head_lamp)});
    parts.push_back({"tail_lamp", std::move(tail_lamp)});
    parts.push_back({"indicator", std::move(indicator)});
    parts.push_back({"plate", std::move(plate)});
    return parts;
}

} // namespace postfx::host
