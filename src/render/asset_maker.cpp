#include "render/asset_maker.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "cloud/level_of_detail.h"
#include "cloud/refined.h"
#include "render/kept_clouds.h"
#include "volume/known_fields.h"

namespace lumulus {

namespace {

/// Samples of the gradient for each leaf that a tree may have.
constexpr int samplesOfLeaf = 16;

/// A field at a level of detail, or divided into parts; empty for the field itself.
vdb::Volume atDetail(const vdb::Volume& field, const Detail& detail) {
    if (detail.level > 0) return cloud::coarsened(field, detail.level);
    return detail.isWhole() ? vdb::Volume{} : cloud::refined(field, detail.parts);
}

vdb::Affine atDetail(const vdb::Affine& place, const Detail& detail) {
    return detail.level > 0 ? cloud::coarsened(place, detail.level) : cloud::refined(place, detail.parts);
}

AssetSummary summaryOf(const cloud::Asset& asset, const Group& group) {
    const cloud::PreparationTimes& t = asset.times;
    return {{asset.size.x, asset.size.y, asset.size.z},
            group.detail.level,
            asset.collectors.size(),
            group.instances.size(),
            t.upload,
            t.majorants,
            t.sampling,
            t.tree,
            t.collectors};
}

}  // namespace

double reducedExtinction(const phase::ScatteringMedium& medium, int bands) {
    const double forward = bands > 1 ? static_cast<double>(medium.tables.bandMoments[1]) : 0.0;
    return medium.extinction * static_cast<double>(medium.tables.scatterFraction) * (1.0 - forward);
}

const vdb::Volume& AssetMaker::volumeOf(Plan& plan) const {
    if (plan.group.detail.isWhole()) return *plan.group.volume;
    if (!plan.other) plan.other = atDetail(*plan.group.volume, plan.group.detail);
    return *plan.other;
}

AssetMaker::Plan AssetMaker::planOf(const Group& group) const {
    const bool whole = group.detail.isWhole() && mayKeep(group);
    if (!pool_ && lacksValues(*group.volume) && !whole) throw DensityMissing{};
    Plan plan{group, {}, {}, 0.0F, false, nullptr};
    plan.origin.field = fieldOf(group);
    plan.origin.level = group.detail.level;
    plan.origin.voxelToMetres = placed_[group.instances.front()].toWorld.linear;
    if (!group.detail.isWhole())
        plan.origin.voxelToMetres = atDetail(placed_[group.instances.front()].toWorld, group.detail).linear;
    const auto known = mayKeep(group) ? options_.kept->maximumOf(fieldOf(group), group.detail.level) : std::nullopt;
    plan.maximum = known ? *known : volumeOf(plan).maximum;
    cloud::PrepareOptions& wanted = plan.origin.how;
    wanted.preparation = scene_.preparation;
    wanted.majorant = world_.photonMap.majorant;
    wanted.keepBlocks = placed_.size() > 1 || options_.keepRing;  // who keeps a ring may get more clouds
    wanted.check = options_.check;
    plan.fewer = group.detail.collectors < scene_.preparation.maxLeaves;
    if (plan.fewer) {
        wanted.preparation.maxLeaves = group.detail.collectors;
        wanted.preparation.samples = std::min(wanted.preparation.samples, samplesOfLeaf * group.detail.collectors);
    }
    fit(plan);
    if (mayKeep(group)) plan.asset = options_.kept->find(plan.origin);
    if (!pool_ && !plan.asset && lacksValues(*group.volume)) throw DensityMissing{};
    return plan;
}

/// Leaves are split until they are optically thin. An asset knows its own size, so that what counts for an instance is
/// its extinction times how much larger it is.
void AssetMaker::fit(Plan& plan) const {
    const Group& group = plan.group;
    const double thinner = static_cast<double>(plan.maximum) / static_cast<double>(group.volume->maximum);
    cloud::PrepareOptions& wanted = plan.origin.how;
    for (const std::size_t i : group.instances) {
        cloud::Instance& instance = world_.instances[i];
        if (!group.detail.isWhole()) {
            instance.medium.extinction *= thinner;
            instance.voxelToMetres = atDetail({instance.voxelToMetres, instance.origin}, group.detail).linear;
        }
        if (group.detail.parts != glm::ivec3(1))  // the box of the same density by smaller voxels
            instance.bounds = boundsOf(vdb::PlacedVolume(volumeOf(plan), {instance.voxelToMetres, instance.origin}));
        const double larger =
            i == group.instances.front() ? 1.0 : edgeOf(instance.voxelToMetres) / edgeOf(plan.origin.voxelToMetres);
        wanted.reducedExtinction =
            std::max(wanted.reducedExtinction, larger * reducedExtinction(instance.medium, world_.photonMap.bands));
    }
}

void AssetMaker::prepare(Plan& plan) const {
    options_.report("preparing the cloud", 0, 1);
    const Group& group = plan.group;
    const vdb::PlacedVolume& first = placed_[group.instances.front()];
    const vdb::PlacedVolume field =
        group.detail.isWhole() ? first : vdb::PlacedVolume(volumeOf(plan), atDetail(first.toWorld, group.detail));
    plan.asset = std::make_shared<const cloud::Asset>(
        pool_ ? cloud::prepareBricks(context_, *field.bricks, field.toWorld, pool_, plan.origin.how)
              : cloud::prepare(context_, field, plan.origin.how));
    plan.other.reset();
    options_.check();
    options_.report("preparing the cloud", 1, 1);
}

void AssetMaker::give(const Plan& plan, bool kept) const {
    world_.assets.push_back(plan.asset);
    for (const std::size_t i : plan.group.instances) world_.instances[i].asset = plan.asset.get();
    AssetSummary summary = summaryOf(*plan.asset, plan.group);
    if (kept) summary = summary.withoutTimes();
    report_.assets.push_back(summary);
    if (plan.asset->tree.limited && !plan.fewer)
        report_.warnings.push_back("samples of the gradient asked for more than " +
                                   std::to_string(scene_.preparation.maxLeaves) +
                                   " collectors: light is smeared in those that stay too large; raise "
                                   "preparation.max_leaves or lower preparation.samples");
}

void AssetMaker::make(const std::vector<Group>& groups) {
    if (options_.kept == nullptr) {
        for (const Group& group : groups) {
            Plan plan = planOf(group);
            prepare(plan);
            give(plan, false);
        }
        return;
    }
    std::vector<Plan> plans;
    std::vector<std::shared_ptr<const cloud::Asset>> found;
    for (const Group& group : groups) {
        plans.push_back(planOf(group));
        plans.back().other.reset();  // one at a time
        if (plans.back().asset) found.push_back(plans.back().asset);
    }
    options_.kept->keepOnly(found);
    for (Plan& plan : plans) {
        const bool kept = plan.asset != nullptr;
        if (!kept) prepare(plan);
        if (!kept && mayKeep(plan.group)) options_.kept->assets.push_back({plan.origin, plan.maximum, plan.asset});
        give(plan, kept);
    }
}

}  // namespace lumulus
