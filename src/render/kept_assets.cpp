#include "render/kept_assets.h"

#include <algorithm>
#include <utility>

namespace lumulus {

KeptClouds::KeptClouds() : state_(std::make_unique<State>()) {}
KeptClouds::KeptClouds(KeptClouds&&) noexcept = default;
KeptClouds& KeptClouds::operator=(KeptClouds&&) noexcept = default;
KeptClouds::~KeptClouds() = default;

bool AssetOrigin::operator==(const AssetOrigin& other) const {
    const bool sameField = !field.owner_before(other.field) && !other.field.owner_before(field);
    return sameField && level == other.level && voxelToMetres == other.voxelToMetres &&
           how.preparation == other.how.preparation && how.majorant == other.how.majorant &&
           how.reducedExtinction == other.how.reducedExtinction && how.seed == other.how.seed &&
           how.keepBlocks == other.how.keepBlocks;
}

sky::Environment KeptAir::environmentOf(const scene::Scene& scene) {
    const double diameter = scene.sun.angularDiameter;
    const bool same = scene.sky == sky && scene.ground == ground && diameter == sunDiameter;
    sky::Environment environment(scene.sky, scene.ground, diameter, sky::moonOf(scene), same ? air : nullptr);
    *this = {scene.sky, scene.ground, diameter, environment.sharedAir()};
    return environment;
}

std::optional<float> KeptClouds::State::maximumOf(const FieldPointer& field, int level) const {
    const auto found = std::ranges::find_if(
        assets, [&](const KeptAsset& kept) { return kept.origin.isOf(field) && kept.origin.level == level; });
    return found == assets.end() ? std::nullopt : std::optional(found->maximum);
}

std::shared_ptr<const cloud::Asset> KeptClouds::State::find(const AssetOrigin& origin) const {
    const auto found = std::ranges::find(assets, origin, &KeptAsset::origin);
    return found == assets.end() ? nullptr : found->asset;
}

void KeptClouds::State::keepOnly(std::span<const std::shared_ptr<const cloud::Asset>> wanted) {
    const auto isWanted = [&](const cloud::Asset* asset) {
        return std::ranges::any_of(wanted, [&](const auto& each) { return each.get() == asset; });
    };
    if (!std::ranges::all_of(sharedOf, isWanted)) {
        shared.reset();
        sharedOf.clear();
    }
    std::erase_if(*fields, [&](const auto& each) { return !isWanted(each.first); });
    std::erase_if(assets, [&](const KeptAsset& kept) { return !isWanted(kept.asset.get()); });
}

std::shared_ptr<const cloud::SharedVolumes> KeptClouds::State::sharedVolumes(
    gpu::Context& device, std::span<const cloud::Instance* const> instances) {
    std::vector<const cloud::Asset*> wanted;
    for (const cloud::Instance* instance : instances) wanted.push_back(instance->asset);
    if (!shared || wanted != sharedOf) {
        shared.reset();  // its memory is the next one's
        shared = std::make_shared<const cloud::SharedVolumes>(device, instances);
        sharedOf = std::move(wanted);
    }
    return shared;
}

KeptClouds::State* keptOn(const std::shared_ptr<gpu::Context>& context, KeptClouds* kept) {
    if (kept == nullptr) return nullptr;
    if (kept->state().context != context) *kept = KeptClouds();
    kept->state().context = context;
    return &kept->state();
}

}  // namespace lumulus
