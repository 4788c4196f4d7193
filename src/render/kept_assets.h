#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cloud/asset.h"
#include "cloud/shared_volumes.h"
#include "query/bricks.h"
#include "render/kept_clouds.h"
#include "scene/scene.h"
#include "sky/environment.h"
#include "vdb/sparse_volume.h"
#include "vdb/volume.h"

/// What is in KeptClouds (inside render/ only).
namespace lumulus {

struct CloudVolumes;

using FieldPointer = std::shared_ptr<const vdb::Volume>;
/// Densities on the host, of the assets that a question has needed them of.
using FieldsOfAssets = std::map<const cloud::Asset*, std::shared_ptr<const query::BrickField>>;

/// All that an asset depends on. Assets that agree in it are equal.
struct AssetOrigin {
    std::weak_ptr<const vdb::Volume> field;
    int level = 0;                  ///< of detail
    glm::dmat3 voxelToMetres{1.0};  ///< edges of a voxel of this level
    cloud::PrepareOptions how;      ///< but for its check

    bool isOf(const FieldPointer& volume) const { return !field.owner_before(volume) && !volume.owner_before(field); }
    bool operator==(const AssetOrigin& other) const;
};

struct KeptAsset {
    AssetOrigin origin;
    float maximum = 0.0F;  ///< of the field at this level of detail
    std::shared_ptr<const cloud::Asset> asset;
};

/// The air of a scene: all that it depends on.
struct KeptAir {
    scene::Sky sky;
    std::optional<scene::Ground> ground;
    double sunDiameter = 0.0;  ///< degrees
    std::shared_ptr<const sky::Atmosphere> air;

    /// The environment of a scene, with this air where it is the scene's; has the scene's then.
    sky::Environment environmentOf(const scene::Scene& scene);
};

/// The pool of fields in bricks.
struct KeptPool {
    struct Field {
        std::weak_ptr<const vdb::Volume> field;
        vdb::DensityFormat format;  ///< that was chosen for it alone
        vdb::SparseVolume bricks;   ///< in the pool, without leaves
    };
    std::vector<Field> fields;
    std::shared_ptr<const gpu::Image> image;

    /// The pool where these fields lie in it as they are laid out now; they have their places in it then. Else null.
    std::shared_ptr<const gpu::Image> find(CloudVolumes& volumes) const;
};

struct KeptClouds::State {
    std::shared_ptr<gpu::Context> context;  ///< of all of it; outlives it
    KeptPool pool;
    std::vector<KeptAsset> assets;
    KeptAir air;
    /// Of these assets, one for each instance that was drawn.
    std::shared_ptr<const cloud::SharedVolumes> shared;
    std::vector<const cloud::Asset*> sharedOf;
    std::shared_ptr<FieldsOfAssets> fields = std::make_shared<FieldsOfAssets>();

    /// The largest value of a field at a level, where an asset of both is kept.
    std::optional<float> maximumOf(const FieldPointer& field, int level) const;
    std::shared_ptr<const cloud::Asset> find(const AssetOrigin& origin) const;
    /// The pool of fields in bricks: that of before, or a new one, without which nothing of before is kept. Null where
    /// the fields are dense. Errors: those of cloud::makePool().
    std::shared_ptr<const gpu::Image> poolOf(gpu::Context& device, CloudVolumes& volumes, const Check& check);
    /// Drops all assets but these, which it has, and what was made of others.
    void keepOnly(std::span<const std::shared_ptr<const cloud::Asset>> wanted);
    /// The volumes of the assets of instances.
    std::shared_ptr<const cloud::SharedVolumes> sharedVolumes(gpu::Context& device,
                                                              std::span<const cloud::Instance* const> instances);
};

/// What is kept for a renderer that is being made on this device; null where nothing is.
KeptClouds::State* keptOn(const std::shared_ptr<gpu::Context>& context, KeptClouds* kept);

}  // namespace lumulus
