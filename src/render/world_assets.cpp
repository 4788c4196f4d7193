#include "render/world_assets.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <limits>

#include "cloud/bricks.h"
#include "cloud/level_of_detail.h"
#include "cloud/refined.h"
#include "frame/view_params.h"
#include "light/photon/map_limits.h"
#include "render/asset_maker.h"
#include "view/camera.h"
#include "volume/load.h"

namespace lumulus {

namespace {

constexpr double degrees = 3.14159265358979323846 / 180.0;
/// Metrics of voxels that differ by less have the same shape: rounding of rotations.
constexpr double sameShape = 1e-6;
/// Texels of shadow volumes whose voxels are smaller than a pixel are so many times as wide across the light.
constexpr int smallTexel = 2;
/// Cells of light fields that few photons fill are no larger than so many pixels, but where there would be fewer along
/// the longest side than these.
constexpr double cellPixels = 2.0, leastCells = 4.0;
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

/// Media of the same phase function and albedo share their tables.
class MediumMaker {
  public:
    MediumMaker(const scene::PhotonMap& map, const scene::Sun& sun) : map_(map), sun_(sun) {}

    phase::ScatteringMedium make(const scene::Cloud& from, double maximum) {
        auto known = std::ranges::find_if(
            known_, [&](const Known& k) { return k.cloud->phase == from.phase && k.cloud->albedo == from.albedo; });
        if (known == known_.end()) {
            known_.push_back({&from, phase::makeScatteringTables(from.phase, map_.forwardCut * degrees, from.albedo,
                                                                 map_.bands, sun_.angularDiameter * degrees)});
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
    const scene::PhotonMap& map_;
    const scene::Sun& sun_;
    std::vector<Known> known_;
};

/// Sizes in the picture [pixels] that take the same number of collectors differ by this factor at most.
constexpr double sameSize = 1.5;

/// Of an instance at its nearest point [pixels]; infinite where the camera is in it or close.
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

Detail detailFor(double voxel, const glm::ivec3& size) {
    if (std::isinf(voxel)) return {};
    const double across = voxel * glm::compMax(size);
    const double rounded = std::pow(sameSize, std::ceil(std::log(std::max(across, 1.0)) / std::log(sameSize)));
    return {cloud::levelOfDetail(glm::compMax(size), voxel), cloud::collectorsFor(rounded)};
}

/// Lowers the collectors of several clouds to what the scene's photon map has room for.
void fitCollectors(const gpu::Context& context, const scene::Scene& scene, const WorldOptions& options,
                   const World& world, std::vector<Group>& groups) {
    constexpr int fewest = 30;
    const scene::PhotonMap& map = world.photonMap;
    const photon::MapSize size{0, map.bands, map.generations, options.keepRing, options.progressive, 0};
    const auto room = static_cast<double>(photon::mostCollectors(
        size, static_cast<std::uint64_t>(std::ldexp(map.memoryBudget, 20)), context.limits().maxStorageBufferRange));
    double wanted = 0.0;
    for (Group& group : groups) {
        group.detail.collectors = std::min(group.detail.collectors, scene.preparation.maxLeaves);
        wanted += static_cast<double>(group.instances.size()) * group.detail.collectors;
    }
    if (wanted <= room) return;
    for (Group& group : groups)
        group.detail.collectors = std::max(std::min(fewest, group.detail.collectors),
                                           static_cast<int>(room / wanted * group.detail.collectors));
}

/// The scene's, but where voxels of a cloud are flat and so thick that they are divided.
scene::PhotonMap photonMapFor(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& placed) {
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const vdb::Volume& volume = *placed[i].volume;
        const double extinction =
            scene.clouds[i].extinction * scene.clouds[i].densityScale * static_cast<double>(volume.maximum);
        if (!volume.empty() && cloud::refinement(volume.size, placed[i].toWorld.linear, extinction) != glm::ivec3(1))
            return cloud::forFlatVoxels(scene.photonMap);
    }
    return scene.photonMap;
}

}  // namespace

std::shared_ptr<const gpu::Image> makePool(gpu::Context& context, std::vector<vdb::SparseVolume>& bricks,
                                           const Check& check) {
    std::vector<vdb::SparseVolume*> volumes;
    for (vdb::SparseVolume& volume : bricks)
        if (!volume.empty()) volumes.push_back(&volume);
    return volumes.empty() ? nullptr : cloud::makePool(context, volumes, check);
}

void setSubstance(cloud::Instance& instance, const scene::PhotonMap& map, const scene::Cloud& cloud,
                  const scene::Sun& sun) {
    const double extinction = instance.medium.extinction;
    instance.medium = MediumMaker(map, sun).make(cloud, 1.0);
    instance.medium.extinction = extinction;
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

void prepareAssets(gpu::Context& context, const scene::Scene& scene, const CloudVolumes& volumes,
                   const std::shared_ptr<const gpu::Image>& pool, const WorldOptions& options, World& world,
                   WorldReport& report) {
    const std::vector<vdb::PlacedVolume> placed = volumes.placed();
    std::vector<Group> groups;
    world.photonMap = photonMapFor(scene, placed);
    MediumMaker media(world.photonMap, world.lights.sun);
    std::vector<std::size_t> visible;
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const vdb::Volume& volume = *placed[i].volume;
        if (volume.empty()) continue;
        phase::ScatteringMedium& medium = world.instances[i].medium;
        medium = media.make(scene.clouds[i], static_cast<double>(volume.maximum));
        if (medium.extinction > 0.0) visible.push_back(i);
    }
    const bool levels = scene.preparation.levelOfDetail && !options.keepRing && visible.size() > 1;
    world.levelsOfDetail = levels;
    const Camera camera = makeCamera(scene.camera, scene.image, world.bounds);
    for (const std::size_t i : visible) {
        const vdb::Volume& volume = *placed[i].volume;
        const cloud::Instance& instance = world.instances[i];
        const glm::dmat3 shape = shapeOf(instance.voxelToMetres);
        Detail detail;
        if (levels) {
            const double voxel = voxelPixels(instance, volume.size, camera);
            detail = detailFor(voxel, volume.size);
            const double thickness = instance.medium.extinction * edgeOf(instance.voxelToMetres);
            detail.level = std::min(detail.level, cloud::levelOfThickness(thickness));
            if (std::ldexp(voxel, detail.level) <= 1.0) world.light[i].shadowTexel = smallTexel;
            world.light[i].fewestCells =
                std::clamp(voxel * glm::compMax(volume.size) / cellPixels, leastCells, light::fewestLightCells);
        }
        if (!pool && detail.level == 0)
            detail.parts = cloud::refinement(volume.size, instance.voxelToMetres, instance.medium.extinction);
        if (pool) detail.level = 0;  // bricks have levels of their own, which are chosen where they are laid out
        const auto same = std::ranges::find_if(groups, [&](const Group& group) {
            return group.volume == &volume && group.detail == detail && areAlike(group.shape, shape);
        });
        if (same == groups.end())
            groups.push_back({&volume, shape, detail, {i}});
        else
            same->instances.push_back(i);
    }
    if (visible.size() > 1) fitCollectors(context, scene, options, world, groups);
    AssetMaker(context, scene, volumes, pool, options, world, report).make(groups);
}

}  // namespace lumulus
