#include "surface/mesh/mesh_surface.h"

#include <algorithm>
#include <array>

#include "surface/mesh/mesh_texture.h"

namespace lumulus::surface {
namespace {

/// The corners of a triangle, and where between them a ray meets it.
struct Place {
    std::array<const mesh::Vertex*, 3> corners{};
    glm::vec3 shares{0.0F};
    const mesh::Model* model = nullptr;
    const mesh::Material* material = nullptr;

    template <class Value>
    Value mean(Value mesh::Vertex::*member) const {
        return shares.x * (corners[0]->*member) + shares.y * (corners[1]->*member) + shares.z * (corners[2]->*member);
    }
    glm::vec4 texture(int number, bool srgb) const {
        if (number < 0) return glm::vec4(1.0F);
        return sampleTexture(model->textures[static_cast<std::size_t>(number)], mean(&mesh::Vertex::uv), srgb);
    }
};

Place placeOf(const MeshScene& scene, const shared::MeshHit& hit) {
    const mesh::Instance& instance = scene.placed.instances[static_cast<std::size_t>(hit.instance)];
    const mesh::Model& model = scene.placed.models[instance.model];
    const std::size_t place = scene.world.firstTriangles[instance.model] + static_cast<std::size_t>(hit.triangle);
    const mesh::Triangle& triangle = model.triangles[scene.world.triangleNumbers[place]];
    Place found;
    for (int i = 0; i < 3; ++i) found.corners[static_cast<std::size_t>(i)] = &model.vertices[triangle.vertices[i]];
    found.shares = {1.0F - hit.place.x - hit.place.y, hit.place.x, hit.place.y};
    found.model = &model;
    found.material = &model.materials[triangle.material];
    return found;
}

/// The normal of the vertices, tilted by the normal map: x along u, y against v, which grows downwards.
glm::dvec3 modelNormal(const Place& place) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(place.mean(&mesh::Vertex::normal)));
    if (place.material->normalTexture < 0) return normal;
    const glm::dvec3 right = place.corners[1]->position - place.corners[0]->position;
    const glm::dvec3 left = place.corners[2]->position - place.corners[0]->position;
    const glm::dmat2 uv(place.corners[1]->uv - place.corners[0]->uv, place.corners[2]->uv - place.corners[0]->uv);
    const double turn = glm::determinant(uv);
    glm::dvec3 x = turn != 0.0 ? (uv[1].y * right - uv[0].y * left) / turn : glm::dvec3(0.0);
    x -= glm::dot(x, normal) * normal;
    if (!(glm::dot(x, x) > 0.0)) return normal;
    x = glm::normalize(x);
    const glm::dvec3 y = (turn > 0.0 ? -1.0 : 1.0) * glm::cross(normal, x);
    const glm::dvec3 map = 2.0 * glm::dvec3(place.texture(place.material->normalTexture, false)) - 1.0;
    const double scale = static_cast<double>(place.material->normalScale);
    const glm::dvec3 tilted = scale * (map.x * x + map.y * y) + map.z * normal;
    return glm::dot(tilted, tilted) > 0.0 ? glm::normalize(tilted) : normal;
}

material::Material materialOf(const Place& place) {
    const mesh::Material& from = *place.material;
    const glm::vec4 rough = place.texture(from.metallicRoughnessTexture, false);
    const double roughness = static_cast<double>(from.roughness * rough.g),
                 metallic = static_cast<double>(from.metallic * rough.b);
    const glm::dvec3 colour(from.colour * glm::vec3(place.texture(from.colourTexture, true)));
    return {material::Microfacets::ggx, roughness * roughness, glm::mix(glm::dvec3(0.04), colour, metallic),
            (1.0 - metallic) * colour, true};
}

}  // namespace

MeshScene::MeshScene(const scene::Scene& scene, const Check& check)
    : placed(mesh::loadMeshes(scene)), world(bvh::buildWorld(placed, check)) {
    for (const mesh::Instance& instance : placed.instances)
        normalToWorld.push_back(glm::transpose(glm::inverse(glm::dmat3(instance.toWorld))));
    masked = std::ranges::any_of(placed.models, [](const mesh::Model& model) {
        return std::ranges::any_of(model.materials, &mesh::Material::masked);
    });
}

MeshPoint MeshScene::at(const shared::MeshHit& hit, const glm::dvec3& direction) const {
    const Place place = placeOf(*this, hit);
    const auto instance = static_cast<std::size_t>(hit.instance);
    MeshPoint point;
    point.instance = hit.instance;
    point.triangle = hit.triangle;
    point.position =
        glm::dvec3(placed.instances[instance].toWorld * glm::dvec4(place.mean(&mesh::Vertex::position), 1.0));
    const glm::dvec3 edge1 = glm::dvec3(place.corners[1]->position) - glm::dvec3(place.corners[0]->position),
                     edge2 = glm::dvec3(place.corners[2]->position) - glm::dvec3(place.corners[0]->position);
    const auto facing = [&](const glm::dvec3& normal, const glm::dvec3& against) {
        const glm::dvec3 turned = glm::normalize(normalToWorld[instance] * normal);
        return glm::dot(turned, against) > 0.0 ? -turned : turned;
    };
    point.faceNormal = facing(glm::cross(edge1, edge2), direction);
    point.normal = facing(modelNormal(place), -point.faceNormal);
    if (!(glm::dot(point.normal, direction) < 0.0)) point.normal = point.faceNormal;
    point.material = materialOf(place);
    point.emission =
        glm::dvec3(place.material->emission * glm::vec3(place.texture(place.material->emissionTexture, true)));
    return point;
}

std::optional<MeshMeeting> MeshScene::meet(const Ray& ray, double metres, int fromInstance, int fromTriangle) const {
    constexpr int mostHoles = 64;  // that a ray goes through, one behind the other
    // from where it enters the sphere around all meshes: floats have few digits far away
    const glm::dvec3 from = ray.origin - world.middle;
    const double around = 1.001 * static_cast<double>(world.reach()), along = -glm::dot(from, ray.direction);
    const double skipped = std::max(0.0, along - around), most = std::min(metres, along + around);
    if (glm::length(glm::cross(from, ray.direction)) > around || most <= skipped) return std::nullopt;
    shared::MeshRay rest{glm::vec3(from + skipped * ray.direction), 0.0F,         glm::vec3(ray.direction),
                         static_cast<float>(most - skipped),        fromInstance, fromTriangle};
    for (int hole = 0; hole < mostHoles; ++hole) {
        const shared::MeshHit hit = bvh::nearest(world, rest);
        if (hit.instance < 0) return std::nullopt;
        if (!masked || isThere(hit)) return MeshMeeting{hit, skipped + static_cast<double>(hit.distance)};
        rest.least = hit.distance;
        rest.fromInstance = hit.instance;
        rest.fromTriangle = hit.triangle;
    }
    return std::nullopt;
}

bool MeshScene::isThere(const shared::MeshHit& hit) const {
    const Place place = placeOf(*this, hit);
    if (!place.material->masked()) return true;
    return place.material->alpha * place.texture(place.material->colourTexture, true).a >= place.material->alphaCutoff;
}

}  // namespace lumulus::surface
