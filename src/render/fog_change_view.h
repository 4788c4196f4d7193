#pragma once

#include <optional>
#include <vector>

#include "base/interrupt.h"
#include "fog/screen/fog.h"
#include "light/fog_change/fog_change.h"
#include "render/world.h"

namespace lumulus {

/// What clouds change in the light of a world's fog, as pictures show it: made anew where light, fog or clouds have
/// changed.
class FogChangeView {
  public:
    /// Of a world with light of fog and clouds.
    FogChangeView(gpu::Context& context, const World& world, const Check& check);

    /// What a camera sees of it. For a `coarse` picture (View::coarse) what has changed is made of fewer photons.
    /// Errors: Error where interrupted or out of memory.
    const fog_change::ChangeSeen& seenBy(gpu::Context& context, World& world, const Camera& camera, bool coarse,
                                         const Check& check);
    /// The filter of light that peaks of the fog's scattering spread.
    fog::Fog& peaks() { return peaks_; }
    /// Bytes on the host.
    std::uint64_t bytes() const;

  private:
    /// What it depends on.
    struct Made {
        std::vector<glm::dvec3> places;  ///< of all clouds from the first
        std::vector<double> extinctions;
        double height = 0.0;  ///< of the first cloud
        std::uint64_t fogVersion = 0;

        bool hasCloudsOf(const Made& other) const {
            return places == other.places && extinctions == other.extinctions && height == other.height;
        }
    };

    void update(gpu::Context& context, World& world, bool coarse, const Check& check);

    fog::Fog peaks_;
    std::optional<fog_change::CloudGrid> grid_;
    std::optional<fog_change::FogChange> change_;
    fog_change::ChangeSeen seen_;
    Made made_;
    glm::dvec3 first_{0.0}, drift_{0.0};  ///< where the first cloud was, and how far it has come since
    bool isCoarse_ = false;
};

/// Whether clouds may change the light of a world's fog.
bool changesFog(const World& world);

}  // namespace lumulus
