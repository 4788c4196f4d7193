#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "gpu/context.h"
#include "light/photon/copy_parts.h"
#include "light/photon/map_part.h"
#include "light/photon/photon_map.h"

namespace lumulus::photon {

/// Gives each part its place among the counts of all: coefficients, then estimates. Returns where those end and, where
/// there are any, the rings about the sun's axis begin.
std::uint32_t layOut(std::vector<MapPart>& parts, int bands);

/// Of all parts, which layOut() has given their places.
std::uint32_t collectorsOf(std::span<const MapPart> parts);

/// Where the counts of the ground begin, where there are any.
std::uint32_t groundBase(std::span<const MapPart> parts, std::uint32_t axisBase);

/// The part of the only instance of a cloud, with the estimates of `options`.
MapPart onlyPart(const cloud::Asset& cloud, const glm::dmat3& voxelToMetres, const Medium& medium,
                 const Options& options);

/// The parts of a map and where its rings about the sun's axis begin.
struct MapPlan {
    std::span<const MapPart> parts;
    std::uint32_t axisBase = 0;
    int bands = 0;
};

/// Of each generation: extinction of each part over that of its medium.
using Extinctions = std::deque<std::vector<double>>;

/// What of the counts of one map another one can go on with. `before[i]`: the part of `old` that part i of `plan` was;
/// none where it is new. A part whose collectors or cells are others is new too.
std::vector<BufferPart> keptCounts(const MapPlan& old, const MapPlan& plan,
                                   std::span<const std::optional<std::size_t>> before);
/// The extinctions of the generations of `old` in the parts of `plan`: 0 of what is new.
Extinctions keptExtinctions(const MapPlan& old, const Extinctions& ofOld, const MapPlan& plan,
                            std::span<const std::optional<std::size_t>> before);

/// Counts of one generation of all parts. Errors: InputError where they do not fit into the budget or the device.
std::uint32_t coefficientsOf(const gpu::Context& context, std::span<const MapPart> parts, const Options& options);

}  // namespace lumulus::photon
