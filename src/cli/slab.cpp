#include "cli/slab.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "cli/output.h"
#include "gpu/context.h"

namespace lumulus::cli {

void runSlab(const SlabOptions& options) {
    gpu::Context context({options.device, false});
    const photon::SlabResult result = photon::traceSlab(context, options.slab);
    if (result.lost > 0)
        logWarning(
            fmt::format("{} of {} photons met the collision limit and are lost", result.lost, options.slab.photons));
    const std::pair<const char*, photon::SlabFraction> rows[] = {{"reflected", result.reflected},
                                                                 {"transmitted_diffuse", result.transmittedDiffuse},
                                                                 {"transmitted_direct", result.transmittedDirect},
                                                                 {"absorbed", result.absorbed}};
    if (options.json) {
        nlohmann::ordered_json json, errors;
        for (const auto& [name, fraction] : rows) {
            json[name] = fraction.value;
            errors[name] = fraction.standardError;
        }
        json["standard_error"] = errors;
        json["photons"] = options.slab.photons;
        json["events"] = result.events;
        json["lost"] = result.lost;
        printOut(json.dump() + "\n");
        return;
    }
    std::string text;
    for (const auto& [name, fraction] : rows)
        text += fmt::format("{:<20} {:.7f} ± {:.7f}\n", name, fraction.value, fraction.standardError);
    printOut(text);
}

}  // namespace lumulus::cli
