#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "shared/cloud.h"

namespace lumulus::cloud {

/// One sample of the gradient field.
struct Sample {
    glm::vec3 position;  ///< voxel coordinates
    float density;       ///< of the maximum, 0…1
};

/// Mean density of boxes of voxels, at the resolution of blocks, by a summed volume table in double.
class BlockDensity {
  public:
    /// `density` holds size.x·size.y·size.z values, x fastest; means come out divided by `maximum`.
    /// Where a value stands for `scale` voxels along each axis, boxes count in those voxels.
    /// Errors: what `check` throws, which several threads ask at once.
    BlockDensity(std::span<const float> density, const glm::ivec3& size, float maximum, int scale = 1,
                 const Check& check = stopIfInterrupted);
    /// Mean over the blocks that the box touches.
    double mean(const shared::LeafBox& box) const;

  private:
    glm::ivec3 blocks_;
    glm::ivec3 size_;
    int scale_;
    std::vector<double> sums_;  // (blocks + 1)³ prefix sums
    double prefix(int x, int y, int z) const;
};

struct KdTreeOptions {
    double densityThreshold = 0.1;    ///< stop where the samples' densities differ by less, of the maximum
    glm::dvec3 influenceRadius{2.0};  ///< of a sample, in voxels along each axis
    int maxLeaves = 32768;            ///< never exceeded
    glm::dvec3 voxelEdge{1.0};        ///< metres along each axis of the volume
    double reducedExtinction = 0.0;   ///< σt'(1−g') at the maximum density [1/m]; 0: optical size does not count
    double opticalLimit = 1.0;        ///< a leaf whose reduced optical thickness is larger is split further
    const BlockDensity* density = nullptr;  ///< needed where reducedExtinction is not 0
    Check check = stopIfInterrupted;        ///< asked between pieces of the work, by several threads at once
};

struct KdNode {
    int axis = -1;  ///< −1: a leaf
    int plane = 0;  ///< voxel boundary: coordinates below it belong to the first child
    int child[2] = {-1, -1};
    int leaf = -1;        ///< number of the leaf
    bool median = false;  ///< split at the sample median (not by finalisation or optical size)
};

/// Leaves tile the box [0,size) without gap or overlap.
struct KdTree {
    std::vector<KdNode> nodes;  ///< root first
    std::vector<shared::LeafBox> leaves;
    bool limited = false;  ///< samples asked for more than maxLeaves

    /// Leaf of a voxel inside the box, by walking the tree.
    int find(const glm::ivec3& voxel) const;
};

/// Builds the tree over the samples (Elek 2011, 5.3): split at the sample median, snapped to a voxel boundary, on the
/// axis that minimises the variance of density in the two parts; finalisation splits off space that no sample's radius
/// of influence covers; optically large leaves are split in the middle. Deterministic; parallel over the nodes of a
/// level.
KdTree buildKdTree(std::vector<Sample> samples, const glm::ivec3& size, const KdTreeOptions& options);

}  // namespace lumulus::cloud
