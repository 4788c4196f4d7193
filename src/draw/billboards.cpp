#include "draw/billboards.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/billboards.comp.h"
}  // namespace spirv

/// Radius of a billboard against that of the sphere with the volume that its leaf's density takes up: neighbours
/// overlap and no holes show. A sphere as large as the whole leaf would stand out of the cloud at its edge, where it
/// glows with the sun behind.
constexpr double overlap = 1.1;

/// Voxels of the leaf that hold density; no fewer than its mass fills at the greatest density, 1.
double filledVoxels(const cloud::Collector& collector) {
    return std::max(collector.occupiedVoxels(), static_cast<double>(collector.mass));
}

}  // namespace

std::vector<shared::Billboard> makeBillboards(const cloud::Cloud& cloud, double extinction, const Camera& camera,
                                              std::span<const float> sunDepths) {
    struct Placed {
        double order;
        std::size_t collector;
        shared::Billboard billboard;
    };
    std::vector<Placed> placed;
    placed.reserve(cloud.collectors.size());
    const bool parallel = camera.projection == scene::Projection::orthographic;
    for (std::size_t i = 0; i < cloud.collectors.size(); ++i) {
        const cloud::Collector& collector = cloud.collectors[i];
        const glm::dvec3 centre = cloud.toWorld.point(glm::dvec3(collector.centre)) - camera.position;
        const double radius =
            overlap * std::cbrt(filledVoxels(collector) * cloud.voxelVolume * 3.0 / (4.0 * std::numbers::pi));
        const double mass = extinction * static_cast<double>(collector.mass) * cloud.voxelVolume;
        const double order = parallel ? glm::dot(centre, camera.axes[2]) : glm::dot(centre, centre);
        placed.push_back({order,
                          i,
                          {glm::vec3(centre), static_cast<float>(radius),
                           static_cast<float>(mass * 3.0 / (4.0 * std::numbers::pi * radius * radius * radius)),
                           sunDepths.empty() ? 0.0F : sunDepths[i]}});
    }
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return a.order < b.order || (a.order == b.order && a.collector < b.collector);
    });
    std::vector<shared::Billboard> billboards;
    billboards.reserve(placed.size());
    for (const Placed& p : placed) billboards.push_back(p.billboard);
    return billboards;
}

Billboards::Billboards(gpu::Context& context, const cloud::Cloud& cloud, const DrawFeatures& features)
    : context_(context),
      cloud_(cloud),
      program_(context, "billboards", spirv::billboards_comp, features.constants()),
      billboards_(context, "billboards", 0, gpu::Memory::device),
      offsets_(context, "tile offsets", 0, gpu::Memory::device),
      lists_(context, "tile lists", 0, gpu::Memory::device) {}

void Billboards::prepare(const Camera& camera, double extinction, std::span<const float> sunDepths) {
    const std::vector<shared::Billboard> billboards = makeBillboards(cloud_, extinction, camera, sunDepths);
    tiles_ = makeTileLists(camera, billboards);
    billboards_ = filledBuffer(context_, "billboards", billboards);
    offsets_ = filledBuffer(context_, "tile offsets", tiles_.offsets);
    lists_ = filledBuffer(context_, "tile lists", tiles_.lists);
}

void Billboards::record(gpu::Commands& commands, const FrameInputs& inputs, const shared::DrawParams& values) const {
    std::vector<gpu::Binding> bindings = inputs.bindings();
    bindings.emplace_back("Billboards", billboards_);
    bindings.emplace_back("TileOffsets", offsets_);
    bindings.emplace_back("TileLists", lists_);
    commands.pass("billboards");
    commands.dispatch(program_, bindings, {}, bandGroups(values));
}

}  // namespace lumulus::draw
