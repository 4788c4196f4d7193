#include "render/renderer_statistics.h"

#include <algorithm>
#include <string>

#include "render/pass_stage.h"

namespace lumulus {

namespace {

void addCounters(Statistics& statistics, const photon::PhotonMap& photons) {
    const photon::Counters& c = photons.counters();
    statistics.photons += c.emitted;
    statistics.generations = static_cast<std::uint64_t>(photons.generationsInRing());
    statistics.events += c.events;
    statistics.nullCollisions += c.nulls;
    statistics.absorbed += c.absorbed;
    statistics.escaped += c.escaped;
    statistics.lost += c.lost;
    statistics.saturated += c.saturated;
}

}  // namespace

void addTimes(Statistics& statistics, const std::vector<gpu::PassTime>& times) {
    for (const gpu::PassTime& pass : times) {
        const auto known = std::ranges::find(statistics.passes, pass.name, &PassTime::name);
        if (known == statistics.passes.end())
            statistics.passes.push_back({pass.name, pass.milliseconds, stageOf(pass.name)});
        else
            known->milliseconds += pass.milliseconds;
    }
}

Statistics finished(Statistics statistics, const photon::PhotonMap* photons) {
    if (photons != nullptr) addCounters(statistics, *photons);
    if (statistics.lost > 0)
        statistics.warnings.push_back(std::to_string(statistics.lost) + " of " + std::to_string(statistics.photons) +
                                      " photons scattered too often and were given up: their light is missing");
    if (statistics.saturated > 0)
        statistics.warnings.push_back(std::to_string(statistics.saturated) +
                                      " coefficients met the limit of their integers: the picture is too dark there");
    return statistics;
}

}  // namespace lumulus
