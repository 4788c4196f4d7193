#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/context.h"
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

/// Counts of one generation of all parts. Errors: InputError where they do not fit into the budget or the device.
std::uint32_t coefficientsOf(const gpu::Context& context, std::span<const MapPart> parts, const Options& options);

}  // namespace lumulus::photon
