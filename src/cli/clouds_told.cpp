#include "cli/clouds_told.h"

#include <algorithm>
#include <filesystem>

#include "base/log.h"

namespace lumulus::cli {

void tellClouds(std::span<const CloudSummary> clouds, std::span<const std::string> warnings, bool quiet) {
    constexpr std::size_t most = 8;
    for (const std::string& warning : warnings) logWarning(warning);
    if (quiet) return;
    for (const CloudSummary& cloud : clouds.first(std::min(clouds.size(), most))) logNote(lineOf(cloud));
    if (clouds.size() > most) logNote(std::to_string(clouds.size() - most) + " more clouds");
}

void tellDefaults(const scene::Scene& scene, bool quiet) {
    const std::filesystem::path source(scene.source);
    if (quiet || scene.clouds.empty() || source.empty() ||
        scene.clouds[0].vdb.lexically_normal() != source.lexically_normal())
        return;
    logNote(scene.source +
            " is an OpenVDB file: it was shown with the defaults of a scene; --set changes them "
            "(docs/scene-format.md)");
}

void noteGrids(LayeredImage& image, std::span<const CloudSummary> clouds) {
    if (!clouds.empty()) image.attributes["grid"] = gridNames(clouds);
}

}  // namespace lumulus::cli
