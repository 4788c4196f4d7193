#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/cut_off.h"
#include "base/interrupt.h"
#include "cloud/asset.h"
#include "cloud/shared_volumes.h"
#include "gpu/commands.h"
#include "light/photon/air_light.h"
#include "light/photon/map_part.h"
#include "scene/scene.h"
#include "sky/environment.h"

namespace lumulus::photon {

struct Options {
    std::uint64_t photonsPerGeneration = 100000;
    int generations = 20;  ///< p, slots of the ring
    std::uint32_t firstGeneration = 0;
    int bands = 5;
    std::uint64_t seed = 1;
    /// Whether generations beyond the p-th will replace the oldest. A picture that stops at p needs no slots: they are
    /// the bulk of the memory.
    bool keepRing = false;
    cloud::CellGrid estimates;  ///< of the one cloud, see MapPart
    /// Whether generations of even and of odd number stay apart until the sum takes them: pictures of both tell how
    /// noisy a picture of all is. Not with a ring.
    bool splitGenerations = false;
    bool ground = false;  ///< whether there is a ground below the clouds, see setGround()
    bool meshes = false;  ///< whether meshes stand before the sun, see setMeshes()
    std::uint64_t memoryBudget = std::uint64_t{1} << 30U;  ///< bytes for all coefficients
    bool air = false;             ///< whether the light differs by direction or height: of an atmosphere, fog or a map
    bool fog = false;             ///< whether it is that of fog
    glm::ivec2 skyCells{64, 32};  ///< of that light
    /// Asked between the rounds of a generation, and may throw. Then a map with a ring has the light of before; one
    /// without is of no more use.
    Check check = stopIfInterrupted;
};

/// Sums over all generations traced.
struct Counters {
    std::uint64_t emitted = 0, events = 0, nulls = 0, absorbed = 0, escaped = 0, lost = 0, records = 0, saturated = 0;
};

/// Which generations a view is of.
enum class Part { all, even, odd };

/// Generations that are known apart: those since the sum last took some.
struct SplitCounts {
    int even = 0, odd = 0;
};

/// Coefficients and estimates, and the watts that a count of them stands for as the mean of the generations.
struct Light {
    const gpu::Buffer* counts = nullptr;
    double unit = 0.0;
};

struct Ground;
struct MapPlan;
struct TracedSums;

/// The photon map: a ring of generations, each [collector][RGB][bands²] int64 of spherical-harmonic coefficients, then
/// the estimates (shared/collision_estimator.h) and, where the phase function has a backward peak, the rings about the
/// sun's axis (shared/sun_axis.h), int64, and their exact sum.
class PhotonMap {
  public:
    /// `cloud` must outlive the map. Collectors' masses are those of `medium.extinction`. Errors: InputError where the
    /// coefficients do not fit into the budget, or those of one generation into a buffer of the device.
    PhotonMap(gpu::Context& context, const cloud::Asset& cloud, const Medium& medium, const Options& options);
    /// Of one instance of a cloud, whose voxels have these edges in the world [m].
    PhotonMap(gpu::Context& context, const cloud::Asset& cloud, const glm::dmat3& voxelToMetres, const Medium& medium,
              const Options& options);
    /// Of several instances in one walk: photons go from one to the next. Assets and `volumes` outlive the map.
    PhotonMap(gpu::Context& context, std::vector<MapPart> parts, const cloud::SharedVolumes& volumes,
              const Options& options);
    PhotonMap(PhotonMap&&) noexcept;
    ~PhotonMap();

    /// Traces one generation into the oldest slot. Power of the lights: W·m⁻² (sun), W·m⁻²·sr⁻¹ (environment).
    /// `extinction` is σt at density 1 [1/m], by default that of the medium that the map was made with; another one
    /// needs keepRing. Radiance is the mean over the ring, each generation weighted by its extinction.
    void trace(const scene::Sun& sun, const sky::Environment& environment, std::optional<double> extinction = {});

    /// Traces one generation that `cutOff` may end. Returns whether it was finished; else nothing is left of it. A
    /// finished one waits for keep() or drop(), and the map has the light of before until then: one with a ring also
    /// between the rounds, so that pictures may be drawn in `check` and in what `cutOff` asks. Without a ring, the
    /// first that may be cut off beside others takes the memory of one generation more until they are settled. `air`:
    /// the light of an atmosphere in the cloud, for a map that was made for it; `sun` then has the most that reaches
    /// it.
    bool tryTrace(const scene::Sun& sun, const sky::Environment& environment, const CutOff& cutOff,
                  std::optional<double> extinction = {}, const AirLight* air = nullptr);
    /// Goes on with the generations of another map of the same ring: `before[i]` is the part of it that part i was,
    /// none where it is new. What is new gets its light from the next generations, by which it is the mean of those
    /// alone. Before the first generation; begins anew where there is a ground, whose light lies elsewhere then.
    void goOnFrom(PhotonMap& other, std::span<const std::optional<std::size_t>> before);
    /// What all generations have left; of a ring, those in it that are finished.
    TracedSums tracedSums();
    /// Goes on where the ring of another map was, `like`, with its light in counts of this one, of 2^unitExponent W:
    /// the sum of all of its generations, each of which has the same share then. `extinctions`: those that the counts
    /// of each part are of, over that of its medium; 0 where it has none. Before the first generation of a map with a
    /// ring of at least as many.
    void goOnFrom(std::span<const std::int64_t> counts, const TracedSums& like, int unitExponent,
                  std::span<const double> extinctions);
    /// Goes on with the generations of a map of the same scene, as if they had been traced here. Before the first
    /// generation of a map without a ring. Errors: InputError where it cannot be of the same scene.
    void goOnFrom(const TracedSums& sums);
    /// Adds counts of 2^unitExponent W, which is the unit of what was traced, as those of so many generations more. For
    /// a map without a ring, after its last generation.
    void add(std::span<const std::int64_t> counts, int generations, int unitExponent);
    /// Counts of all parts, and of what lies behind them.
    std::uint32_t countsOfAll() const;
    /// How the counts of the parts lie among all.
    MapPlan plan() const;
    /// Where the instances are from now on, one for each part. A map of several needs it
    /// before all else.
    void place(std::span<const Placement> places);
    /// The ground for the next generations; before the first one of a map with `Options::ground`, after place().
    void setGround(const Ground& ground);
    /// What meshes shade of the sun (shared::MeshShadeParams and heights), for a map with `Options::meshes`; as above.
    /// The buffer outlives the next generations.
    void setMeshes(const gpu::Buffer& meshes);
    /// Edges of the cells of the walk [m].
    glm::dmat3 cellsToWorld() const;
    /// Light of the clouds that falls on the cells of the ground, the mean over the ring [W]: RGB, x fastest. For a map
    /// with `Options::ground`.
    std::vector<glm::vec3> groundLight();
    /// Takes the generation of tryTrace() into the oldest slot.
    void keep();
    /// Takes the generation of tryTrace() out again; does nothing where there is none.
    void drop();
    /// Divides the photons of a generation by `divisor`, down to `fewest` or what there are. Only before the first
    /// generation is kept. Returns the photons of a generation.
    std::uint64_t shrinkGenerations(std::uint64_t divisor, std::uint64_t fewest);

    /// Adds what has been traced to the sum, unless the sum would be a copy of the one buffer that holds it all.
    void settle();

    /// What the generations of a part have left; all of them are settled for it. A part needs `splitGenerations` and a
    /// generation in it; the sum takes nothing then.
    Light light(Part part = Part::all);
    SplitCounts splitCounts() const;

    /// Radiance of every collector towards the eye, and its light of all directions [W·m⁻²]: recorded into `commands`.
    /// The eye in voxel coordinates of the one cloud, or in metres from corner().
    void reconstruct(gpu::Commands& commands, const glm::vec3& eye, const Light& light);
    /// Where lengths begin in a map of several instances [m].
    glm::dvec3 corner() const;
    /// At collectorTexel(): RGB and 1; flux and fluence of the luminance, and fluence of RGB, whatever the eye.
    const gpu::Image& radiance() const;
    const gpu::Image& fluences() const;
    const gpu::Image& colours() const;

    const std::vector<MapPart>& parts() const;
    /// Luminance of the power of a photon that begins round a part, as the mean of all generations [W].
    double photonPower(std::size_t part = 0) const;
    /// Means over the generations of the extinction of each part, over that of its medium: 1 without any.
    std::vector<double> meanExtinctions() const;
    /// Photons of the ring that are expected to begin round a part.
    std::uint64_t photonsOf(std::size_t part) const;

    /// Without a ring: all that were traced.
    int generationsInRing() const;
    /// Number of the oldest generation in the ring; where nothing was traced, of the next.
    std::uint64_t firstInRing() const;
    std::uint64_t photonsInRing() const;
    Counters counters() const;
    /// Milliseconds of each pass, summed, in the order of the passes.
    std::vector<gpu::PassTime> times() const;
    /// Steps of the last round that was recorded.
    const std::vector<gpu::Step>& steps() const;

    /// For tests: the running sum, and one slot of the ring, in units of `unit()`.
    std::vector<std::int64_t> downloadSum();
    std::vector<std::int64_t> downloadSlot(int slot) const;
    /// Watts that one count of the ring stands for.
    double unit() const;
    /// ∫ σt' dV of each collector [m²], by which its coefficients are divided.
    std::vector<double> masses() const;
    /// From ∫ normalised density dV [voxels] to ∫ σt' dV [m²] of a part, on average over the generations of the ring.
    double massScale(std::size_t part = 0) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace lumulus::photon
