#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "cloud/asset.h"
#include "shared/world.h"

namespace lumulus::photon {

/// An ellipsoid along the edges of a volume that holds all density of an asset. Voxel coordinates.
struct Ellipsoid {
    glm::dvec3 middle{0.0}, radii{1.0};
};
Ellipsoid ellipsoidOf(const cloud::Asset& asset);

/// The ellipsoid in the world: columns are its axes [m]. The area that it shows in a direction is at most
/// largestArea().
struct PlacedEllipsoid {
    glm::dmat3 axes{1.0};
    glm::dvec3 middle{0.0};

    double largestArea() const;
    double meanArea() const;
    glm::dvec3 reach() const;  ///< half the box round it [m]
};

/// What the GPU reads: `shares` sum up to 1 and are above 0, `corner` is where lengths begin.
std::vector<shared::EntryDisc> entryDiscs(std::span<const PlacedEllipsoid> ellipsoids, std::span<const double> shares,
                                          const glm::dvec3& corner);

/// Walker's alias table (Walker 1977, by Vose's construction 1991).
struct AliasTable {
    std::vector<double> keep;
    std::vector<std::size_t> other;
};
AliasTable makeAliasTable(std::span<const double> shares);

}  // namespace lumulus::photon
