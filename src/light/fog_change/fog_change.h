#pragma once

#include <cstdint>
#include <vector>

#include "base/interrupt.h"
#include "light/fog_change/pair_walk.h"
#include "light/fog_light/air_over_fog.h"
#include "view/camera.h"

/// What clouds change in the light of level fog: all that they add to it and take from it, but for the shadow in the
/// sun's light that fog has not scattered yet.
namespace lumulus::fog_change {

/// Light that comes to the clouds, and their medium.
struct ChangeSources {
    const fog_light::FogSurroundings& fog;  ///< as it is without clouds
    glm::dvec3 toSun{0.0, 1.0, 0.0};
    glm::dvec3 sun{0.0};  ///< irradiance across the sun's light above all fog and air [W/m²]
    const CloudGrid& clouds;
    const CloudMedium& medium;
    std::uint64_t starts = 0;  ///< of photons
    std::uint64_t seed = 1;
};

/// Light of the fog that clouds change, as a picture sees it up to points on its rays [W/(m² sr)]:
/// [depth][row][column]. Columns and rows are evenly spaced from border to border; a depth t of 0 to 1 lies at near +
/// (far − near) t² metres.
struct ChangeSeen {
    glm::ivec3 size{0};
    double near = 0.0, far = 1.0;
    std::vector<glm::vec4> light;
};

class FogChange {
  public:
    /// Follows the photons on all threads; their number changes no bit. Errors: what `check` throws, which is asked on
    /// any thread.
    FogChange(const ChangeSources& sources, const Check& check);

    const ChangeCells& cells() const { return cells_; }
    std::size_t bytes() const { return cells_.bytes(); }
    /// For pictures of a camera. Errors: as above.
    ChangeSeen seenBy(const Camera& camera, const Check& check) const;
    /// Light that the fog scatters towards a direction of travel at a point [W/(m³ sr)], where it is what clouds
    /// change.
    struct Scattered {
        glm::dvec3 turned{0.0};  ///< beyond a peak
        glm::dvec3 once{0.0};    ///< the part of it that is the sun's and was not scattered before
    };
    Scattered scatteredAt(const glm::dvec3& point, const glm::dvec3& direction) const;

  private:
    Scattered scatteredAt(const glm::dvec3& point, const glm::dvec3& direction,
                          const std::array<float, coefficientCount>& harmonics) const;
    void seeRay(const Ray& ray, ChangeSeen& seen, std::size_t place) const;

    glm::dvec3 toSun_;
    FogPaths paths_;
    ChangeCells cells_;
};

}  // namespace lumulus::fog_change
