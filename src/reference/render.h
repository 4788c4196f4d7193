#pragma once

#include <cstdint>
#include <functional>

#include "reference/any_tracer.h"
#include "reference/disc_cover.h"
#include "reference/film.h"
#include "reference/lamp_covers.h"
#include "view/camera.h"

namespace lumulus::reference {

/// Renders a scene without bias, one sample of every pixel at a time.
class Renderer {
  public:
    /// Called between bands of rows with the number of rows done since the last call; false stops the pass.
    using Continue = std::function<bool(std::uint64_t rows)>;

    /// `volumes`: one for each cloud of the scene, read in the constructor only.
    /// Errors: InputError for a scene that makes no sense (see makeCamera, PhaseFunction).
    Renderer(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, Majorant majorant,
             std::uint64_t seed, int scatterings = allScatterings);

    /// Adds a sample to every pixel, at a random point of the pixel (a box filter), on all threads of TBB. The sun's
    /// disc is looked at through a random point of what it covers. A pass that is stopped leaves the film as it was and
    /// returns false.
    bool pass(const Continue& goOn);

    const Film& film() const { return film_; }
    /// Continues a film of the same fingerprint.
    void resume(Film film);
    /// Adds time that was spent on the film.
    void addSeconds(double seconds) { film_.seconds += seconds; }
    /// Hash of everything that the film depends on.
    std::uint64_t fingerprint() const { return fingerprint_; }

    /// The layers of the film (one sample at least) and depth.front: metres along the ray through the pixel's middle to
    /// the nearest point of cloud or surface, farDepth if there is none.
    LayeredImage picture() const;

  private:
    /// One sample of a pixel, and what it adds to the count of lost paths.
    struct Sample {
        PixelSums sums;
        bool lost = false;
    };

    Sample sample(int x, int y) const;

    Camera camera_;
    AnyTracer tracer_;
    glm::dvec3 skyUnit_, discUnit_;  ///< AnyTracer's
    bool background_;                ///< whether samples hold the sky and the sun's disc directly behind
    DiscCover discCover_;
    LampCovers lamps_;
    std::uint64_t seed_;
    std::uint64_t fingerprint_;
    Film film_;
    std::vector<Sample> pass_;  ///< samples of the current pass
};

}  // namespace lumulus::reference
