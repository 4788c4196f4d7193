#include "light/photon/slab.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/interrupt.h"
#include "gpu/commands.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "light/photon/trace_program.h"
#include "medium/scattering_tables.h"
#include "shared/photon.h"
#include "shared/rng.h"

namespace lumulus::photon {

namespace {

using gpu::Buffer;
using gpu::Memory;
using gpu::Sampler;

/// Optical thickness of one cell of the walk: steps inside a thick layer keep their digits.
constexpr double cellThickness = 64.0;
constexpr std::uint32_t lanes = 4096, stepLimit = 1U << 14U, collisionLimit = 1U << 26U;
/// One batch counts its photons in 32 bits.
constexpr std::uint64_t batchPhotons = 1ULL << 30U;

void require(bool good, const char* key, double value, const char* range) {
    if (!good)
        throw InputError(std::string(key) + " must lie in " + range + ", got " + std::to_string(value), key,
                         "give a value in this range");
}

void check(const Slab& slab) {
    require(slab.tau >= 0.0 && slab.tau <= 1e7, "--tau", slab.tau, "0…1e7");
    require(slab.albedo >= 0.0 && slab.albedo <= 1.0, "--albedo", slab.albedo, "0…1");
    require(std::abs(slab.phase.g) < 1.0, "--g", slab.phase.g, "(-1, 1)");
    require(slab.mu0 > 0.0 && slab.mu0 <= 1.0, "--mu0", slab.mu0, "(0, 1]");
    if (slab.photons == 0 || slab.photons > (1ULL << 40U))
        throw InputError("the number of photons must lie in 1…2^40", "--photons", "ask for some millions");
}

SlabFraction fraction(std::uint64_t count, std::uint64_t photons) {
    const double n = static_cast<double>(photons), p = static_cast<double>(count) / n;
    return {p, std::sqrt(p * (1.0 - p) / n)};
}

/// The layer fills y in [0, 1] m, one cell wide in x and z, the light falling along −y.
class Layer {
  public:
    Layer(gpu::Context& context, const Slab& slab)
        : context_(context),
          slab_(slab),
          tables_(phase::makeScatteringTables(slab.phase, 0.0, glm::dvec3(slab.albedo), 2, 0.0)),
          cells_(std::clamp(static_cast<int>(std::ceil(slab.tau / cellThickness)), 1, 2048)),
          program_(context, "trace", traceSpirv(), traceConstants(tables_, glm::dvec3(slab.albedo), true, false)),
          density_(context, "density", glm::ivec3(1, cells_, 1), VK_FORMAT_R32_SFLOAT),
          index_(context, "collector index", glm::ivec3(1), VK_FORMAT_R32_UINT),
          majorants_(context, "majorants", glm::ivec3(1, cells_, 1), VK_FORMAT_R32_SFLOAT),
          params_(context, "trace params", sizeof(shared::TraceParams), Memory::host),
          inverseCdf_(context, "inverse cdf", tables_.inverseCdf.size() * sizeof(float), Memory::device),
          states_(context, "trace states", lanes * sizeof(shared::TraceState), Memory::host),
          records_(context, "records", sizeof(shared::PhotonRecord), Memory::device),
          recordCounts_(context, "record counts", lanes * sizeof(std::uint32_t), Memory::device),
          collectorCounts_(context, "collector counts", sizeof(std::uint32_t), Memory::device),
          counters_(context, "trace counters", sizeof(shared::TraceCounters), Memory::host),
          commands_(context) {
        const std::vector<float> ones(static_cast<std::size_t>(cells_), 1.0F);
        gpu::upload(context, density_, ones);
        gpu::upload(context, index_, std::vector<std::uint32_t>{shared::NO_COLLECTOR});
        gpu::upload(context, majorants_, ones);
        if (!tables_.inverseCdf.empty()) gpu::upload(context, inverseCdf_, tables_.inverseCdf);
    }

    /// Counts of `photons` photons; `batch` numbers the random numbers.
    shared::TraceCounters trace(std::uint32_t photons, std::uint32_t batch) {
        params_.mapped<shared::TraceParams>()[0] = params(photons, batch);
        resetStates(states_.mapped<shared::TraceState>().subspan(0, lanes));
        counters_.mapped<shared::TraceCounters>()[0] = {};
        do {
            stopIfInterrupted();
            counters_.mapped<shared::TraceCounters>()[0].pending = 0;
            round();
        } while (counters_.mapped<shared::TraceCounters>()[0].pending > 0);
        return counters_.mapped<shared::TraceCounters>()[0];
    }

  private:
    gpu::Context& context_;
    const Slab& slab_;
    phase::ScatteringTables tables_;
    int cells_;
    gpu::Program<gpu::NoPush> program_;
    gpu::Image density_, index_, majorants_;
    Buffer params_, inverseCdf_, states_, records_, recordCounts_, collectorCounts_, counters_;
    gpu::Commands commands_;

    shared::TraceParams params(std::uint32_t photons, std::uint32_t batch) const {
        const double sine = std::sqrt((1.0 - slab_.mu0) * (1.0 + slab_.mu0));
        shared::TraceParams p{};
        p.worldToCells = glm::mat3(1.0F);
        p.worldToCells[1][1] = static_cast<float>(cells_);
        p.size = glm::vec3(1.0F, static_cast<float>(cells_), 1.0F);
        p.cells = glm::ivec3(1, cells_, 1);
        p.cellSize = glm::vec3(1.0F);
        p.extinction = static_cast<float>(slab_.tau);
        p.scatterShare = 1.0F;
        p.albedo = glm::vec3(static_cast<float>(slab_.albedo));
        p.scatterFraction = 1.0F;
        p.asymmetry = tables_.g;
        p.sunDirection = glm::vec3(glm::dvec3(sine, -slab_.mu0, 0.0));
        setFaces(p, glm::dmat3(glm::dvec3(0.0), {0.0, 1.0, 0.0}, glm::dvec3(0.0)));
        p.sunPhotons = photons;
        p.photons = photons;
        p.generation = batch;
        p.stream = shared::rngStream(static_cast<std::uint32_t>(slab_.seed),
                                     static_cast<std::uint32_t>(slab_.seed >> 32U), 1U);
        p.invocations = lanes;
        p.recordCapacity = 1;
        p.stepLimit = stepLimit;
        p.collisionLimit = collisionLimit;
        return p;
    }

    void round() {
        commands_.begin();
        commands_.pass("slab");
        commands_.dispatch(program_,
                           {{"density", density_, Sampler::nearest},
                            {"collectorIndex", index_, Sampler::nearest},
                            {"bricks", index_, Sampler::nearest},
                            {"Params", params_},
                            {"majorants", majorants_},
                            {"InverseCdf", inverseCdf_},
                            {"States", states_},
                            {"Records", records_},
                            {"RecordCounts", recordCounts_},
                            {"CollectorCounts", collectorCounts_},
                            {"Counters", counters_},
                            {"SkyCells", inverseCdf_},
                            {"SunColours", inverseCdf_},
                            {"FogSky", inverseCdf_},
                            {"CollisionEstimates", counters_},
                            {"GroundLight", params_},
                            {"MeshShade", params_}},
                           {}, gpu::linearGroups(lanes, 64));
        commands_.submit();
        commands_.wait();
    }
};

}  // namespace

SlabResult traceSlab(gpu::Context& context, const Slab& slab) {
    check(slab);
    Layer layer(context, slab);
    std::uint64_t reflected = 0, diffuse = 0, direct = 0, absorbed = 0;
    SlabResult result;
    for (std::uint64_t done = 0, batch = 0; done < slab.photons; ++batch) {
        const std::uint64_t count = std::min(batchPhotons, slab.photons - done);
        const auto c = layer.trace(static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(batch));
        done += count;
        reflected += c.reflected;
        diffuse += c.transmittedDiffuse;
        direct += c.transmittedDirect;
        absorbed += c.absorbed;
        result.events += c.events;
        result.lost += c.lost;
    }
    result.reflected = fraction(reflected, slab.photons);
    result.transmittedDiffuse = fraction(diffuse, slab.photons);
    result.transmittedDirect = fraction(direct, slab.photons);
    result.absorbed = fraction(absorbed, slab.photons);
    return result;
}

}  // namespace lumulus::photon
