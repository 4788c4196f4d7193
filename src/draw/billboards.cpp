#include "draw/billboards.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/billboards.comp.h"
}  // namespace spirv

/// Radius of a billboard against that of the sphere with its leaf's volume: neighbours overlap and no holes show.
constexpr double overlap = 1.3;

}  // namespace

std::vector<shared::Billboard> makeBillboards(const cloud::Cloud& cloud, double extinction, const Camera& camera) {
    struct Placed {
        double order;
        shared::Billboard billboard;
    };
    std::vector<Placed> placed;
    placed.reserve(cloud.collectors.size());
    const bool parallel = camera.projection == scene::Projection::orthographic;
    for (std::size_t i = 0; i < cloud.collectors.size(); ++i) {
        const cloud::Collector& collector = cloud.collectors[i];
        const glm::dvec3 centre = cloud.toWorld.point(glm::dvec3(collector.centre)) - camera.position;
        const glm::dvec3 extent = glm::dvec3(collector.box.upper - collector.box.lower);
        const double volume = extent.x * extent.y * extent.z * cloud.voxelVolume;
        const double radius = overlap * std::cbrt(volume * 3.0 / (4.0 * std::numbers::pi));
        const double mass = extinction * static_cast<double>(collector.mass) * cloud.voxelVolume;
        const double order = parallel ? glm::dot(centre, camera.axes[2]) : glm::dot(centre, centre);
        placed.push_back({order,
                          {glm::vec3(centre), static_cast<float>(radius),
                           static_cast<float>(mass * 3.0 / (4.0 * std::numbers::pi * radius * radius * radius)),
                           static_cast<std::uint32_t>(i)}});
    }
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return a.order < b.order || (a.order == b.order && a.billboard.collector < b.billboard.collector);
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

void Billboards::prepare(const Camera& camera, double extinction) {
    const std::vector<shared::Billboard> billboards = makeBillboards(cloud_, extinction, camera);
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
