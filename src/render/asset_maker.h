#pragma once

#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "cloud/prepare_programs.h"
#include "render/world.h"
#include "vdb/placed_volume.h"
#include "volume/load.h"

/// Assets of groups of instances (inside render/ only).
namespace lumulus {

/// Detail that an instance needs: a level, and collectors, which are the same for clouds of nearly one size.
struct Detail {
    int level = 0;
    int collectors = std::numeric_limits<int>::max();
    glm::ivec3 parts{1};  ///< of a voxel, along each axis

    bool operator==(const Detail&) const = default;
    /// Whether it is the field itself.
    bool isWhole() const { return level == 0 && parts == glm::ivec3(1); }
};

/// Instances that share an asset.
struct Group {
    const vdb::Volume* volume;
    glm::dmat3 shape;
    Detail detail;
    std::vector<std::size_t> instances;
};

/// Edge of a cube of a voxel's volume [m].
inline double edgeOf(const glm::dmat3& voxelToMetres) {
    return std::cbrt(std::abs(glm::determinant(voxelToMetres)));
}

/// σt'(1−g') where the normalised density is 1 [1/m]: one over the transport mean free path of the truncated medium.
double reducedExtinction(const phase::ScatteringMedium& medium, int bands);

/// Makes the assets of groups, and gives them to their instances.
class AssetMaker {
  public:
    AssetMaker(gpu::Context& context, const scene::Scene& scene, const CloudVolumes& volumes,
               const std::shared_ptr<const gpu::Image>& pool, const WorldOptions& options, World& world,
               WorldReport& report)
        : context_(context),
          scene_(scene),
          volumes_(volumes),
          placed_(volumes.placed()),
          pool_(pool),
          options_(options),
          world_(world),
          report_(report),
          programs_(context) {}

    void make(const std::vector<Group>& groups);

  private:
    /// What an asset is made of.
    struct Plan {
        const Group& group;
        std::optional<vdb::Volume> other;  ///< the field at the group's detail, where that is another one
        AssetOrigin origin;
        float maximum = 0.0F;
        bool fewer = false;  ///< whether the detail has fewer collectors than the scene allows
        std::shared_ptr<const cloud::Asset> asset;
    };

    bool mayKeep(const Group& group) const { return options_.kept != nullptr && group.detail.parts == glm::ivec3(1); }
    const FieldPointer& fieldOf(const Group& group) const {
        return volumes_.volumes[volumes_.clouds[group.instances.front()].volume];
    }
    const vdb::Volume& volumeOf(Plan& plan) const;
    Plan planOf(const Group& group) const;
    void fit(Plan& plan) const;
    void prepare(Plan& plan) const;
    void give(const Plan& plan, bool kept) const;

    gpu::Context& context_;
    const scene::Scene& scene_;
    const CloudVolumes& volumes_;
    std::vector<vdb::PlacedVolume> placed_;
    const std::shared_ptr<const gpu::Image>& pool_;
    const WorldOptions& options_;
    World& world_;
    WorldReport& report_;
    cloud::PreparePrograms programs_;  ///< held for all assets
};

}  // namespace lumulus
