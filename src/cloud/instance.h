#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <string>

#include "cloud/asset.h"
#include "cloud/voxel_shape.h"
#include "medium/scattering_medium.h"
#include "view/bounds.h"

namespace lumulus::cloud {

/// One cloud of the world: an asset, where it stands and what it is made of. The light in it belongs to it too
/// (light::InstanceLight) and is kept beside it.
struct Instance {
    std::string name;               ///< by which scenes and clients name it
    const Asset* asset = nullptr;   ///< null: nothing is there (no voxel, or an extinction of 0)
    glm::dmat3 voxelToMetres{1.0};  ///< edges of a voxel [m]: the asset's, rotated, mirrored or scaled
    glm::dvec3 origin{0.0};         ///< where the corner of voxel (0,0,0) lies [m], without the offset
    glm::dvec3 offset{0.0};         ///< by which it has moved since the scene was made [m]
    Bounds bounds;                  ///< of the density, without the offset
    phase::ScatteringMedium medium;
    double sceneExtinction = 0.0;  ///< `extinction` of the scene [1/m]; the medium's is in proportion

    glm::dvec3 toWorld(const glm::dvec3& voxel) const { return voxelToMetres * voxel + (origin + offset); }
    glm::dvec3 toVoxel(const glm::dvec3& world) const {
        return glm::inverse(voxelToMetres) * (world - (origin + offset));
    }
    glm::dvec3 middle() const { return toWorld(0.5 * glm::dvec3(asset->size)); }
    /// Edge of a cube of a voxel's volume [m].
    double voxelEdge() const { return std::cbrt(std::abs(glm::determinant(voxelToMetres))); }
    /// Whether the edges of its voxels differ, as those of cloud-resolving simulations do.
    bool isFlat() const { return hasFlatVoxels(voxelToMetres); }
    /// Smallest width of a voxel seen from this place [m]: a picture changes from voxel to voxel across it.
    double voxelWidth(const glm::dvec3& eye) const {
        if (!isFlat()) return voxelEdge();
        const glm::dvec3 away = middle() - eye;
        return glm::length(away) > 0.5 * diagonal() ? smallestWidth(voxelToMetres, away) : shortestEdge(voxelToMetres);
    }
    /// How much larger it is than its asset.
    double scale() const { return voxelEdge() / std::cbrt(asset->voxelVolume); }
    /// Metres from corner to opposite corner of the volume.
    double diagonal() const { return glm::length(voxelToMetres * glm::dvec3(asset->size)); }
};

}  // namespace lumulus::cloud
