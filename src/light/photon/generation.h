#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/cut_off.h"
#include "cloud/asset.h"
#include "gpu/commands.h"
#include "gpu/program.h"
#include "light/photon/air_light.h"
#include "light/photon/emission.h"
#include "light/photon/photon_map.h"
#include "shared/photon.h"

namespace lumulus::photon {

/// Milliseconds of each pass, summed, in the order of the passes, and the steps of the last commands.
struct PassLog {
    std::vector<gpu::PassTime> times;
    std::vector<gpu::Step> steps;

    void add(const gpu::Commands& commands);
};

/// Walks the photons of one generation through the cloud, round by round, and gathers what they leave: the record
/// buffer never drops, what does not fit waits for the next round.
class GenerationTracer {
  public:
    /// `cloud` and `medium` must outlive the tracer.
    GenerationTracer(gpu::Context& context, const cloud::Asset& cloud, const Medium& medium, const Options& options);

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
    void setPhotons(std::uint64_t photons) { options_.photonsPerGeneration = photons; }

  private:
    const cloud::Asset& cloud_;
    const Medium& medium_;
    Options options_;
    std::uint32_t collectors_;
    std::uint32_t invocations_;
    std::uint32_t recordCapacity_;
    glm::dmat3 faceArea_;

    gpu::Program<gpu::NoPush> traceProgram_;
    gpu::Program<shared::GatherPush> scanProgram_, scatterProgram_, gatherProgram_;
    gpu::Buffer params_, states_, records_, recordCounts_, collectorCounts_, counters_;
    gpu::Buffer cursors_, chunkOffsets_, gatherArguments_, sorted_, inverseCdf_;
    gpu::Buffer skyCells_, sunColours_;  ///< of an atmosphere; a few bytes where there is none
    shared::AirPlace airPlace_{};
    glm::mat3 skyAxes_{1.0F};
    gpu::Commands commands_;

    shared::TraceParams traceParams(const Emission& emission, const scene::Sun& sun, double extinction,
                                    int unitExponent, std::uint32_t number) const;
    void recordSort(const shared::GatherPush& push);
    void shortenRounds();
    void round(const gpu::Buffer& coefficients);
};

}  // namespace lumulus::photon
