#pragma once

#include <optional>
#include <vector>

#include "light/photon/coefficient_sums.h"
#include "light/photon/collector_light.h"
#include "light/photon/emission.h"
#include "light/photon/generation.h"
#include "light/photon/ground.h"
#include "light/photon/map_layout.h"
#include "light/photon/photon_map.h"
#include "light/photon/world_walk.h"

namespace lumulus::photon {

/// What lit a generation.
struct Lit {
    double flux = 0.0;             // luminance [W]
    glm::dvec3 sunDirection{0.0};  // of travel
};

struct PhotonMap::State {
    State(gpu::Context& gpuContext, std::vector<MapPart> theParts, const cloud::SharedVolumes* volumes,
          const Options& theOptions);

    gpu::Context& context;
    std::vector<MapPart> parts;
    Options options;
    std::uint32_t axisBase;
    std::uint32_t collectors;

    CoefficientSums sums;
    std::optional<WorldWalk> walk;  // where there are several instances
    GenerationTracer tracer;
    std::optional<GroundWalk> groundWalk;  // where there is a ground
    std::optional<Ground> ground;
    CollectorLight reconstruction;

    Lit newest;         // of the generations that count
    Counters counters;  // of all generations, also those that were dropped
    PassLog log;
    /// Of the generations in the ring: extinction of each part over that of its medium.
    Extinctions ringExtinctions;
    double newExtinction = 0.0;     // of the one cloud, of the generation that is traced [1/m]
    std::vector<Placement> places;  // of several instances

    /// A generation that waits for keep() or drop(). Pictures show the light of before until then.
    struct Begun {
        Lit lit;
        std::vector<double> extinctions;  // of each part over that of its medium
        Counters countersBefore;          // what drop() goes back to
    };
    std::optional<Begun> begun;

    Emission emissionOf(const scene::Sun& sun, const sky::Environment& environment, const AirLight* air) const;
    Emission emissionUnder(const scene::Sun& sun, const sky::Environment& environment) const;
    double meanExtinction(std::size_t part) const;
    void placeCollectors();
    /// `greatest`: the sun's largest irradiance that the ring may have to hold [W/m²].
    int unitExponentFor(const Emission& emission, const glm::dvec3& greatest);
    bool traceLit(const Emission& emission, const scene::Sun& sun, const glm::dvec3& greatest, const CutOff& cutOff);
};

}  // namespace lumulus::photon
