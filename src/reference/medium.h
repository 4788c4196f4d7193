#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "reference/instance_tree.h"
#include "vdb/placed_volume.h"
#include "view/camera.h"

namespace lumulus::reference {

/// A ray in voxel coordinates; `step` is the distance that corresponds to one metre in the world.
struct VoxelRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 step{0.0};

    glm::dvec3 at(double metres) const { return origin + metres * step; }
};

/// Part of a ray, in metres from its origin.
struct Interval {
    double begin = 0.0;
    double end = 0.0;
};

/// The density field of the reference: the floats of the voxels, trilinear between voxel centres, zero outside of the
/// box. Voxel coordinates are those of vdb::Volume.
class DensityField {
  public:
    explicit DensityField(const vdb::Volume& volume);

    const glm::ivec3& size() const { return size_; }
    /// Largest density of a voxel.
    double maximumDensity() const { return maximumDensity_; }

    /// Largest density of the voxels that the interpolated field touches in the box [low, high) of voxel coordinates.
    double maximumWithin(const glm::ivec3& low, const glm::ivec3& high) const;

    /// Density at voxel coordinates within [0, size].
    double density(const glm::dvec3& p) const;

  private:
    std::size_t indexOf(int x, int y, int z) const;

    glm::ivec3 size_;
    double maximumDensity_ = 0.0;
    // Voxels in bricks of 4×2×2, a cache line each, with a ring of zeros around the volume; offsets by coordinate add
    // up to the index.
    std::vector<float> voxels_;
    std::vector<std::size_t> offsetX_, offsetY_, offsetZ_;
};

/// A density field at its place in the world, with its extinction. Media may share a field.
class Medium {
  public:
    /// `extinction` [1/m] at density 1.
    Medium(const vdb::PlacedVolume& cloud, double extinction)
        : Medium(std::make_shared<const DensityField>(*cloud.volume), cloud.toWorld, extinction) {}
    Medium(std::shared_ptr<const DensityField> field, const vdb::Affine& toWorld, double extinction);

    const glm::ivec3& size() const { return field_->size(); }
    double maximumDensity() const { return field_->maximumDensity(); }
    double extinctionScale() const { return extinction_; }
    double maximumWithin(const glm::ivec3& low, const glm::ivec3& high) const {
        return field_->maximumWithin(low, high);
    }
    double density(const glm::dvec3& p) const { return field_->density(p); }

    glm::dvec3 toVoxel(const glm::dvec3& world) const { return toVoxel_ * (world - translation_); }
    /// A vector of the world in voxel coordinates.
    glm::dvec3 stepOf(const glm::dvec3& direction) const { return toVoxel_ * direction; }
    VoxelRay toVoxel(const Ray& ray) const { return {toVoxel(ray.origin), stepOf(ray.direction)}; }

    /// The box in the world that holds the box of the voxels.
    Box box() const;

    /// The part of the ray within the box, from metre 0 on; absent if the ray misses the box.
    std::optional<Interval> clip(const VoxelRay& ray) const;

  private:
    std::shared_ptr<const DensityField> field_;
    double extinction_;
    glm::dmat3 toWorld_;
    glm::dmat3 toVoxel_;
    glm::dvec3 translation_;
};

inline double DensityField::density(const glm::dvec3& p) const {
    // coordinates of the ring, which begins a voxel and a half before the first centre
    const glm::dvec3 q = p + 0.5;
    const auto x = static_cast<std::size_t>(q.x), y = static_cast<std::size_t>(q.y), z = static_cast<std::size_t>(q.z);
    const auto fx = static_cast<float>(q.x - static_cast<double>(x));
    const auto fy = static_cast<float>(q.y - static_cast<double>(y));
    const auto fz = static_cast<float>(q.z - static_cast<double>(z));
    const std::size_t x0 = offsetX_[x], x1 = offsetX_[x + 1];
    const std::size_t y0 = offsetY_[y], y1 = offsetY_[y + 1];
    const std::size_t z0 = offsetZ_[z], z1 = offsetZ_[z + 1];
    const float* v = voxels_.data();
    const auto row = [&](std::size_t offset) {
        const float a = v[offset + x0], b = v[offset + x1];
        return a + fx * (b - a);
    };
    const float near0 = row(y0 + z0), near1 = row(y1 + z0), far0 = row(y0 + z1), far1 = row(y1 + z1);
    const float near = near0 + fy * (near1 - near0), far = far0 + fy * (far1 - far0);
    return static_cast<double>(near + fz * (far - near));
}

/// A part of a ray in which σt is taken as constant.
struct OpticalPiece {
    Interval interval;
    double depth = 0.0;  ///< optical, above 0
};

/// The optical depth along the ray without noise, in pieces, nearest first: between voxel centres the trilinear density
/// is a cubic polynomial in t, which Gauss's two points integrate exactly. Up to `limit` metres, or to where nothing
/// passes.
std::vector<OpticalPiece> opticalPieces(const Medium& medium, const VoxelRay& ray,
                                        double limit = std::numeric_limits<double>::infinity());

/// What a ray meets on its whole way.
struct LineIntegrals {
    double transmittance = 1.0;
    double distance = 0.0;  ///< ∫ t T σt dt, metres from the ray's origin: over 1 − T, the mean distance
};

/// Integrals along a ray through media whose pieces are given, each list in order. Media that overlap add up.
LineIntegrals integrateAlong(std::span<const std::vector<OpticalPiece>> media);

/// Metres from the ray's origin to the first point with density; absent if there is none.
std::optional<double> frontAlong(const Medium& medium, const VoxelRay& ray);

}  // namespace lumulus::reference
