#include "render/kept_assets.h"

#include <algorithm>
#include <utility>

#include "render/world_assets.h"
#include "volume/load.h"

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

std::shared_ptr<const gpu::Image> KeptPool::find(CloudVolumes& volumes) const {
    const auto isSame = [](const Field& kept, const FieldPointer& field, const vdb::SparseVolume& bricks) {
        const auto place = [](const vdb::SparseVolume::Slot& slot) { return std::pair(slot.brick, slot.level); };
        return !kept.field.owner_before(field) && !field.owner_before(kept.field) && kept.format == bricks.format &&
               kept.bricks.nodes == bricks.nodes && kept.bricks.leafOf == bricks.leafOf &&
               kept.bricks.cellBricks == bricks.cellBricks &&
               std::ranges::equal(kept.bricks.slots, bricks.slots, {}, place, place);
    };
    if (fields.size() != volumes.bricks.size()) return nullptr;
    for (std::size_t i = 0; i < fields.size(); ++i)
        if (!isSame(fields[i], volumes.volumes[i], volumes.bricks[i])) return nullptr;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        vdb::LeafTable leaves = std::move(volumes.bricks[i].leaves);
        volumes.bricks[i] = fields[i].bricks;
        volumes.bricks[i].leaves = std::move(leaves);
    }
    return image;
}

std::shared_ptr<const gpu::Image> KeptClouds::State::poolOf(gpu::Context& device, CloudVolumes& volumes,
                                                            const Check& check) {
    if (!volumes.isSparse()) {
        pool = {};
        return nullptr;
    }
    if (auto known = pool.find(volumes)) return known;
    keepOnly({});  // they are in the pool of before
    pool = {};
    KeptPool made;
    for (std::size_t i = 0; i < volumes.bricks.size(); ++i)
        made.fields.push_back({volumes.volumes[i], volumes.bricks[i].format, {}});
    made.image = makePool(device, volumes.bricks, check);
    for (std::size_t i = 0; i < volumes.bricks.size(); ++i) {
        vdb::LeafTable leaves = std::exchange(volumes.bricks[i].leaves, {});
        made.fields[i].bricks = volumes.bricks[i];
        volumes.bricks[i].leaves = std::move(leaves);
    }
    pool = std::move(made);
    return pool.image;
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
