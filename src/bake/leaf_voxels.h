#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "light/photon/leaf_light.h"

namespace lumulus::bake {

/// A box of voxels along the axes of the world.
struct VoxelBox {
    double voxel = 1.0;   ///< edge [m]
    glm::ivec3 first{0};  ///< the middle of voxel (i, j, k) is (i, j, k) times the edge
    glm::ivec3 size{0};

    std::size_t count() const {
        return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
    }
    /// x slowest.
    std::size_t indexOf(const glm::ivec3& place) const {
        const glm::ivec3 at = place - first;
        return (static_cast<std::size_t>(at.x) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(at.y)) *
                   static_cast<std::size_t>(size.z) +
               static_cast<std::size_t>(at.z);
    }
    glm::ivec3 placeOf(std::size_t index) const;
};

/// Harmonics of the light in voxels, by their index in the box; `number` is −1 where there is none.
struct VoxelHarmonics {
    VoxelBox box;
    std::vector<std::int32_t> number;                       ///< of each voxel of the box
    std::vector<std::array<glm::dvec3, 9>> coefficients{};  ///< as LeafLight
};

/// The voxels of this edge that leaves reach, with a margin of one. Errors: InputError where they are too many.
VoxelBox boxOf(std::span<const photon::LeafLight> leaves, double voxel);

/// Light of leaves on voxels that have some and those that touch one, if only at a corner: the mean over the ∫ σt dV of
/// the leaves in the voxel and, with weights of ½, ¼ and ⅛, in those at its faces, edges and corners. Errors:
/// InputError where voxels with light are too many; what `check` throws.
VoxelHarmonics spread(std::span<const photon::LeafLight> leaves, const VoxelBox& box, const Check& check);

}  // namespace lumulus::bake
