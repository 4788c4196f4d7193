#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/image.h"
#include "reference/any_tracer.h"
#include "reference/disc_cover.h"
#include "reference/lamp_covers.h"
#include "scene/scene.h"
#include "vdb/placed_volume.h"
#include "view/camera.h"

namespace lumulus::reference {

/// What a path says of a pixel.
struct PixelSample {
    glm::dvec3 radiance{0.0};  ///< W·m⁻²·sr⁻¹; its mean is what the picture should show, but for the sun's disc
    bool lost = false;         ///< ended by the limit of scattering events
    int events = 0;            ///< that the path went through, a measure of its work
};

/// Unbiased paths through the pixels of a picture of a scene. Immutable; any number of threads may trace.
class PixelPaths {
  public:
    /// `volumes` are those of the scene's clouds with all their values, read here only. Errors: those of AnyTracer.
    PixelPaths(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes);

    /// Of pictures from another camera than the scene's.
    PixelPaths(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, const Camera& camera,
               const scene::Image& image);

    /// A path through a random point of a pixel, counted row by row from the upper left corner.
    PixelSample trace(std::size_t pixel, Random& random) const;

    /// How opaque clouds and fog are in each pixel of a picture, 0 to 1: by the picture's transmittance, which is that
    /// of clouds alone, and in a scene with fog as a ray through the pixel's middle finds it. 0 where the picture shows
    /// the sun's disc or the moon's, if only through a cloud: no path meets them.
    std::vector<float> opacity(const LayeredImage& picture) const;

    /// Whether the scene has fog, whose light is in `R`, `G` and `B` alone.
    bool foggy() const { return fog_; }
    /// Whether paths meet fog or air, which makes them long.
    bool hazy() const { return tracer_.hazy(); }

  private:
    Camera camera_;
    AnyTracer tracer_;
    glm::dvec3 skyUnit_;  ///< AnyTracer's; black where the background is left out
    LampCovers lamps_;
    std::vector<DiscCover> discs_;  ///< that the picture shows
    bool fog_;
    std::size_t width_;
};

/// The pixels in which clouds and fog are counted: with an opacity above 0.001.
std::vector<std::size_t> countedPixels(const std::vector<float>& opacity);

}  // namespace lumulus::reference
