#pragma once

#include <vector>

#include "cloud/asset.h"
#include "gpu/context.h"

namespace lumulus::draw {

/// Radius of a collector's billboard [m]: its sphere has BILLBOARD_OVERLAP times the volume that is filled in the leaf.
double billboardRadius(const cloud::Asset& cloud, const cloud::Collector& collector);

/// One a collector: what part of the cloud's density its billboard has, so that the rays from all sides find the mass
/// of its leaf in it. About 1/BILLBOARD_OVERLAP inside of the cloud and more at its edge, where fewer overlap.
std::vector<float> billboardShares(gpu::Context& context, const cloud::Asset& cloud);

}  // namespace lumulus::draw
