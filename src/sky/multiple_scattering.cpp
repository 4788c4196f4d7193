#include "sky/multiple_scattering.h"

#include <algorithm>
#include <cmath>

#include "sky/scattering_orders.h"
#include "sky/scattering_table.h"
#include "sky/shell.h"

namespace lumulus::sky {

using glm::vec4;

namespace {

/// Light that arrives in a direction, by degree.
using ByDegree = std::array<vec4, highestDegree + 1>;

ByDegree lookUp(const std::vector<MultipleScattering::Incident>& incident, const AirPoint& point) {
    constexpr int sunTexels = MultipleScattering::sunTexels;
    const TableCell cell = tableCell(point.height, point.sun);
    const MultipleScattering::Incident* const at = &incident[cell.first];
    const std::array<const MultipleScattering::Incident*, 4> corners{at, at + 1, at + sunTexels, at + sunTexels + 1};
    const float x = cell.sun, y = cell.height;
    const std::array<float, 4> weights{(1.0F - x) * (1.0F - y), x * (1.0F - y), (1.0F - x) * y, x * y};
    const HeightFactors byHeight = heightFactors(point.up);
    const AzimuthFactors byAzimuth =
        azimuthFactors(static_cast<float>(point.up), static_cast<float>(acrossTowardsSun(point)));
    vec4 logarithm(0.0F);
    ByDegree light{};
    for (std::size_t i = 0; i < 4; ++i) {
        logarithm += weights[i] * corners[i]->logMean;
        std::size_t k = 0;
        for (std::size_t l = 0; l <= highestDegree; ++l)
            for (std::size_t m = 0; m <= l; ++m, ++k)
                light[l] += weights[i] * byHeight[k] * byAzimuth[m] * corners[i]->shape[k];
    }
    const vec4 scale = glm::exp(logarithm);
    for (vec4& degree : light) degree *= scale;
    return light;
}

}  // namespace

AirPoint AirPoint::after(double t) const {
    AirPoint p = *this;
    p.height = std::max(0.0, heightAlong(height, up, t));
    const double r = planetRadius + height, there = planetRadius + p.height;
    p.up = std::clamp((r * up + t) / there, -1.0, 1.0);
    p.sun = std::clamp((r * sun + t * toSun) / there, -1.0, 1.0);
    return p;
}

MultipleScattering::MultipleScattering(const Air& air, const ColumnTable& columns, double discRadius)
    : irradiance_{}, aerosolMoments_(momentsOf(air)), molecules_(air.molecules), aerosol_(air.aerosolScattering) {
    ScatteringOrders(air, columns, discRadius).run(*this);
}

Spectrum MultipleScattering::source(const AirPoint& point, const AirDensity& density) const {
    const ByDegree light = lookUp(incident_, point);
    vec4 byAerosol(0.0F);
    for (std::size_t l = 0; l <= highestDegree; ++l) byAerosol += aerosolMoments_[l] * light[l];
    const Spectrum scattered = density.molecules * molecules_ * Spectrum(light[0] + 0.1F * light[2]) +
                               density.aerosol * aerosol_ * Spectrum(byAerosol);
    return glm::max(scattered, Spectrum(0.0)) * sunFade(point.sun);
}

Spectrum MultipleScattering::groundIrradiance(double sun) const {
    const TableCell cell = tableCell(0.0, sun);
    const std::size_t i = cell.first % sunTexels;
    const double x = static_cast<double>(cell.sun);
    return ((1.0 - x) * irradiance_[i] + x * irradiance_[i + 1]) * sunFade(sun);
}

}  // namespace lumulus::sky
