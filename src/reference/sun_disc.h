#pragma once

#include <glm/glm.hpp>

#include "reference/random.h"
#include "scene/sky.h"

namespace lumulus::reference {

/// Where the sun's disc stands, and how bright its parts are against their mean.
class SunDisc {
  public:
    explicit SunDisc(const scene::Sun& sun);

    /// The unit vector towards the middle of the disc.
    const glm::dvec3& direction() const { return direction_; }
    /// The angular radius in radians.
    double radius() const { return radius_; }
    /// 1 − cos of the radius: 2π times it is the disc's solid angle.
    double cone() const { return cone_; }

    /// The direction to a point of the disc, all of them equally likely. Draws one number more where the disc is no
    /// point.
    glm::dvec3 sample(Random& random) const;

    /// Radiance of a point of the disc over the mean of the disc. 1 for an even disc and for a point; else darker
    /// towards the rim by 0.3 + 0.93 c − 0.23 c², c the cosine at which the sun's surface is seen (Cox 2000).
    double limb(const glm::dvec3& direction) const;

    /// The same for any direction; 0 beside the disc, and for a point.
    double relativeRadiance(const glm::dvec3& direction) const;

    /// ∫ L dω over the disc for an irradiance of 1 on a plane that faces it: irradiance counts its points by their
    /// cosine.
    double fluence() const { return fluence_; }

    /// Mean radiance of the disc for an irradiance of 1, 1/sr; 0 for a sun that is a point.
    double meanRadiance() const { return meanRadiance_; }

  private:
    glm::dvec3 direction_;
    double radius_;
    double cone_;
    bool limb_;
    double fluence_;
    double meanRadiance_ = 0.0;
};

}  // namespace lumulus::reference
