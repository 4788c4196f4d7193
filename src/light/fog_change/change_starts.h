#pragma once

#include "light/fog_change/fog_change.h"

namespace lumulus::fog_change {

/// Photons that bring light to the box of the clouds: of the sun, of fog, sky and ground, and of what absorbs there.
class ChangeStarts {
  public:
    explicit ChangeStarts(const ChangeSources& sources);

    std::uint64_t count() const { return sun_ + diffuse_ + absorbed_; }
    /// Follows the photon of a number below count().
    void follow(std::uint64_t number, PairWalk& walk) const;

  private:
    struct Place {
        glm::dvec3 position{0.0}, inwards{0.0};
    };
    double seenFromSun() const;
    Place onBox(const glm::dvec3& areas, double face, double u, double v) const;
    void followSun(std::uint64_t number, PairWalk& walk) const;
    void followDiffuse(std::uint64_t number, PairWalk& walk) const;
    void followAbsorbed(std::uint64_t number, PairWalk& walk) const;
    double density(const glm::dvec3& direction, const glm::dvec3& inwards) const;
    double findMean();

    const ChangeSources& sources_;
    std::uint64_t sun_ = 0, diffuse_ = 0, absorbed_ = 0;
    glm::dvec3 size_{0.0};
    glm::dvec3 mean_{0.0};     ///< radiance on the box, which makes no difference but where something absorbs
    double towardsSun_ = 0.0;  ///< share of directions that are chosen about the sun's
};

}  // namespace lumulus::fog_change
