#include "cli/picture_files.h"

#include <string>

#include "base/version.h"
#include "cli/clouds_told.h"
#include "cli/output.h"

namespace lumulus::cli {

void noteOrigin(LayeredImage& image, const scene::Scene& scene, const Statistics& statistics) {
    image.attributes["scene"] = scene.source;
    image.attributes["seed"] = std::to_string(scene.photonMap.seed);
    image.attributes["software"] = std::string("lumulus ") + version;
    image.attributes["device"] = statistics.device;
    image.attributes["samples"] = std::to_string(statistics.photons);
    noteGrids(image, statistics.clouds);
}

void writePictures(const std::vector<std::filesystem::path>& outputs, const LayeredImage& image,
                   const scene::Image& how) {
    for (const auto& output : outputs) writePicture(output, image, how);
}

}  // namespace lumulus::cli
