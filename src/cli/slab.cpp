#include "cli/slab.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "base/log.h"
#include "cli/output.h"
#include "gpu/context.h"
#include "reference/slab.h"

namespace lumulus::cli {
namespace {

struct Fraction {
    const char* name;
    double value = 0.0;
    double standardError = 0.0;
};

using Fractions = std::array<Fraction, 4>;

template <typename Result>
Fractions fractionsOf(const Result& result) {
    const auto one = [](const char* name, const auto& f) { return Fraction{name, f.value, f.standardError}; };
    return {one("reflected", result.reflected), one("transmitted_diffuse", result.transmittedDiffuse),
            one("transmitted_direct", result.transmittedDirect), one("absorbed", result.absorbed)};
}

nlohmann::ordered_json jsonOf(const Fractions& fractions, std::uint64_t photons) {
    nlohmann::ordered_json json, errors;
    for (const Fraction& fraction : fractions) {
        json[fraction.name] = fraction.value;
        errors[fraction.name] = fraction.standardError;
    }
    json["standard_error"] = errors;
    json["photons"] = photons;
    return json;
}

std::string textOf(const Fractions& fractions) {
    std::string text;
    for (const Fraction& fraction : fractions)
        text += fmt::format("{:<20} {:.7f} ± {:.7f}\n", fraction.name, fraction.value, fraction.standardError);
    return text;
}

void runPhotonWalk(const SlabOptions& options) {
    gpu::Context context({options.device, false});
    const photon::SlabResult result = photon::traceSlab(context, options.slab);
    if (result.lost > 0)
        logWarning(
            fmt::format("{} of {} photons met the collision limit and are lost", result.lost, options.slab.photons));
    const Fractions fractions = fractionsOf(result);
    if (!options.json) return printOut(textOf(fractions));
    nlohmann::ordered_json json = jsonOf(fractions, options.slab.photons);
    json["events"] = result.events;
    json["lost"] = result.lost;
    printOut(json.dump() + "\n");
}

void runReferenceTracer(const SlabOptions& options) {
    const photon::Slab& slab = options.slab;
    const Fractions fractions =
        fractionsOf(reference::solveSlab({slab.tau, slab.phase, slab.albedo, slab.mu0, slab.photons, slab.seed}));
    printOut(options.json ? jsonOf(fractions, slab.photons).dump() + "\n" : textOf(fractions));
}

}  // namespace

void runSlab(const SlabOptions& options) {
    options.reference ? runReferenceTracer(options) : runPhotonWalk(options);
}

}  // namespace lumulus::cli
