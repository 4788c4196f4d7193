#pragma once

#include <filesystem>
#include <vector>

#include "base/image.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace lumulus::cli {

/// Notes in the header of a picture what made it.
void noteOrigin(LayeredImage& image, const scene::Scene& scene, const Statistics& statistics);

/// Writes a picture to each of these files, .exr or .png.
void writePictures(const std::vector<std::filesystem::path>& outputs, const LayeredImage& image,
                   const scene::Image& how);

}  // namespace lumulus::cli
