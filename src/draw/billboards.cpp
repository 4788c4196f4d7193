#include "draw/billboards.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gpu/transfer.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/billboards.comp.h"
}  // namespace spirv

/// Radius of a billboard against that of the sphere with its leaf's volume: neighbours overlap and no holes show.
constexpr double overlap = 1.3;

template <class Values>
gpu::Buffer filledBuffer(gpu::Context& context, const char* name, const Values& values) {
    gpu::Buffer buffer(context, name, values.size() * sizeof(values[0]), gpu::Memory::device);
    if (!values.empty()) gpu::upload(context, buffer, values);
    return buffer;
}

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

PhaseBuffers::PhaseBuffers(gpu::Context& context, const phase::ScatteringTables& tables)
    : phase(filledBuffer(context, "phase table", tables.phaseTable)),
      before(filledBuffer(context, "one turn H", tables.oneTurnH)),
      after(filledBuffer(context, "one turn K", tables.oneTurnK)) {}

Billboards::Billboards(gpu::Context& context, const cloud::Cloud& cloud, const DrawFeatures& features)
    : context_(context),
      cloud_(cloud),
      program_(context, "billboards", spirv::billboards_comp,
               {gpu::SpecConstant::of(0, features.oneTurn), gpu::SpecConstant::of(1, features.sun),
                gpu::SpecConstant::of(2, features.photons)}),
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

void Billboards::record(gpu::Commands& commands, const gpu::Buffer& params, const shared::DrawParams& values,
                        const gpu::Buffer& radiance, const gpu::Buffer& sunDepths, const PhaseBuffers& phase,
                        const gpu::Buffer& pixels) const {
    commands.pass("billboards");
    commands.dispatch(program_,
                      {{"Params", params},
                       {"Billboards", billboards_},
                       {"TileOffsets", offsets_},
                       {"TileLists", lists_},
                       {"Radiance", radiance},
                       {"SunDepths", sunDepths},
                       {"PhaseTable", phase.phase},
                       {"OneTurnH", phase.before},
                       {"OneTurnK", phase.after},
                       {"Pixels", pixels}},
                      {},
                      {(static_cast<std::uint32_t>(values.view.size.x) + 15) / 16,
                       (static_cast<std::uint32_t>(values.rows) + 3) / 4, 1});
}

}  // namespace lumulus::draw
