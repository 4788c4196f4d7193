#include "light/photon/leaf_light.h"

#include "gpu/transfer.h"
#include "render/renderer_state.h"

namespace lumulus {
namespace {

/// The first three bands of a collector in the counts of a map, times `unit`.
std::array<glm::dvec3, 9> coefficientsOf(std::span<const std::int64_t> counts, std::size_t collector, int bands,
                                         double unit) {
    const auto all = static_cast<std::size_t>(bands * bands);
    std::array<glm::dvec3, 9> result{};
    for (std::size_t channel = 0; channel < 3; ++channel)
        for (std::size_t i = 0; i < std::min(all, result.size()); ++i)
            result[i][static_cast<int>(channel)] =
                unit * static_cast<double>(counts[(3 * collector + channel) * all + i]);
    return result;
}

photon::LeafLight placeOf(const cloud::Collector& collector, const cloud::Instance& instance) {
    const glm::dvec3 lower(collector.box.lower), extent(collector.box.upper - collector.box.lower);
    photon::LeafLight leaf;
    leaf.corner = instance.toWorld(lower);
    for (int axis = 0; axis < 3; ++axis) leaf.edges[axis] = instance.voxelToMetres[axis] * extent[axis];
    leaf.voxels = std::max({extent.x, extent.y, extent.z});
    return leaf;
}

}  // namespace

std::vector<photon::LeafLight> Renderer::leafLight() {
    World& world = *state_->world;
    std::vector<photon::LeafLight> leaves;
    if (!world.photons) return leaves;
    photon::PhotonMap& map = *world.photons;
    const photon::Light light = map.light();
    const auto counts = gpu::download<std::int64_t>(state_->context, *light.counts);
    const std::vector<double> masses = map.masses();
    const std::vector<std::size_t> visible = world.visible();
    std::size_t number = 0;
    for (std::size_t i = 0; i < map.parts().size(); ++i) {
        const photon::MapPart& part = map.parts()[i];
        if (!part.collects) continue;
        for (const cloud::Collector& collector : part.asset->collectors) {
            photon::LeafLight leaf = placeOf(collector, world.instances[visible[i]]);
            leaf.mass = masses[number];
            if (leaf.mass > 0.0) {
                leaf.coefficients = coefficientsOf(counts, number, world.photonMap.bands, light.unit / leaf.mass);
                leaves.push_back(leaf);
            }
            ++number;
        }
    }
    return leaves;
}

scene::Sun Renderer::sunAt(const glm::dvec3& point) const {
    return state_->world->lights.sunAt(point, state_->world->fog);
}

}  // namespace lumulus
