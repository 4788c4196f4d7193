#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/cut_off.h"
#include "base/image.h"
#include "base/interrupt.h"
#include "base/pass_time.h"
#include "base/progress.h"
#include "query/media.h"
#include "render/cloud_origin.h"
#include "render/new_fog.h"
#include "render/scene_changes.h"
#include "scene/scene.h"
#include "view/view.h"
#include "volume/summary.h"

namespace lumulus::photon {
struct LeafLight;
struct TracedSums;
}  // namespace lumulus::photon
namespace lumulus::gpu {
class Context;
}

namespace lumulus {

class KeptClouds;
struct CloudVolumes;
struct FrameLight;

/// Gives the densities of a scene, in the place of loadClouds().
using ReadClouds = std::function<CloudVolumes(const scene::Scene&)>;

struct RendererOptions {
    std::string device;        ///< name (part of it) or index; empty: the best one
    bool validation = false;   ///< Vulkan validation and synchronisation validation; messages end up in `Statistics`
    Report report = noReport;  ///< told of loading, preparing and drawing; what it throws ends that work
    Check check = stopIfInterrupted;  ///< asked between the steps of tracing and drawing; what it throws ends that work
    bool keepRing = false;            ///< generations beyond those that the scene asks for replace the oldest
    /// The photons are not counted beforehand: generations may go on beyond the scene's, and preview() can be asked.
    /// Not with a ring.
    bool progressive = false;
    std::shared_ptr<gpu::Context> context{};  ///< the device of another renderer, in the place of `device`; may be null
    ToldOfClouds loaded{};                    ///< told of the clouds before any work on them, which can take long
    ReadClouds read{};                        ///< gives densities that may have been read beforehand
    KeptClouds* kept = nullptr;               ///< what the renderer before has left
};

/// What `--stats` reports.
struct Statistics {
    std::string device;
    double loadSeconds = 0.0, prepareSeconds = 0.0, traceSeconds = 0.0, drawSeconds = 0.0;
    std::uint64_t photons = 0;      ///< emitted by all generations in the ring
    std::uint64_t generations = 0;  ///< in the ring
    std::uint64_t events = 0;       ///< real collisions
    std::uint64_t nullCollisions = 0;
    std::uint64_t absorbed = 0, escaped = 0, lost = 0;  ///< photons by their end
    std::uint64_t saturated = 0;                        ///< coefficients that met the fixed-point limit
    std::uint64_t collectors = 0;
    std::uint64_t gpuBytes = 0;        ///< of buffers and images
    std::uint64_t gpuBytesHeld = 0;    ///< allocated from the driver for them
    std::uint64_t fogChangeBytes = 0;  ///< on the host, of what clouds change in fog
    std::vector<CloudSummary> clouds;  ///< of the scene, in its order
    std::vector<AssetSummary> assets;  ///< that were prepared for them
    std::vector<PassTime> passes;      ///< sums over all generations, in the order of the frame
    std::vector<std::string> warnings;
    std::vector<std::string> validationMessages;
};

/// Some rows of the picture by the photons of the even and of the odd generations, which have none in common: what they
/// differ by is noise.
struct Preview {
    LayeredImage even, odd;
    std::vector<int> rows;                        ///< that are drawn
    int evenGenerations = 0, oddGenerations = 0;  ///< in the two pictures
    double forecastSeconds = 0.0;                 ///< that draw() would take now
};

/// The photon generations that the next picture shows: `render` repeats it with these as `photon_map.first_generation`,
/// `photon_map.generations` and (as the product of the two last) `photon_map.photons`.
struct Generations {
    std::uint64_t first = 0;
    int count = 0;
    int current = 0;  ///< of them, traced under the light and extinction of now
    std::uint64_t photonsEach = 0;

    std::uint64_t photons() const { return photonsEach * static_cast<std::uint64_t>(count); }
};

/// What belongs to a viewer and outlives a frame: its camera and the one before, light fields towards its eye, what it
/// has sampled. Owned by whoever looks (a channel of the service, a render command) and handed to each draw; it must
/// not outlive the renderer that drew with it.
class ViewState {
  public:
    ViewState();
    ViewState(ViewState&&) noexcept;
    ViewState& operator=(ViewState&&) noexcept;
    ~ViewState();

    struct State;
    State& state() { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

/// Orders the passes that make pictures of a world. It owns the device and the world, and nothing of a view.
/// Errors: InputError for bad scenes, Error for what fails while running and where interrupted.
class Renderer {
  public:
    Renderer(const scene::Scene& scene, const RendererOptions& options);
    /// A renderer of the same scene with light of its own: as the scene has it, and no photons yet. It shares the
    /// device (whatever `options` say of one), the densities, the collectors and the compiled programs with `other`, so
    /// that one thread at a time may use the two.
    Renderer(const scene::Scene& scene, const Renderer& other, const RendererOptions& options);
    /// A renderer of a scene whose clouds are those of `origins`: some have come or gone, or are of another substance.
    /// It shares with `other` as above, has its wind and where its clouds have moved, and goes on with the photons of
    /// the clouds that stay; generations of the light of now take their place. Without them it begins anew where there
    /// is a ground. Both need `keepRing`. Errors: InputError where the photon map has no room for so many.
    Renderer(const scene::Scene& scene, Renderer& other, std::span<const CloudOrigin> origins,
             const RendererOptions& options);
    ~Renderer();

    /// Its device, for other renderers, of which one thread at a time may use one.
    std::shared_ptr<gpu::Context> context() const;
    /// Generations that the scene asks for (0 where no photon is needed).
    int generationsWanted() const;
    /// Traces one generation into the oldest slot of the ring of every cloud. Where `check` throws between two rounds
    /// of photons and there is a ring, the light of before stays. With a ring, `check` may draw pictures and change the
    /// light between two rounds: pictures show the light of before, and the generation has that with which it began.
    void traceGeneration();
    /// The same, unless `cutOff` ends it between two rounds of photons. Returns false then: what was traced is dropped,
    /// and the light of before stays, with a ring or without.
    bool traceGeneration(const CutOff& cutOff);
    /// Divides the photons of all generations by `divisor`, down to `fewest` in the largest cloud or what there are.
    /// Only before the first one. Returns the photons of a generation.
    std::uint64_t shrinkGenerations(std::uint64_t divisor, std::uint64_t fewest);
    /// What all generations have left, for a map file. Not with `keepRing`.
    photon::TracedSums tracedSums();
    /// Goes on with generations that were traced elsewhere for a scene of the same lightFingerprint(), before the first
    /// one. Not with `keepRing`. Errors: InputError where they cannot be of this scene.
    void goOnFrom(const photon::TracedSums& sums);
    /// Light of all photons so far, or of those in the ring, for the frame behind that of this scene; none where no
    /// photon is of use.
    std::optional<FrameLight> frameLight(const scene::Scene& scene);
    /// Bytes on the host of what frameLight() gives.
    std::uint64_t frameLightBytes() const;
    /// Adds the light of the frame before to what was traced, as so many generations more (render/frame_light.h):
    /// `ways` that what is in the clouds of the scene has come. Returns whether there was any to add. Not with
    /// `keepRing`.
    bool carryOn(const scene::Scene& scene, const FrameLight& before,
                 std::span<const std::function<glm::dvec3(const glm::dvec3&)>> ways, int generations);
    /// With `keepRing`, before the first generation: goes on with the ring of the renderer of the scene before, whose
    /// generations give way to new ones. Returns whether there was any light to go on with. Errors: what the renderer's
    /// `check` throws.
    bool goOnFrom(const scene::Scene& scene, const FrameLight& before,
                  std::span<const std::function<glm::dvec3(const glm::dvec3&)>> ways);
    /// Of all that light depends on (render/light_fingerprint.h), as it is in this scene.
    std::string lightFingerprint(const scene::Scene& scene);
    /// Draws a view: layers as in the documented EXR contract. All views share the photons.
    LayeredImage draw(const View& view, ViewState& state);
    /// The same for a viewer who looks once.
    LayeredImage draw(const View& view);
    /// Draws the view of the scene once.
    LayeredImage draw();
    /// For progressive rendering, from two generations on after the last draw().
    Preview preview();
    /// A picture of another renderer (layers R, G and B) as seen through the scene's fog; as it is where there is none.
    /// `depth` as the scene's `fog.depth` says, rows from the top. Both have the size of the view.
    LayeredImage throughFog(const View& view, LayeredImage picture, std::vector<float> depth);
    /// The view of the scene.
    View sceneView() const;
    /// Rays along each side of a pixel of the view.
    int raysAcross(const View& view) const;
    /// Where the clouds are, before any offset.
    const Bounds& bounds() const;

    /// Names of the clouds, in the order of the scene.
    std::vector<std::string> clouds() const;
    /// Index of a cloud by its name or its index. Errors: InputError where there is none.
    std::size_t findCloud(std::string_view nameOrIndex) const;
    /// The sun of now: the scene's until setSun() changes it.
    const scene::Sun& sun() const;
    /// Extinction of a cloud now, as in the scene [1/m]; 0 where the scene has no cloud.
    double extinction(std::size_t cloud = 0) const;

    /// What the ring holds. Changes of light and medium age in with the generations traced from then on; what is drawn
    /// without photons (the sun's first scattering, transmittance) changes at once. They need `keepRing`.
    Generations generations() const;
    /// These tell whether anything changed. Without a cloud all clouds are meant.
    /// Errors: InputError where the scene was made without a sun.
    bool setSun(const glm::dvec3& directionTo, const glm::dvec3& irradiance);
    /// `extinction` as in the scene [1/m]. Errors: InputError where it is 0, or where nothing is there to be extinct.
    bool setExtinction(double extinction, std::optional<std::size_t> cloud = {});
    /// Finds other fog for the scene, beside this renderer, where setFog() takes it. Errors: InputError where the scene
    /// was made without fog.
    FogMaker fogMaker() const;
    /// Puts fog that fogMaker() has found in the place of the scene's; light in it is seen at once, that of photons
    /// ages in. Returns whether anything changed.
    bool setFog(const NewFog& fog);
    bool hasFog(const NewFog& fog) const;
    /// The media of now, which a ground has ended.
    const std::vector<scene::FogMedium>& fogMedia() const;
    /// Allows the next pictures to show the sun's first scattering by shadow volumes this many times as coarse (≥ 1)
    /// where the sun has moved: making them whole can take longer than the picture. They stay so until sharpenSun() is
    /// done, or a picture is drawn with less allowed.
    void allowSunReduction(int reduction);
    /// Coarseness of the shadow volumes that the last picture showed; 1: whole, 0: the next one has to make them.
    int sunReduction() const;
    /// Completes `share` (0 to 1) of the shadow volume that the last picture used at reduced resolution. Returns true
    /// when nothing is missing.
    bool sharpenSun(double share);
    /// Moves the clouds from where the scene has them [m]; light from infinity does not see it.
    void setOffset(const glm::dvec3& offset, std::optional<std::size_t> cloud = {});
    /// Lets a cloud lie by so much from where the scene has it [m], besides what setTime() adds. Photons of before age
    /// out where others see it. Returns whether it moved.
    bool moveCloud(const glm::dvec3& way, std::size_t cloud);
    /// Sets the velocity with which the clouds drift [m/s]. Returns whether it changed.
    bool setWind(const glm::dvec3& velocity);
    /// Moves the clouds to where the wind has carried them at this time [s]; at 0 they are where the scene has them.
    void setTime(double seconds);

    SceneChanges changes() const;
    /// Takes over what has changed in a renderer of a scene of as many clouds. Extinctions of clouds in which there is
    /// nothing stay. Returns whether anything is another now. Errors: InputError where the scene cannot have such
    /// light.
    bool take(const SceneChanges& changes);
    /// From voxels of a cloud to metres, without its offset.
    glm::dmat4 placementOf(std::size_t cloud) const;

    /// What light meets in the world as it is now, for questions without a picture; its own copy but for densities,
    /// which are immutable. The first call reads densities back from the device.
    query::Media media();
    /// The clouds of now by their number in the scene, as above, for paths that measure the error of a picture.
    std::vector<query::CloudField> fields();
    /// What the photons have left in the leaves of all clouds, once they are traced; none where no photon is needed.
    std::vector<photon::LeafLight> leafLight();
    /// Sun, or moon where that is brighter, as it reaches a point through fog and air, but for clouds.
    scene::Sun sunAt(const glm::dvec3& point) const;

    Statistics statistics() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace lumulus
