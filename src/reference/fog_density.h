#pragma once

#include <optional>

#include "reference/medium.h"
#include "reference/shell_exponential.h"
#include "scene/fog.h"

namespace lumulus::reference {

/// The relative density ϱ of one fog medium along a part of one ray: its integral P(t) in metres and the inverse of the
/// integral, in double precision; in closed form but for a falloff above a round planet.
class FogDensity {
  public:
    /// Nothing.
    FogDensity() = default;

    /// `part` is the part of the ray that has fog. The ray's direction is a unit vector. `planet`: y of a round
    /// planet's surface at x = z = 0, whose curve a vertical falloff follows.
    FogDensity(const scene::FogMedium& medium, const Ray& ray, const Interval& part,
               const std::optional<double>& planet = std::nullopt);

    /// ∫ ϱ from the ray's origin to `metres`; at most 1e200.
    double pathTo(double metres) const;

    /// Metres at which the integral reaches `path`; infinity if it never does.
    double metresTo(double path) const;

  private:
    void enterExponential(const scene::FogMedium& medium, const Ray& ray, const std::optional<double>& planet);
    void enterSphere(const scene::FogMedium& medium, const Ray& ray);
    void enterEllipsoid(const scene::FogMedium& medium, const Ray& ray);
    void enterBox(const scene::FogMedium& medium, const Ray& ray);
    void cut(double begin, double end);
    double exponentialPath(double length) const;
    double exponentialLength(double path) const;
    double spherePath(double length) const;
    double sphereLength(double path) const;

    scene::MediumKind kind_ = scene::MediumKind::homogeneous;
    Interval part_;
    double exponent_ = 0.0;   ///< exponential: −ln ϱ where the part begins
    double slope_ = 0.0;      ///< exponential: growth of that exponent, 1/m
    double closest_ = 0.0;    ///< sphere: metres to the point nearest to the centre
    double halfChord_ = 0.0;  ///< sphere, metres
    double radius_ = 1.0;
    std::optional<ShellExponential> shell_;
};

}  // namespace lumulus::reference
