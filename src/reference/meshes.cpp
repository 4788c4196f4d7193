#include "reference/meshes.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "reference/mesh_texture.h"

namespace lumulus::reference {
namespace {

template <class Handle, void (*release)(Handle)>
struct Release {
    void operator()(std::remove_pointer_t<Handle>* handle) const { release(handle); }
};

template <class Handle, void (*release)(Handle)>
using Held = std::unique_ptr<std::remove_pointer_t<Handle>, Release<Handle, release>>;

using HeldDevice = Held<RTCDevice, rtcReleaseDevice>;
using HeldScene = Held<RTCScene, rtcReleaseScene>;
using HeldGeometry = Held<RTCGeometry, rtcReleaseGeometry>;

/// What a query tells its filter.
struct Query {
    RTCIntersectContext context;  // first: Embree knows this part alone
    const mesh::Placed* placed;
    const MeshHit* from;
};

using Corners = std::array<const mesh::Vertex*, 3>;

Corners cornersOf(const mesh::Model& model, std::size_t triangle) {
    const glm::uvec3 of = model.triangles[triangle].vertices;
    return {&model.vertices[of.x], &model.vertices[of.y], &model.vertices[of.z]};
}

/// A value of vertices between the corners.
template <class Vector>
auto between(const Corners& corners, const glm::dvec2& place, Vector mesh::Vertex::*member) {
    using Double = glm::vec<Vector::length(), double>;
    return (1.0 - place.x - place.y) * Double(corners[0]->*member) + place.x * Double(corners[1]->*member) +
           place.y * Double(corners[2]->*member);
}

/// Refuses the triangle that a ray leaves, and holes of masks.
void refuse(const RTCFilterFunctionNArguments* call) {
    const Query& query = *reinterpret_cast<const Query*>(call->context);
    for (unsigned int i = 0; i < call->N; ++i) {
        if (call->valid[i] != -1) continue;
        const std::size_t instance = RTCHitN_instID(call->hit, call->N, i, 0);
        const std::size_t triangle = RTCHitN_primID(call->hit, call->N, i);
        const mesh::Model& model = query.placed->models[query.placed->instances[instance].model];
        const mesh::Material& material = model.materials[model.triangles[triangle].material];
        const glm::dvec2 place(RTCHitN_u(call->hit, call->N, i), RTCHitN_v(call->hit, call->N, i));
        const bool left = query.from != nullptr && query.from->instance == instance && query.from->triangle == triangle;
        if (left || !isThere(model, material, between(cornersOf(model, triangle), place, &mesh::Vertex::uv)))
            call->valid[i] = 0;
    }
}

HeldScene sceneOf(RTCDevice device) {
    HeldScene scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    return scene;
}

HeldScene sceneOf(RTCDevice device, const mesh::Model& model) {
    HeldScene scene = sceneOf(device);
    const HeldGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), model.vertices.size()));
    auto* triangles = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), model.triangles.size()));
    if (vertices == nullptr || triangles == nullptr)
        throw Error("Embree has no memory for the meshes", "mesh", "give simpler ones");
    for (std::size_t i = 0; i < model.vertices.size(); ++i) vertices[i] = model.vertices[i].position;
    for (std::size_t i = 0; i < model.triangles.size(); ++i) triangles[i] = model.triangles[i].vertices;
    rtcSetGeometryIntersectFilterFunction(geometry.get(), refuse);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene.get(), geometry.get());
    rtcCommitScene(scene.get());
    return scene;
}

}  // namespace

struct Meshes::Tree {
    HeldDevice device;
    std::vector<HeldScene> models;
    HeldScene all;
    glm::dvec3 middle{0.0};                 ///< that Embree's positions are relative to
    double reach = 0.0;                     ///< no point of a mesh is farther from the middle, metres
    std::vector<glm::dmat3> normalToWorld;  ///< of each instance
};

Meshes::Meshes(const scene::Scene& scene) {
    if (scene.meshes.empty()) return;
    placed_ = std::make_shared<const mesh::Placed>(mesh::loadMeshes(scene));
    auto tree = std::make_shared<Tree>();
    tree->device.reset(rtcNewDevice(nullptr));
    if (!tree->device) throw Error("Embree cannot be used", "mesh", "install libembree3-3");
    for (const mesh::Model& model : placed_->models) tree->models.push_back(sceneOf(tree->device.get(), model));
    tree->all = sceneOf(tree->device.get());
    for (const mesh::Instance& instance : placed_->instances)
        tree->middle += glm::dvec3(instance.toWorld[3]) / static_cast<double>(placed_->instances.size());
    for (const mesh::Instance& instance : placed_->instances) {
        const HeldGeometry geometry(rtcNewGeometry(tree->device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
        rtcSetGeometryInstancedScene(geometry.get(), tree->models[instance.model].get());
        glm::dmat4 relative = instance.toWorld;
        relative[3] -= glm::dvec4(tree->middle, 0.0);
        const glm::mat4 transform(relative);
        rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &transform);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(tree->all.get(), geometry.get());
        tree->normalToWorld.push_back(glm::transpose(glm::inverse(glm::dmat3(instance.toWorld))));
    }
    rtcCommitScene(tree->all.get());
    RTCBounds bounds;
    rtcGetSceneBounds(tree->all.get(), &bounds);
    tree->reach = glm::length(glm::max(glm::abs(glm::dvec3(bounds.lower_x, bounds.lower_y, bounds.lower_z)),
                                       glm::abs(glm::dvec3(bounds.upper_x, bounds.upper_y, bounds.upper_z))));
    if (rtcGetDeviceError(tree->device.get()) != RTC_ERROR_NONE)
        throw Error("Embree cannot hold the meshes", "mesh", "give simpler ones");
    tree_ = std::move(tree);
}

std::optional<MeshHit> Meshes::nearest(const Ray& ray, double most, const MeshHit* from) const {
    if (empty()) return std::nullopt;
    // far away floats have few digits: the ray begins at the sphere around all meshes
    const glm::dvec3 relative = ray.origin - tree_->middle;
    const double along = -glm::dot(relative, ray.direction);
    const double away = glm::length(glm::cross(relative, ray.direction));
    if (away > 1.001 * tree_->reach || along + 1.001 * tree_->reach < 0.0) return std::nullopt;
    const double skipped = from != nullptr ? 0.0 : std::max(0.0, along - 1.001 * tree_->reach);
    if (!(skipped < most)) return std::nullopt;
    const glm::vec3 origin(relative + skipped * ray.direction), direction(ray.direction);
    Query query{};
    rtcInitIntersectContext(&query.context);
    query.placed = placed_.get();
    query.from = from;
    RTCRayHit call{};
    call.ray.org_x = origin.x, call.ray.org_y = origin.y, call.ray.org_z = origin.z;
    call.ray.dir_x = direction.x, call.ray.dir_y = direction.y, call.ray.dir_z = direction.z;
    call.ray.tnear = from != nullptr ? static_cast<float>(1e-6 * tree_->reach) : 0.0F;
    call.ray.tfar = static_cast<float>(std::min(most - skipped, 3e38));
    call.ray.mask = std::numeric_limits<unsigned int>::max();
    call.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    call.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree_->all.get(), &query.context, &call);
    if (call.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return MeshHit{
        skipped + static_cast<double>(call.ray.tfar), call.hit.instID[0], call.hit.primID, {call.hit.u, call.hit.v}};
}

namespace {

double multiplied(double value, const mesh::Model& model, int texture, const glm::dvec2& uv, int channel) {
    return texture < 0 ? value
                       : value * textureAt(model.textures[static_cast<std::size_t>(texture)], uv, false)[channel];
}

glm::dvec3 multiplied(const glm::vec3& colour, const mesh::Model& model, int texture, const glm::dvec2& uv) {
    if (texture < 0) return glm::dvec3(colour);
    return glm::dvec3(colour) * glm::dvec3(textureAt(model.textures[static_cast<std::size_t>(texture)], uv, true));
}

/// A normal by a normal map, in the frame of the texture's axes on the triangle.
glm::dvec3 mapped(const glm::dvec3& normal, const mesh::Model& model, const mesh::Material& material,
                  const Corners& corners, const glm::dvec2& uv) {
    if (material.normalTexture < 0) return normal;
    const glm::dvec3 edge1 = corners[1]->position - corners[0]->position,
                     edge2 = corners[2]->position - corners[0]->position;
    const glm::dvec2 along1 = corners[1]->uv - corners[0]->uv, along2 = corners[2]->uv - corners[0]->uv;
    const double area = along1.x * along2.y - along1.y * along2.x;
    if (area == 0.0) return normal;
    const glm::dvec3 right = (along2.y * edge1 - along1.y * edge2) / area;
    const glm::dvec3 tangent = right - glm::dot(right, normal) * normal;
    if (!(glm::length(tangent) > 0.0)) return normal;
    // green points up in the picture, against v
    const glm::dvec3 x = glm::normalize(tangent), y = glm::cross(normal, x) * (area < 0.0 ? 1.0 : -1.0);
    const glm::dvec3 texel =
        glm::dvec3(textureAt(model.textures[static_cast<std::size_t>(material.normalTexture)], uv, false)) * 2.0 - 1.0;
    const double scale = static_cast<double>(material.normalScale);
    const glm::dvec3 result = scale * texel.x * x + scale * texel.y * y + texel.z * normal;
    const double length = glm::length(result);
    return length > 0.0 ? result / length : normal;
}

}  // namespace

MeshPoint Meshes::at(const Ray& ray, const MeshHit& hit) const {
    const mesh::Instance& instance = placed_->instances[hit.instance];
    const mesh::Model& model = placed_->models[instance.model];
    const mesh::Material& material = model.materials[model.triangles[hit.triangle].material];
    const Corners corners = cornersOf(model, hit.triangle);
    const glm::dvec2 uv = between(corners, hit.place, &mesh::Vertex::uv);
    const glm::dmat3& turn = tree_->normalToWorld[hit.instance];
    const auto inWorld = [&](const glm::dvec3& normal) { return glm::normalize(turn * normal); };
    MeshPoint point;
    point.faceNormal = inWorld(glm::cross(glm::dvec3(corners[1]->position) - glm::dvec3(corners[0]->position),
                                          glm::dvec3(corners[2]->position) - glm::dvec3(corners[0]->position)));
    if (glm::dot(point.faceNormal, ray.direction) > 0.0) point.faceNormal = -point.faceNormal;
    glm::dvec3 smooth = glm::normalize(between(corners, hit.place, &mesh::Vertex::normal));
    smooth = mapped(smooth, model, material, corners, uv);
    point.normal = inWorld(smooth);
    if (glm::dot(point.normal, point.faceNormal) < 0.0) point.normal = -point.normal;
    // a normal that looks away from the eye reflects nothing
    if (!(glm::dot(point.normal, ray.direction) < 0.0)) point.normal = point.faceNormal;
    const double rough =
        multiplied(static_cast<double>(material.roughness), model, material.metallicRoughnessTexture, uv, 1);
    point.facets = {multiplied(material.colour, model, material.colourTexture, uv),
                    multiplied(static_cast<double>(material.metallic), model, material.metallicRoughnessTexture, uv, 2),
                    rough * rough};
    point.emission = multiplied(material.emission, model, material.emissionTexture, uv);
    return point;
}

}  // namespace lumulus::reference
