#include "render/world_assets.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <limits>

#include "cloud/bricks.h"
#include "cloud/level_of_detail.h"
#include "frame/view_params.h"
#include "light/photon/map_limits.h"
#include "view/camera.h"

namespace lumulus {

namespace {

constexpr double degrees = 3.14159265358979323846 / 180.0;
/// Metrics of voxels that differ by less have the same shape: rounding of rotations.
constexpr double sameShape = 1e-6;
/// Clouds out of the picture are as if they were so many times smaller.
constexpr double unseen = 4.0;

/// Lengths and angles of the edges of a voxel, whatever its size and however it is rotated or mirrored.
glm::dmat3 shapeOf(const glm::dmat3& voxelToMetres) {
    const glm::dmat3 metric = glm::transpose(voxelToMetres) * voxelToMetres;
    return metric / std::pow(std::abs(glm::determinant(voxelToMetres)), 2.0 / 3.0);
}

bool areAlike(const glm::dmat3& a, const glm::dmat3& b) {
    double largest = 0.0, apart = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            largest = std::max(largest, std::abs(a[i][j]));
            apart = std::max(apart, std::abs(a[i][j] - b[i][j]));
        }
    return apart <= sameShape * largest;
}

double edgeOf(const glm::dmat3& voxelToMetres) {
    return std::cbrt(std::abs(glm::determinant(voxelToMetres)));
}

/// Media of the same phase function and albedo share their tables.
class MediumMaker {
  public:
    explicit MediumMaker(const scene::Scene& scene) : scene_(scene) {}

    phase::ScatteringMedium make(const scene::Cloud& from, double maximum) {
        auto known = std::ranges::find_if(
            known_, [&](const Known& k) { return k.cloud->phase == from.phase && k.cloud->albedo == from.albedo; });
        if (known == known_.end()) {
            const scene::PhotonMap& map = scene_.photonMap;
            known_.push_back({&from, phase::makeScatteringTables(from.phase, map.forwardCut * degrees, from.albedo,
                                                                 map.bands, scene_.sun.angularDiameter * degrees)});
            known = known_.end() - 1;
        }
        phase::ScatteringMedium medium;
        medium.extinction = from.extinction * from.densityScale * maximum;
        medium.albedo = from.albedo;
        medium.tables = known->tables;
        return medium;
    }

  private:
    struct Known {
        const scene::Cloud* cloud;
        phase::ScatteringTables tables;
    };
    const scene::Scene& scene_;
    std::vector<Known> known_;
};

/// Instances that share an asset.
struct Group {
    const vdb::Volume* volume;
    glm::dmat3 shape;
    int level;
    double pixels;  ///< of its largest instance, along the longest side
    std::vector<std::size_t> instances;
};

/// Pixels that a voxel of an instance takes at its nearest point to the camera; infinite within it.
double voxelPixels(const cloud::Instance& instance, const glm::ivec3& size, const Camera& camera) {
    const glm::dvec3 middle = instance.toWorld(0.5 * glm::dvec3(size));
    const double radius = 0.5 * glm::length(instance.voxelToMetres * glm::dvec3(size));
    const glm::dvec3 away = middle - camera.position;
    const double distance = glm::length(away);
    if (distance <= 1.5 * radius) return std::numeric_limits<double>::infinity();
    // pixels of a perspective grow with the depth, the smallest on the axis
    const double pixel = frame::pixelLength(camera, camera.position + (distance - radius) * camera.axes[2]);
    const bool behind = camera.projection == scene::Projection::perspective && glm::dot(away, camera.axes[2]) < -radius;
    return edgeOf(instance.voxelToMetres) / pixel / (behind ? unseen : 1.0);
}

/// Collectors that each instance of a group may have: by its size in the picture, and all together as many as the
/// photon map has room for. A single cloud has what the scene asks for.
std::vector<int> shareOutCollectors(const std::vector<Group>& groups, std::uint64_t room, int most) {
    std::vector<int> shares;
    double wanted = 0.0;
    for (const Group& group : groups) {
        shares.push_back(std::isfinite(group.pixels) ? std::min(most, cloud::collectorsFor(group.pixels)) : most);
        wanted += static_cast<double>(group.instances.size()) * shares.back();
    }
    constexpr int fewest = 30;
    const double factor = std::min(1.0, static_cast<double>(room) / std::max(wanted, 1.0));
    for (int& share : shares) share = std::clamp(static_cast<int>(factor * share), std::min(fewest, most), most);
    return shares;
}

/// Collectors that the scene's photon map has room for.
std::uint64_t roomForCollectors(const gpu::Context& context, const scene::PhotonMap& map, const WorldOptions& options) {
    const photon::MapSize size{0, map.bands, map.generations, options.keepRing, options.progressive, 0};
    return photon::mostCollectors(size, static_cast<std::uint64_t>(std::ldexp(map.memoryBudget, 20)),
                                  context.limits().maxStorageBufferRange);
}

double reducedExtinction(const phase::ScatteringMedium& medium, int bands) {
    const double forward = bands > 1 ? static_cast<double>(medium.tables.bandMoments[1]) : 0.0;
    return medium.extinction * static_cast<double>(medium.tables.scatterFraction) * (1.0 - forward);
}

}  // namespace

std::shared_ptr<const gpu::Image> makePool(gpu::Context& context, std::vector<vdb::SparseVolume>& bricks,
                                           const Check& check) {
    std::vector<vdb::SparseVolume*> volumes;
    for (vdb::SparseVolume& volume : bricks)
        if (!volume.empty()) volumes.push_back(&volume);
    return volumes.empty() ? nullptr : cloud::makePool(context, volumes, check);
}

Bounds movedBounds(const Bounds& bounds, const vdb::Affine& from, const vdb::Affine& to) {
    const glm::dmat3 turned = to.linear * glm::inverse(from.linear);
    const auto moved = [&](const glm::dvec3& point) { return to.translation + turned * (point - from.translation); };
    Bounds result;
    result.centre = moved(bounds.centre);
    result.halfAxes = turned * bounds.halfAxes;
    for (const glm::dvec3& point : bounds.outline) result.outline.push_back(moved(point));
    return result;
}

void prepareAssets(gpu::Context& context, const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& placed,
                   const std::shared_ptr<const gpu::Image>& pool, const WorldOptions& options, World& world,
                   WorldReport& report) {
    std::vector<Group> groups;
    MediumMaker media(scene);
    // bricks have levels of their own, which are chosen where they are laid out
    const bool levels = scene.preparation.levelOfDetail && !options.keepRing && placed.size() > 1 && !pool;
    const Camera camera = makeCamera(scene.camera, scene.image, world.bounds);
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const vdb::Volume& volume = *placed[i].volume;
        if (volume.empty()) continue;
        cloud::Instance& instance = world.instances[i];
        instance.medium = media.make(scene.clouds[i], static_cast<double>(volume.maximum));
        if (!(instance.medium.extinction > 0.0)) continue;
        const glm::dmat3 shape = shapeOf(instance.voxelToMetres);
        const double pixels =
            levels ? voxelPixels(instance, volume.size, camera) : std::numeric_limits<double>::infinity();
        const int longest = glm::compMax(volume.size);
        const int level = levels && std::isfinite(pixels) ? cloud::levelOfDetail(longest, pixels) : 0;
        const auto same = std::ranges::find_if(groups, [&](const Group& group) {
            return group.volume == &volume && group.level == level && areAlike(group.shape, shape);
        });
        if (same == groups.end()) {
            groups.push_back({&volume, shape, level, longest * pixels, {i}});
        } else {
            same->instances.push_back(i);
            same->pixels = std::max(same->pixels, longest * pixels);
        }
    }
    const int most = scene.preparation.maxLeaves;
    const std::vector<int> shares =
        placed.size() > 1 ? shareOutCollectors(groups, roomForCollectors(context, scene.photonMap, options), most)
                          : std::vector<int>(groups.size(), most);
    for (std::size_t number = 0; number < groups.size(); ++number) {
        const Group& group = groups[number];
        options.report("preparing the cloud", 0, 1);
        const std::size_t first = group.instances.front();
        const vdb::Volume coarse = group.level > 0 ? cloud::coarsened(*group.volume, group.level) : vdb::Volume{};
        const vdb::PlacedVolume field =
            group.level > 0 ? vdb::PlacedVolume(coarse, cloud::coarsened(placed[first].toWorld, group.level))
                            : placed[first];
        const double thinner = static_cast<double>(field.volume->maximum) / static_cast<double>(group.volume->maximum);
        cloud::PrepareOptions wanted;
        wanted.preparation = scene.preparation;
        wanted.majorant = scene.photonMap.majorant;
        wanted.keepBlocks = placed.size() > 1;
        wanted.preparation.maxLeaves = shares[number];
        if (placed.size() > 1) wanted.preparation.samples = std::min(wanted.preparation.samples, 16 * shares[number]);
        // Leaves are split until they are optically thin. An asset knows its own size, so that what counts for an
        // instance is its extinction times how much larger it is.
        for (const std::size_t i : group.instances) {
            cloud::Instance& instance = world.instances[i];
            if (group.level > 0) {
                instance.medium.extinction *= thinner;
                instance.voxelToMetres =
                    cloud::coarsened({instance.voxelToMetres, instance.origin}, group.level).linear;
            }
            const double larger = i == first ? 1.0 : edgeOf(instance.voxelToMetres) / edgeOf(field.toWorld.linear);
            wanted.reducedExtinction =
                std::max(wanted.reducedExtinction, larger * reducedExtinction(instance.medium, scene.photonMap.bands));
        }
        world.assets.push_back(std::make_shared<const cloud::Asset>(
            pool ? cloud::prepareBricks(context, *field.bricks, field.toWorld, pool, wanted)
                 : cloud::prepare(context, field, wanted)));
        const cloud::Asset* const asset = world.assets.back().get();
        for (const std::size_t i : group.instances) world.instances[i].asset = asset;
        if (asset->tree.limited && shares[number] == most)
            report.warnings.push_back("samples of the gradient asked for more than " +
                                      std::to_string(scene.preparation.maxLeaves) +
                                      " collectors: light is smeared in those that stay too large; raise "
                                      "preparation.max_leaves or lower preparation.samples");
        stopIfInterrupted();
        options.report("preparing the cloud", 1, 1);
    }
}

}  // namespace lumulus
