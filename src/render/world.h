#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/cut_off.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "cloud/instance.h"
#include "cloud/shared_volumes.h"
#include "light/fog_light/air_over_fog.h"
#include "light/instance_light.h"
#include "light/light_set.h"
#include "light/photon/photon_map.h"
#include "light/photon/sky_return.h"
#include "light/shared_shadow.h"
#include "render/cloud_origin.h"
#include "render/kept_assets.h"
#include "scene/scene.h"
#include "volume/summary.h"

namespace lumulus {

struct CloudVolumes;

/// Everything that scatters, emits or blocks: one owner for each value that can change while a renderer lives.
struct World {
    scene::Fog fog;
    light::LightSet lights;
    /// Each shared by the instances that show it, and by worlds that differ in light.
    std::vector<std::shared_ptr<const cloud::Asset>> assets{};
    std::vector<cloud::Instance> instances{};   ///< one for each cloud of the scene, in its order
    std::vector<light::InstanceLight> light{};  ///< of each instance
    /// Where several instances are drawn: the volumes of their assets, in the order of visible().
    std::shared_ptr<const cloud::SharedVolumes> sharedVolumes{};
    std::optional<photon::PhotonMap> photons{};    ///< of all instances; none where no photon would be of use
    std::optional<photon::SkyReturn> skyReturn{};  ///< of the medium of all, where it has a backward peak
    std::optional<photon::AirLight> air{};         ///< in all instances together, where several are in air or lit fog
    /// In fog without clouds, where it is lit (updateFogLight()); null elsewhere. Shared by worlds of the same light.
    std::shared_ptr<const fog_light::FogLight> fogLight{};
    std::uint64_t fogVersion = 0;                               ///< of it, and of the media
    std::shared_ptr<const fog_light::AirOverFog> airOverFog{};  ///< of that fog, under an atmosphere
    /// Where several instances are lit by the sun: shadow volumes with what stands before them.
    std::optional<light::SharedShadow> sharedShadow{};
    Bounds bounds{};      ///< of all instances, without their offsets
    bool meshes = false;  ///< stand in it, and throw shadows on the ground
    /// Adds their shadows to the shadow volume of an instance, which begins at `origin` in an image; empty without.
    std::function<void(gpu::Commands&, const cloud::Instance&, const light::ShadowGrid&, const gpu::Image&,
                       const glm::ivec3& origin)>
        meshShade{};
    /// The same for photons, whose cells have these edges and begin at a corner [m]; empty without.
    std::function<const gpu::Buffer&(const glm::dmat3& cells, const glm::dvec3& corner)> meshHeights{};
    bool levelsOfDetail = false;   ///< whether instances have voxels chosen by their size in the picture
    scene::PhotonMap photonMap{};  ///< that is asked for: the scene's, but where voxels are flat
    glm::dvec3 wind{0.0};          ///< velocity with which all instances drift [m/s]
    std::shared_ptr<FieldsOfAssets> fields = std::make_shared<FieldsOfAssets>();

    /// Numbers of the instances in which there is something.
    std::vector<std::size_t> visible() const;
    bool hasPhotons() const { return photons.has_value(); }
    bool hasShadows() const;
    /// The ground on which clouds and meshes throw shadows: the scene's, or the planet's, where densities can be read
    /// back of all clouds; else null.
    const scene::Ground* shadedGround() const;
};

/// What making a world tells of itself.
struct WorldReport {
    double loadSeconds = 0.0, prepareSeconds = 0.0;
    std::vector<CloudSummary> clouds;
    std::vector<AssetSummary> assets;
    std::vector<std::string> warnings;
};

struct WorldOptions {
    bool keepRing = false;
    bool progressive = false;
    Report report = noReport;
    ToldOfClouds loaded{};
    Check check = stopIfInterrupted;
    std::function<CloudVolumes(const scene::Scene&)> read{};
    KeptClouds::State* kept = nullptr;  ///< of the world before; null: nothing is kept
};

/// Loads and prepares the clouds of a scene. Errors: InputError for what is wrong with the scene, Error where
/// interrupted or out of memory.
World makeWorld(gpu::Context& context, const scene::Scene& scene, const WorldOptions& options, WorldReport& report);

/// A world of the same scene on the same device that shares the assets of `other`, with light of its own: as the scene
/// has it, and no photons yet. Errors: as above.
World makeWorldBeside(gpu::Context& context, const scene::Scene& scene, const World& other,
                      const WorldOptions& options);

/// A world on the same device of a scene whose clouds are those of `origins`: they share the assets of `other`, which
/// has lost or got some, or gives some another substance. Photons of those that stay are kept (PhotonMap::goOnFrom).
/// Errors: as above; InputError where the photon map has no room for so many.
World makeEditedWorld(gpu::Context& context, const scene::Scene& scene, World& other,
                      std::span<const CloudOrigin> origins, const WorldOptions& options);

/// Finds the light that reaches the instances, after the lights or the places of instances have changed.
void findReachingLight(World& world);

/// Tells the photon map of several clouds where they are now: after their places, extinctions or the sun have changed.
void placeInstances(World& world);

/// Traces a generation of photons through all clouds. Returns false where `cutOff` ended it: it does not count then.
/// `ground`: that of the scene, null where it has none.
bool traceAll(World& world, const CutOff& cutOff, const photon::Ground* ground);

}  // namespace lumulus
