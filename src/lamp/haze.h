#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "scene/fog.h"
#include "view/camera.h"

namespace lumulus::lamp {

/// The fog of a scene around an eye, for light that lamps send through it. Places are in the world, metres.
class Haze {
  public:
    Haze(const scene::Fog& fog, const glm::dvec3& eye);
    ~Haze();

    bool isClear() const { return fog_.media.empty(); }

    /// Optical depth from the ray's origin to `metres`.
    glm::dvec3 depth(const Ray& ray, double metres) const;

    /// Scattering coefficient times phase function, for light scattered by an angle of this cosine [1/(m sr)].
    glm::dvec3 turned(const glm::dvec3& point, double cosine) const;

    /// Scattering and extinction coefficients [1/m].
    glm::dvec3 scattering(const glm::dvec3& point) const;
    glm::dvec3 extinction(const glm::dvec3& point) const;

    /// Mean cosine of the medium that scatters at a point, chosen by a number in [0, 1).
    double meanCosine(const glm::dvec3& point, double u) const;

    /// Adds the distances at which the ray enters or leaves a medium [m].
    void addCorners(const Ray& ray, std::vector<double>& distances) const;

  private:
    double densityAt(const scene::FogMedium& medium, const glm::dvec3& point) const;

    struct Media;
    scene::Fog fog_;
    glm::dvec3 eye_;
    std::unique_ptr<const Media> media_;
};

/// Henyey–Greenstein's phase function [1/sr].
double phase(double g, double cosine);

}  // namespace lumulus::lamp
