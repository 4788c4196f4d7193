#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "sky/harmonics.h"
#include "sky/optical_depth.h"

namespace lumulus::sky {

/// A point of a ray in the air and its place against the sun.
struct AirPoint {
    double height = 0.0;  ///< m
    double up = 1.0;      ///< cosine of the ray to the upward direction
    double sun = 1.0;     ///< cosine of the sun to the upward direction
    double toSun = 1.0;   ///< cosine of the ray to the sun

    /// The point `t` metres on.
    AirPoint after(double t) const;
};

/// Light of all orders of scattering that arrives at the points of the air, per unit of sunlight above it: spherical
/// harmonics up to degree 4 in the frame of the upward direction and the sun, by height and by the sun's cosine.
class MultipleScattering {
  public:
    /// Iterates order by order until one adds less than 0.005; those that follow are summed as a geometric series.
    /// `discRadius`: of the sun, radians.
    MultipleScattering(const Air& air, const ColumnTable& columns, double discRadius);

    /// Radiance per metre that light which has scattered already adds to a ray.
    Spectrum source(const AirPoint& point, const AirDensity& density) const;
    /// Irradiance of the sky on level ground.
    Spectrum groundIrradiance(double sun) const;
    int orders() const { return orders_; }

    // For those who look at many points at once.
    struct Incident;
    const std::vector<Incident>& incident() const { return incident_; }
    const Spectrum& molecules() const { return molecules_; }
    const Spectrum& aerosol() const { return aerosol_; }
    const std::array<float, highestDegree + 1>& aerosolMoments() const { return aerosolMoments_; }

    static constexpr int sunTexels = 32, heightTexels = 24;
    /// Coefficients of light that is symmetric about the plane of the upward direction and the sun.
    struct Incident {
        glm::vec4 logMean{-70.0F};                     ///< logarithm of the mean's coefficient
        std::array<glm::vec4, harmonicCount> shape{};  ///< all against it; the first is 1
    };

  private:
    friend class ScatteringOrders;
    std::vector<Incident> incident_;              // of all orders
    std::array<Spectrum, sunTexels> irradiance_;  // by the sun's cosine
    std::array<float, highestDegree + 1> aerosolMoments_;
    Spectrum molecules_, aerosol_;
    int orders_ = 0;
};

}  // namespace lumulus::sky
