#include "light/photon/world_walk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "gpu/transfer.h"
#include "light/photon/entry_grid.h"

namespace lumulus::photon {

namespace {

namespace spirv {
#include "spirv/photon/trace_world.comp.h"
}  // namespace spirv

double forwardOf(const Medium& medium) {
    return static_cast<double>(medium.tables.forwardFraction);
}
double leastAlbedo(const Medium& medium) {
    return std::min(medium.albedo.x, std::min(medium.albedo.y, medium.albedo.z));
}

/// Collisions that change nothing for any colour are left out.
double collisionCoefficient(const Medium& medium, double extinction) {
    return extinction * (1.0 - forwardOf(medium) * leastAlbedo(medium));
}

/// A buffer that shaders see as texels.
template <class Values>
gpu::Buffer texelBuffer(gpu::Context& context, const char* name, const Values& values, VkFormat format) {
    std::uint64_t texel = 0;
    for (const auto& [known, bytes] : gpu::texelSizes)
        if (known == format) texel = bytes;
    const std::uint64_t bytes = values.size() * sizeof(values[0]);
    gpu::Buffer buffer(context, name, std::max<std::uint64_t>(1, bytes / texel), format, gpu::Memory::device);
    if (!values.empty()) gpu::upload(context, buffer, values);
    return buffer;
}

/// The part of the walk's place among all that does not depend on where the instance is.
shared::WalkedInstance walkedMedium(const MapPart& part, double extinction, int phaseTable) {
    shared::WalkedInstance walked{};
    const Medium& medium = part.medium;
    const double f = forwardOf(medium), least = leastAlbedo(medium);
    walked.size = glm::vec3(part.asset->size);
    walked.extinction = static_cast<float>(collisionCoefficient(medium, extinction));
    walked.phaseTable = static_cast<float>(phaseTable);
    walked.asymmetry = medium.tables.g;
    walked.albedo = glm::vec3(medium.albedo);
    walked.scatterShare = static_cast<float>((1.0 - f) / (1.0 - f * least));
    walked.straightWeight = least < 1.0 ? glm::vec3((medium.albedo - least) / (1.0 - least)) : glm::vec3(0.0F);
    walked.scatterFraction = static_cast<float>(1.0 - f);
    walked.estimatorEdge = static_cast<float>(part.estimates.edge);
    walked.estimatorCells = glm::vec3(part.estimates.cells);
    walked.estimatorBase = part.estimatorBase;
    walked.firstCollector = part.firstCollector;
    walked.collectors = part.collectors;
    return walked;
}

}  // namespace

WorldWalk::WorldWalk(gpu::Context& context, std::span<const MapPart> parts, const cloud::SharedVolumes& volumes)
    : context_(context),
      parts_(parts),
      volumes_(volumes),
      inverseCdf_(context, "inverse cdf", 0, gpu::Memory::device),
      gridParams_(context, "merged grid", sizeof(shared::MergedGridParams), gpu::Memory::host) {
    std::vector<const phase::SharedTable*> tables;
    for (const MapPart& part : parts) {
        ellipsoids_.push_back(ellipsoidOf(*part.asset));
        const phase::SharedTable& table = part.medium.tables.inverseCdf;
        phaseTables_.push_back(-1);
        if (table.empty()) continue;
        const auto same = std::ranges::find_if(tables, [&](const auto* other) { return *other == table; });
        phaseTables_.back() = static_cast<int>(same - tables.begin()) * static_cast<int>(table.size());
        if (same == tables.end()) tables.push_back(&table);
    }
    for (const auto* table : tables) inverseCdfs_.insert(inverseCdfs_.end(), table->begin(), table->end());
    if (!inverseCdfs_.empty()) inverseCdf_ = gpu::filledBuffer(context, "inverse cdf", inverseCdfs_);
}

std::span<const std::uint32_t> WorldWalk::spirv() const {
    return spirv::trace_world_comp;
}

std::vector<gpu::SpecConstant> WorldWalk::constants(bool air) const {
    const auto any = [&](auto&& is) {
        return std::ranges::any_of(parts_, [&](const MapPart& p) { return is(p.medium); });
    };
    return {gpu::SpecConstant::of(0, !any([](const Medium& m) { return !m.tables.analyticHg; })),
            gpu::SpecConstant::of(1, any([](const Medium& m) { return m.tables.forwardFraction > 0.0F; })),
            gpu::SpecConstant::of(2, any([](const Medium& m) { return leastAlbedo(m) < 1.0; })),
            gpu::SpecConstant::of(4, any([](const Medium& m) { return !m.tables.axisTable.empty(); })),
            gpu::SpecConstant::of(5, air),
            gpu::SpecConstant::of(15, volumes_.sparse())};
}

/// Clouds that move together move the grid with them.
void WorldWalk::place(std::span<const Placement> places) {
    const auto unmoved = [&](const Placement& now, const Placement& before) {
        return now.origin - places.front().origin == before.origin - madeFor_.front().origin &&
               now.extinction == before.extinction && now.sunShare == before.sunShare;
    };
    if (std::ranges::equal(places, madeFor_, unmoved)) {
        grid_.origin += places.front().origin - madeFor_.front().origin;
        madeFor_.assign(places.begin(), places.end());
        return;
    }
    madeFor_.assign(places.begin(), places.end());
    makeDiscs(places);
    makeInstances(places);
}

/// Ellipsoids and the grid round all of them.
void WorldWalk::makeDiscs(std::span<const Placement> places) {
    std::vector<cloud::MergedSource> sources;
    std::vector<PlacedEllipsoid> ellipsoids;
    std::vector<double> shares;
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    largestWeight_ = area_ = 0.0;
    meanWeights_.clear();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const MapPart& part = parts_[i];
        sources.push_back({part.asset, part.voxelToMetres, places[i].origin,
                           collisionCoefficient(part.medium, places[i].extinction)});
        const Ellipsoid& local = ellipsoids_[i];
        const PlacedEllipsoid placed{
            glm::dmat3(part.voxelToMetres[0] * local.radii.x, part.voxelToMetres[1] * local.radii.y,
                       part.voxelToMetres[2] * local.radii.z),
            places[i].origin + part.voxelToMetres * local.middle};
        ellipsoids.push_back(placed);
        shares.push_back(part.share);
        lower = glm::min(lower, placed.middle - placed.reach());
        upper = glm::max(upper, placed.middle + placed.reach());
        largestWeight_ = std::max(largestWeight_, placed.largestArea() / part.share);
        meanWeights_.push_back(placed.meanArea() / part.share);
        area_ += placed.largestArea();
    }
    const double edge = cloud::mergedCellEdge(sources, lower, upper);
    lower -= 0.01 * edge;
    upper += 0.01 * edge;
    grid_ = cloud::mergeGrids(sources, lower, upper, edge);
    const EntryGrid entries = makeEntryGrid(ellipsoids, lower, upper);
    bricks_.reset(), cells_.reset(), lists_.reset(), discs_.reset(), entries_.reset();
    bricks_.emplace(texelBuffer(context_, "merged bricks", grid_.numbers, VK_FORMAT_R32_UINT));
    cells_.emplace(texelBuffer(context_, "merged cells", grid_.cells, VK_FORMAT_R32G32_UINT));
    lists_.emplace(texelBuffer(context_, "lists of instances", grid_.lists, VK_FORMAT_R32_UINT));
    discs_.emplace(texelBuffer(context_, "entry discs", entryDiscs(ellipsoids, shares, grid_.origin),
                               VK_FORMAT_R32G32B32A32_SFLOAT));
    entries_.emplace(texelBuffer(context_, "entry lists", entries.lists, VK_FORMAT_R32_UINT));
    gridParams_.mapped<shared::MergedGridParams>()[0] = {grid_.bricks,
                                                         static_cast<std::uint32_t>(parts_.size()),
                                                         static_cast<float>(grid_.edge),
                                                         static_cast<float>(largestWeight_),
                                                         entries.cells,
                                                         static_cast<float>(entries.edge),
                                                         0U};
}

void WorldWalk::makeInstances(std::span<const Placement> places) {
    std::vector<shared::WalkedInstance> walked;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const MapPart& part = parts_[i];
        shared::WalkedInstance instance = walkedMedium(part, places[i].extinction, phaseTables_[i]);
        const glm::dmat3 toVoxel = glm::inverse(part.voxelToMetres);
        const glm::dvec3 middle = places[i].origin + part.voxelToMetres * (0.5 * glm::dvec3(part.asset->size));
        const glm::dvec3 base = glm::floor((middle - grid_.origin) / grid_.edge);
        const glm::dvec3 there = toVoxel * (grid_.origin + base * grid_.edge - places[i].origin);
        for (int row = 0; row < 3; ++row)
            instance.toVoxel[row] = glm::vec4(glm::dvec4(toVoxel[0][row] * grid_.edge, toVoxel[1][row] * grid_.edge,
                                                         toVoxel[2][row] * grid_.edge, there[row]));
        instance.base = glm::vec3(base);
        instance.volume = volumes_.place(i);
        instance.sunShare = glm::vec3(places[i].sunShare);
        walked.push_back(instance);
    }
    instances_.reset();
    instances_.emplace(texelBuffer(context_, "walked instances", walked, VK_FORMAT_R32G32B32A32_SFLOAT));
}

void WorldWalk::setParams(shared::TraceParams& params) const {
    params.cells = grid_.bricks * shared::MERGED_BRICK;
    params.cellSize = glm::vec3(static_cast<float>(grid_.edge));  // of places in metres
    params.worldToCells = glm::mat3(static_cast<float>(1.0 / grid_.edge));
}

std::vector<gpu::Binding> WorldWalk::bindings() const {
    return {{"density", volumes_.density(), gpu::Sampler::nearest},
            {"bricks", volumes_.brickIndex(), gpu::Sampler::nearest},
            {"collectorIndex", volumes_.collectorIndex(), gpu::Sampler::nearest},
            {"Grid", gridParams_},
            {"InverseCdf", inverseCdf_},
            {"mergedBricks", *bricks_},
            {"mergedCells", *cells_},
            {"lists", *lists_},
            {"walkedInstances", *instances_}};
}

std::vector<gpu::Binding> WorldWalk::entryBindings() const {
    return {{"Grid", gridParams_}, {"entryDiscs", *discs_}, {"entryLists", *entries_}};
}

void WorldWalk::setStarts(std::uint32_t starts) const {
    gridParams_.mapped<shared::MergedGridParams>()[0].starts = starts;
}

}  // namespace lumulus::photon
