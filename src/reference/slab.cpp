#include "reference/slab.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "reference/phase.h"

namespace lumulus::reference {
namespace {

/// The fate of one photon that collides, as shares of its weight.
struct Fate {
    double reflected = 0.0;
    double transmitted = 0.0;
};

struct Sums {
    double reflected = 0.0, reflectedSquare = 0.0;
    double transmitted = 0.0, transmittedSquare = 0.0;
    double absorbed = 0.0, absorbedSquare = 0.0;

    void add(const Fate& fate) {
        const double lost = 1.0 - fate.reflected - fate.transmitted;
        reflected += fate.reflected;
        reflectedSquare += fate.reflected * fate.reflected;
        transmitted += fate.transmitted;
        transmittedSquare += fate.transmitted * fate.transmitted;
        absorbed += lost;
        absorbedSquare += lost * lost;
    }

    void add(const Sums& other) {
        reflected += other.reflected;
        reflectedSquare += other.reflectedSquare;
        transmitted += other.transmitted;
        transmittedSquare += other.transmittedSquare;
        absorbed += other.absorbed;
        absorbedSquare += other.absorbedSquare;
    }
};

/// A photon that collides first at optical depth `depth` (vertical).
Fate follow(const Slab& slab, const PhaseFunction& phase, double depth, Random& random) {
    // below this weight photons play Russian roulette
    constexpr double faint = 0.1;
    glm::dvec3 direction(std::sqrt((1.0 - slab.mu0) * (1.0 + slab.mu0)), 0.0, slab.mu0);  // z downwards
    double weight = 1.0;
    for (;;) {
        weight *= slab.albedo;
        if (weight < faint) {
            if (random.uniform() * faint >= weight) return {};
            weight = faint;
        }
        direction = turned(direction, phase.sample(random), random);
        depth += random.exponential() * direction.z;
        if (depth < 0.0) return {weight, 0.0};
        if (depth > slab.tau) return {0.0, weight};
    }
}

Sums traceChunk(const Slab& slab, const PhaseFunction& phase, double collided, std::uint64_t begin, std::uint64_t end) {
    Sums sums;
    for (std::uint64_t photon = begin; photon < end; ++photon) {
        Random random(slab.seed, 0, photon);
        // an exponential path that ends within the layer
        const double path = -std::log1p(-random.uniform() * collided);
        sums.add(follow(slab, phase, std::min(slab.tau, path * slab.mu0), random));
    }
    return sums;
}

Estimate estimateOf(double sum, double square, double count, double scale) {
    const double mean = sum / count;
    const double variance = std::max(0.0, square / count - mean * mean) / std::max(1.0, count - 1.0);
    return {scale * mean, scale * std::sqrt(variance)};
}

void check(const Slab& slab) {
    const auto require = [](bool good, const char* what, const char* mend) {
        if (!good) throw InputError("out of range", what, mend);
    };
    require(slab.tau >= 0.0 && slab.tau <= 1e9, "tau", "give an optical thickness from 0 to 1e9");
    require(slab.albedo >= 0.0 && slab.albedo <= 1.0, "albedo", "give a number from 0 to 1");
    require(std::abs(slab.phase.g) < 1.0, "g", "give an asymmetry above -1, below 1");
    require(slab.mu0 > 0.0 && slab.mu0 <= 1.0, "mu0", "give a cosine above 0, at most 1");
    require(slab.photons > 0 && slab.photons <= (1ULL << 40U), "photons", "give a number from 1 to 2^40");
}

}  // namespace

SlabResult solveSlab(const Slab& slab) {
    check(slab);
    const PhaseFunction phase(slab.phase);
    const double collided = -std::expm1(-slab.tau / slab.mu0);
    constexpr std::uint64_t chunk = 4096;
    const std::uint64_t chunks = (slab.photons + chunk - 1) / chunk;
    // enough at once to keep threads busy, and few enough that Ctrl-C does not wait
    std::array<Sums, 64> block;
    Sums sums;
    for (std::uint64_t begin = 0; begin < chunks; begin += block.size()) {
        stopIfInterrupted();
        const std::uint64_t count = std::min<std::uint64_t>(block.size(), chunks - begin);
        tbb::parallel_for(std::uint64_t{0}, count, [&](std::uint64_t i) {
            const std::uint64_t first = (begin + i) * chunk;
            block[i] = traceChunk(slab, phase, collided, first, std::min(first + chunk, slab.photons));
        });
        for (std::uint64_t i = 0; i < count; ++i) sums.add(block[i]);
    }
    const auto count = static_cast<double>(slab.photons);
    SlabResult result;
    result.transmittedDirect.value = std::exp(-slab.tau / slab.mu0);
    result.reflected = estimateOf(sums.reflected, sums.reflectedSquare, count, collided);
    result.transmittedDiffuse = estimateOf(sums.transmitted, sums.transmittedSquare, count, collided);
    result.absorbed = estimateOf(sums.absorbed, sums.absorbedSquare, count, collided);
    return result;
}

}  // namespace lumulus::reference
