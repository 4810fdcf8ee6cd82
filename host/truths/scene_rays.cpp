#include "scene_rays.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <embree3/rtcore.h>

#include <algorithm>
#include <vector>

namespace postfx::host {

struct SceneRays::State {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = nullptr;
    std::vector<glm::dmat4> nodes;
    struct Placed {
        std::shared_ptr<const Mesh> mesh;
        glm::dmat3 normal_to_world{1};
    };
    std::vector<Placed> meshes; ///< by Embree's number of the geometry

    ~State() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    void check() const;
    void add(const std::shared_ptr<const Mesh>& shared, const glm::dmat4& place);
};

void SceneRays::State::check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        throw Error(fmt::format("Embree failed with error {}", static_cast<int>(error)));
}

void SceneRays::State::add(const std::shared_ptr<const Mesh>& shared, const glm::dmat4& place) {
    const Mesh& mesh = *shared;
    if (mesh.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
    auto* triangles = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
    check();
    for (const Vertex& vertex : mesh.vertices) {
        const glm::vec3 point(place * glm::dvec4(glm::dvec3(vertex.position), 1));
        points = std::copy_n(&point.x, 3, points);
    }
    std::copy(mesh.indices.begin(), mesh.indices.end(), triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(meshes.size()));
    meshes.push_back({shared, glm::transpose(glm::inverse(glm::dmat3(place)))});
    rtcReleaseGeometry(geometry);
}

SceneRays::SceneRays(const Scene& scene, double time) : state_(std::make_unique<State>()) {
    if (!state_->device) throw Error("Embree does not start on this machine");
    state_->scene = rtcNewScene(state_->device);
    // Robust: no ray slips through between two triangles.
    rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
    scene.place_nodes(time, state_->nodes);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        for (const Part& part : scene.nodes[i].parts) {
            if (!scene.materials[part.material].blended)
                state_->add(scene.mesh_at(i, part.mesh, state_->nodes, time), state_->nodes[i]);
        }
    }
    rtcCommitScene(state_->scene);
    state_->check();
}

SceneRays::~SceneRays() = default;

std::optional<SceneRays::Hit> SceneRays::hit(glm::dvec3 origin, glm::dvec3 direction, double reach) const {
    RTCRayHit query{};
    RTCRay& ray = query.ray;
    ray.org_x = static_cast<float>(origin.x);
    ray.org_y = static_cast<float>(origin.y);
    ray.org_z = static_cast<float>(origin.z);
    ray.dir_x = static_cast<float>(direction.x);
    ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tfar = static_cast<float>(reach);
    ray.mask = 0xffffffffu;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(state_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z));
    return Hit{.distance = ray.tfar,
               .normal = glm::dot(normal, direction) < 0 ? normal : -normal,
               .mesh = query.hit.geomID,
               .triangle = query.hit.primID,
               .within = {query.hit.u, query.hit.v}};
}

glm::dvec3 SceneRays::shading_normal(const Hit& hit) const {
    const State::Placed& placed = state_->meshes[hit.mesh];
    const auto corner = [&](std::size_t i) {
        const std::uint32_t vertex = placed.mesh->indices[3 * std::size_t(hit.triangle) + i];
        return glm::dvec3(placed.mesh->vertices[vertex].normal);
    };
    const glm::dvec2 w = hit.within;
    return glm::normalize(placed.normal_to_world
                          * ((1 - w.x - w.y) * corner(0) + w.x * corner(1) + w.y * corner(2)));
}

} // namespace postfx::host
