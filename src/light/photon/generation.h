#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "base/cut_off.h"
#include "cloud/asset.h"
#include "gpu/commands.h"
#include "gpu/program.h"
#include "light/photon/air_light.h"
#include "light/photon/emission.h"
#include "light/photon/photon_map.h"
#include "light/photon/photon_starts.h"
#include "light/photon/world_walk.h"
#include "shared/photon.h"

namespace lumulus::photon {

/// Milliseconds of each pass, summed, in the order of the passes, and the steps of the last commands.
struct PassLog {
    std::vector<gpu::PassTime> times;
    std::vector<gpu::Step> steps;

    void add(const gpu::Commands& commands);
};

/// Walks the photons of one generation through the cloud, or through several, round by round, and gathers what they
/// leave: the record buffer never drops, what does not fit waits for the next round.
class GenerationTracer {
  public:
    /// Through one cloud. The part must outlive the tracer.
    GenerationTracer(gpu::Context& context, const MapPart& part, const Options& options);
    /// Through several, with so many collectors together and estimates before `axisBase`. The walk must outlive the
    /// tracer.
    GenerationTracer(gpu::Context& context, const WorldWalk& walk, std::uint32_t collectors, std::uint32_t axisBase,
                     const Options& options);

    const glm::dmat3& faceArea() const { return faceArea_; }

    /// Adds the light of generation `number` under `extinction` (σt at density 1 [1/m]) to `coefficients`
    /// ([collector][RGB][bands²], then the estimates, int64), in counts of 2^unitExponent W / COEFFICIENT_SCALE, and
    /// what happened to `counters`. `unsettledRecords` counts the records that `coefficients` hold. Returns false where
    /// `cutOff` ended the walk before all photons had ended: what `coefficients` and the counters hold of the
    /// generation is then of no use. Errors: Error where interrupted, or where the sums might wrap.
    bool trace(const Emission& emission, const scene::Sun& sun, double extinction, int unitExponent,
               std::uint32_t number, const gpu::Buffer& coefficients, Counters& counters,
               std::uint64_t& unsettledRecords, PassLog& log, const CutOff& cutOff);

    /// Light of an atmosphere for the generations from now on; for a tracer that was made with `options.air`.
    void setAir(const AirLight& air);

    /// Lowers the photons of the generations from now on. `photons` is at least 1 and at most what it was.
    /// The ground for the walk; must outlive the tracer. Before the first generation of a map with one.
    void setGround(const gpu::Buffer& ground) { ground_ = &ground; }
    /// What meshes shade of the sun (shared::MeshShadeParams and heights); as above.
    void setMeshes(const gpu::Buffer& meshes) { meshes_ = &meshes; }
    /// Edges of the walk's cells in the world, columns [m].
    glm::dmat3 cellsToWorld() const;

    void setPhotons(std::uint64_t photons) { options_.photonsPerGeneration = photons; }

  private:
    /// The program of a walk and what it needs beside.
    struct Walked {
        const MapPart* part;     ///< the one cloud; null: there are several
        const WorldWalk* world;  ///< the several clouds; null: there is one
        std::span<const std::uint32_t> spirv;
        std::vector<gpu::SpecConstant> constants;
        std::uint32_t collectors, axisBase;
    };
    GenerationTracer(gpu::Context& context, const Walked& walked, const Options& options);

    const MapPart* part_;
    const WorldWalk* world_;
    std::uint32_t axisBase_;
    Options options_;
    std::uint32_t collectors_;
    std::uint32_t invocations_;
    std::uint32_t recordCapacity_;
    glm::dmat3 faceArea_;
    const gpu::Buffer* ground_ = nullptr;
    const gpu::Buffer* meshes_ = nullptr;

    gpu::Program<gpu::NoPush> traceProgram_;
    std::optional<PhotonStarts> starts_;  ///< of several clouds
    gpu::Program<shared::GatherPush> scanProgram_, scatterProgram_, gatherProgram_;
    gpu::Buffer params_, states_, records_, recordCounts_, collectorCounts_, counters_;
    gpu::Buffer cursors_, chunkOffsets_, gatherArguments_, sorted_, inverseCdf_;
    gpu::Buffer skyCells_, sunColours_;  ///< of an atmosphere or of fog; a few bytes where there is none
    gpu::Buffer fogSky_;                 ///< the same of fog
    shared::AirPlace airPlace_{};
    glm::mat3 skyAxes_{1.0F};
    gpu::Commands commands_;
    double stepSeconds_ = 0.0;  ///< of a round, for each step that its invocations may take

    shared::TraceParams traceParams(const Emission& emission, const scene::Sun& sun, double extinction,
                                    int unitExponent, std::uint32_t number) const;
    void setCloud(shared::TraceParams& p, double extinction) const;
    std::vector<gpu::Binding> walkBindings() const;
    void recordSort(const shared::GatherPush& push);
    void planRound(const CutOff& cutOff, std::uint32_t pending);
    void learnRound(double seconds, std::uint32_t pending);
    void round(const gpu::Buffer& coefficients);
};

}  // namespace lumulus::photon
