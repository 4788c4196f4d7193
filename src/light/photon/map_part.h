#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "cloud/asset.h"
#include "medium/scattering_medium.h"

namespace lumulus::photon {

using Medium = phase::ScatteringMedium;

/// What a photon map keeps for one instance.
struct MapPart {
    const cloud::Asset* asset = nullptr;  ///< outlives the map
    Medium medium;                        ///< collectors' masses are those of its extinction
    glm::dmat3 voxelToMetres{1.0};        ///< edges of a voxel of the instance
    /// Cells in which the luminance of scattering events is counted, whatever its direction: finer than collectors can
    /// be.
    cloud::CellGrid estimates;
    double share = 1.0;    ///< probability that a photon begins round this instance
    bool collects = true;  ///< false: photons collide in it, and nothing is kept
    // where its counts are among those of all, which the map fills in
    std::uint32_t firstCollector = 0;
    std::uint32_t collectors = 0;
    std::uint32_t estimatorBase = 0;

    /// From ∫ normalised density dV [voxels] to ∫ σt' dV [m²].
    double massScale() const {
        return medium.extinction * (1.0 - static_cast<double>(medium.tables.forwardFraction)) *
               std::abs(glm::determinant(voxelToMetres));
    }
};

/// Where an instance is now, and what it and its light are like.
struct Placement {
    glm::dvec3 origin{0.0};    ///< corner of voxel (0,0,0) [m]
    double extinction = 0.0;   ///< σt at density 1 [1/m]
    glm::dvec3 sunShare{1.0};  ///< of the sun's light that reaches it

    bool operator==(const Placement&) const = default;
};

}  // namespace lumulus::photon
