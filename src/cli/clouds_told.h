#pragma once

#include <span>
#include <string>

#include "base/image.h"
#include "scene/scene.h"
#include "volume/summary.h"

namespace lumulus::cli {

/// Tells on stderr, before the work, what is warned of, and unless `quiet` a line for each cloud with the grid that was
/// taken and its optical thickness.
void tellClouds(std::span<const CloudSummary> clouds, std::span<const std::string> warnings, bool quiet);

/// Tells that a file of clouds was given in place of a scene, if that was so.
void tellDefaults(const scene::Scene& scene, bool quiet);

/// Notes the grids that were taken in the header of a picture.
void noteGrids(LayeredImage& image, std::span<const CloudSummary> clouds);

}  // namespace lumulus::cli
