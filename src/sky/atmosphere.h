#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "scene/scene.h"
#include "sky/air.h"
#include "sky/air_path.h"
#include "sky/multiple_scattering.h"
#include "sky/optical_depth.h"

namespace lumulus::sky {

/// Luminous efficacy that Rec. 709 in W/m² is meant with: 683 lm/W.
inline constexpr double lumensPerWatt = 683.0;

/// Luminance of the night sky without a moon, 21.9 mag/arcsec² [cd/m²].
inline constexpr double nightLuminance = 1.9e-4;

/// Luminance [cd/m²] of a radiance in Rec. 709, or illuminance [lx] of an irradiance.
inline double photometric(const glm::dvec3& rgb) {
    return lumensPerWatt * glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// What the air does along a path, per unit of sunlight above it.
struct AirLight {
    Spectrum scattered{0.0};      ///< all but sunlight that aerosol scattered once [1/sr]
    Spectrum aerosol{0.0};        ///< that, without the phase function
    Spectrum transmittance{1.0};  ///< of the path

    /// Both together, where the ray and the sun are apart by an angle of this cosine.
    Spectrum light(const Air& air, double toSun) const { return scattered + air.aerosolPhase(toSun) * aerosol; }
};

/// The atmosphere of a planet: a spherical shell of molecules, aerosol and ozone above Lambert's ground, lit by a sun.
/// It is immutable and the same for every place of the sun; all of its answers are in double precision. Lengths are
/// metres, directions unit vectors of the world, whose ground lies at (foot.x, groundHeight, foot.y).
class Atmosphere {
  public:
    /// Makes the tables: about a tenth of a second. Where the scene has a ground, its albedo and height count, else
    /// those of the sky. `angularDiameter`: of the sun, degrees.
    explicit Atmosphere(const scene::Sky& sky, const std::optional<scene::Ground>& ground = {},
                        double angularDiameter = 0.53);
    /// The same of any air, above ground at that height of the world.
    Atmosphere(const Air& air, double groundHeight, double angularDiameter);

    /// The same above ground of another albedo.
    Atmosphere withGround(const glm::dvec3& albedo) const;

    // In the world. Colours are linear Rec. 709, those of sunlight at the sun's mean distance.

    /// Radiance of sky and ground that arrives from a direction at a point, with that of the night and without the
    /// sun's disc [W/(m² sr)].
    glm::dvec3 radiance(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& toSun) const;
    /// Irradiance of the sun's disc on a plane that faces it, with the part that the ground hides [W/m²].
    glm::dvec3 sunIrradiance(const glm::dvec3& point, const glm::dvec3& toSun) const;
    /// The same against that above the air: the share of the sun's light that arrives, by channel.
    glm::dvec3 sunColour(const glm::dvec3& point, const glm::dvec3& toSun) const;
    /// Irradiance of the sky on a level plane, without the sun [W/m²].
    glm::dvec3 skyIrradiance(const glm::dvec3& point, const glm::dvec3& toSun) const;
    /// The sun's irradiance above the air [W/m²].
    glm::dvec3 sunAbove() const { return air_.sunAbove(); }
    /// Radiance of the night sky along a ray through air of that transmittance, where the sun has that of its mean
    /// distance: from all the air the same, less from the ground, and none from space alone [W/(m² sr)].
    glm::dvec3 night(bool ground, const Spectrum& transmittance) const;
    /// Height of a point above the ground, negative below it.
    double heightAt(const glm::dvec3& point) const;
    /// Upward direction at a point.
    glm::dvec3 upAt(const glm::dvec3& point) const;
    /// A ray that begins at a point, as the functions below take it.
    AirPoint at(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& toSun) const;

    // At the four wavelengths.

    /// Light of the whole ray: to the ground, with what that reflects, or to space.
    AirLight sky(const AirPoint& from, int steps = 48) const;
    /// The same with the path of path(), which is the same for all rays of a height and a cosine.
    AirLight sky(const AirPoint& from, const AirPath& path) const;
    AirPath path(double height, double up, int steps) const;
    /// Light of the first `length` metres, that lie above the ground.
    AirLight along(const AirPoint& from, double length, int steps = 32) const;
    /// Lengthens a path that ends at `from` by `length` metres.
    void extend(AirLight& light, const AirPoint& from, double length, int steps) const;
    /// Transmittance to the sun's disc, times its visible share.
    Spectrum sunTransmittance(double height, double sun) const;
    /// Radiance of the ground where the sun stands at this cosine to the upward direction [1/sr].
    Spectrum groundRadiance(double sun) const;
    const Air& air() const { return air_; }
    const ColumnTable& columns() const { return columns_; }
    const MultipleScattering& multipleScattering() const { return multiple_; }
    double groundHeight() const { return groundHeight_; }
    /// The point at a height above the ground where upwards is the world's y.
    glm::dvec3 aboveFoot(double height) const { return {foot_.x, groundHeight_ + height, foot_.y}; }
    /// Angular radius of the sun [radians].
    double discRadius() const { return discRadius_; }

  private:
    AirLight along(const AirPoint& from, const AirPath& path) const;

    double discRadius_, groundHeight_;
    glm::dvec2 foot_{0.0};
    Air air_;
    ColumnTable columns_;
    MultipleScattering multiple_;
};

}  // namespace lumulus::sky
