#include "sky/multiple_scattering.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "sky/path_steps.h"
#include "sky/shell.h"
#include "sky/sun_reach.h"

namespace lumulus::sky {

using std::numbers::pi;
using Incident = MultipleScattering::Incident;
using glm::vec4;

namespace {

constexpr int sunTexels = MultipleScattering::sunTexels, heightTexels = MultipleScattering::heightTexels;
constexpr int texels = sunTexels * heightTexels;
constexpr double lowestSun = -0.5;  // of the root of the cosine: 14.5° below the horizon
constexpr int polar = 4, azimuths = 4, directions = 2 * polar * azimuths, steps = 20, mostOrders = 30;

/// Gauss's rule in [0,1].
constexpr std::array<double, polar> nodes{0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                          0.93056815579702629};
constexpr std::array<double, polar> nodeWeights{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                                0.17392742256872693};

// constants of real spherical harmonics: 1, u, x, 3u² − 1, u x, x² − y²
constexpr double mean = 0.28209479177387814, degree1 = 0.48860251190291992, upwards2 = 0.31539156525252005,
                 mixed2 = 1.0925484305920792, across2 = 0.54627421529603959;

double sunOfTexel(double i) {
    const double root = lowestSun + (1.0 - lowestSun) * i / (sunTexels - 1.0);
    return root * std::abs(root);
}

double heightOfTexel(int j) {
    return airTop * std::pow(j / (heightTexels - 1.0), 2);
}

/// Between four texels.
struct Cell {
    std::uint32_t first;
    float sun, height;  // fractions
};

Cell cellOf(double height, double sun) {
    const double root = std::copysign(std::sqrt(std::abs(sun)), sun);
    const double x = std::clamp((root - lowestSun) / (1.0 - lowestSun), 0.0, 1.0) * (sunTexels - 1.0);
    const double y = std::sqrt(std::clamp(height / airTop, 0.0, 1.0)) * (heightTexels - 1.0);
    const int i = std::min(static_cast<int>(x), sunTexels - 2), j = std::min(static_cast<int>(y), heightTexels - 2);
    return {static_cast<std::uint32_t>(j * sunTexels + i), static_cast<float>(x - i), static_cast<float>(y - j)};
}

/// The sun this far down lights nothing that the table reaches.
double fade(double sun) {
    return std::clamp((sun + 0.3) / 0.05, 0.0, 1.0);
}

/// Spherical harmonics of a direction.
struct Basis {
    std::array<float, 5> values;
};

Basis basisOf(const AirPoint& p) {
    const double sine2 = 1.0 - p.sun * p.sun;
    const double x = sine2 > 1e-9 ? std::clamp((p.toSun - p.sun * p.up) / std::sqrt(sine2), -1.0, 1.0) : 0.0;
    const double y2 = std::max(0.0, 1.0 - p.up * p.up - x * x);
    return {{static_cast<float>(degree1 * p.up), static_cast<float>(degree1 * x),
             static_cast<float>(upwards2 * (3.0 * p.up * p.up - 1.0)), static_cast<float>(mixed2 * p.up * x),
             static_cast<float>(across2 * (x * x - y2))}};
}

/// Light that arrives, by degree, in a direction.
struct ByDegree {
    vec4 degree0, degree1, degree2;
};

ByDegree lookUp(const std::vector<Incident>& incident, const Cell& cell, const Basis& basis) {
    const Incident* const at = &incident[cell.first];
    const std::array<const Incident*, 4> corners{at, at + 1, at + sunTexels, at + sunTexels + 1};
    const float x = cell.sun, y = cell.height;
    const std::array<float, 4> weights{(1.0F - x) * (1.0F - y), x * (1.0F - y), (1.0F - x) * y, x * y};
    vec4 logarithm(0.0F), first(0.0F), second(0.0F);
    const std::array<float, 5>& b = basis.values;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::array<vec4, 5>& shape = corners[i]->shape;
        logarithm += weights[i] * corners[i]->logMean;
        first += weights[i] * (b[0] * shape[0] + b[1] * shape[1]);
        second += weights[i] * (b[2] * shape[2] + b[3] * shape[3] + b[4] * shape[4]);
    }
    const vec4 scale = glm::exp(logarithm);
    return {scale * static_cast<float>(mean), scale * first, scale * second};
}

Incident incidentOf(const std::array<Spectrum, 6>& coefficients) {
    Incident incident;
    const Spectrum first = glm::max(coefficients[0], Spectrum(1e-30));
    incident.logMean = vec4(glm::log(first));
    for (std::size_t i = 0; i < 5; ++i) incident.shape[i] = vec4(coefficients[i + 1] / first);
    return incident;
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

/// The iteration. What a step of a ray weighs is the same for all orders, and is found once.
class ScatteringOrders {
  public:
    ScatteringOrders(const Air& air, const ColumnTable& columns, double discRadius)
        : air_(air),
          columns_(columns),
          discRadius_(discRadius),
          rays_(static_cast<std::size_t>(texels) * directions),
          coefficients_(texels),
          irradiance_{} {
        const auto moments = air.aerosolMoments();
        moments_ = {static_cast<float>(moments[1]), static_cast<float>(moments[2])};
        tbb::parallel_for(0, texels, [&](int texel) { firstOrder(texel); });
    }

    void run(MultipleScattering& result);

  private:
    struct Step {
        Cell cell;
        Basis basis;
        vec4 molecules, aerosol;  // scattering of the step as it is seen from the ray's beginning
    };
    struct Ray {
        std::array<Step, steps> step;
        vec4 ground{0.0F};  // what it sees of the ground's irradiance, divided by π and with the albedo
        float sun = 0.0F;   // texel of its place on the ground
    };
    using Coefficients = std::array<Spectrum, 6>;

    AirPoint start(int texel, int direction, double& solidAngle) const;
    void firstOrder(int texel);
    double aerosolSum(int texel) const;
    Spectrum prepare(const AirPoint& from, double aerosolPhase, Ray& ray) const;
    Spectrum radiance(const Ray& ray, const std::vector<Incident>& incident) const;
    Spectrum irradianceAt(float texel) const;
    void add(int texel, const AirPoint& from, double solidAngle, const Spectrum& radiance);
    void nextOrder(int texel, const std::vector<Incident>& incident);

    const Air& air_;
    const ColumnTable& columns_;
    double discRadius_;
    glm::vec2 moments_;
    std::vector<Ray> rays_;
    std::vector<Coefficients> coefficients_;               // of one order
    std::array<Spectrum, sunTexels> irradiance_, before_;  // of the sky on the ground; of the order before
};

/// A ray that arrives at a texel: its beginning there, and its share of the sphere. Above and below the horizon have a
/// rule each.
AirPoint ScatteringOrders::start(int texel, int direction, double& solidAngle) const {
    AirPoint p;
    p.height = heightOfTexel(texel / sunTexels);
    p.sun = sunOfTexel(texel % sunTexels);
    const double horizon = horizonCosine(p.height);
    const auto node = static_cast<std::size_t>(direction / azimuths % polar);
    const bool above = direction < polar * azimuths;
    const double width = above ? 1.0 - horizon : 1.0 + horizon;
    p.up = above ? horizon + width * nodes[node] : horizon - width * nodes[node];
    solidAngle = width * nodeWeights[node] * 2.0 * pi / azimuths;
    const double azimuth = pi * (direction % azimuths + 0.5) / azimuths;
    p.toSun = p.up * p.sun + std::sqrt((1.0 - p.up * p.up) * std::max(0.0, 1.0 - p.sun * p.sun)) * std::cos(azimuth);
    return p;
}

/// Finds the steps of a ray and the light that reaches its beginning after one scattering or reflection.
Spectrum ScatteringOrders::prepare(const AirPoint& from, double aerosol, Ray& ray) const {
    const double ground = distanceToGround(from.height, from.up);
    const double length = std::isfinite(ground) ? ground : distanceToTop(from.height, from.up);
    const PathSteps path(length, -(planetRadius + from.height) * from.up, steps);
    Spectrum passed(1.0), light(0.0);
    const double molecules = moleculePhase(from.toSun);
    for (int i = 0; i < steps; ++i) {
        const AirPoint p = from.after(path.middle(i));
        const AirDensity density = airDensity(p.height);
        const Spectrum extinction = air_.extinction(density), through = glm::exp(-extinction * path.length(i));
        const Spectrum weight = passed * (1.0 - through) / glm::max(extinction, Spectrum(1e-30));
        const Spectrum byMolecules = density.molecules * air_.molecules * weight;
        const Spectrum byAerosol = density.aerosol * air_.aerosolScattering * weight;
        light += sunTransmittance(air_, columns_, p.height, p.sun, discRadius_) *
                 (molecules * byMolecules + aerosol * byAerosol);
        const double lit = fade(p.sun);
        ray.step[static_cast<std::size_t>(i)] = {cellOf(p.height, p.sun), basisOf(p), vec4(lit * byMolecules),
                                                 vec4(lit * byAerosol)};
        passed *= through;
    }
    if (std::isfinite(ground)) {
        const AirPoint p = from.after(ground);
        ray.ground = vec4(passed * air_.groundAlbedo / pi * fade(p.sun));
        const Cell cell = cellOf(0.0, p.sun);
        ray.sun = static_cast<float>(cell.first % sunTexels) + cell.sun;
        light += passed * air_.groundAlbedo / pi * std::max(0.0, p.sun) *
                 sunTransmittance(air_, columns_, 0.0, p.sun, discRadius_);
    }
    return light;
}

void ScatteringOrders::add(int texel, const AirPoint& from, double solidAngle, const Spectrum& radiance) {
    Coefficients& sum = coefficients_[static_cast<std::size_t>(texel)];
    const Basis basis = basisOf(from);
    sum[0] += radiance * (solidAngle * mean);
    for (std::size_t i = 0; i < 5; ++i) sum[i + 1] += radiance * (solidAngle * static_cast<double>(basis.values[i]));
    if (texel < sunTexels && from.up > 0.0)
        irradiance_[static_cast<std::size_t>(texel)] += radiance * (solidAngle * from.up);
}

/// Integral of aerosol's phase function by the directions of a texel: not 1, because they are too few for its peak.
double ScatteringOrders::aerosolSum(int texel) const {
    double sum = 0.0;
    for (int direction = 0; direction < directions; ++direction) {
        double solidAngle = 0.0;
        const AirPoint from = start(texel, direction, solidAngle);
        sum += solidAngle * air_.aerosolPhase(from.toSun);
    }
    return sum;
}

void ScatteringOrders::firstOrder(int texel) {
    const double sum = aerosolSum(texel);
    for (int direction = 0; direction < directions; ++direction) {
        double solidAngle = 0.0;
        const AirPoint from = start(texel, direction, solidAngle);
        Ray& ray = rays_[static_cast<std::size_t>(texel) * directions + static_cast<std::size_t>(direction)];
        add(texel, from, solidAngle, prepare(from, air_.aerosolPhase(from.toSun) / sum, ray));
    }
}

Spectrum ScatteringOrders::irradianceAt(float texel) const {
    const int i = std::clamp(static_cast<int>(texel), 0, sunTexels - 2);
    const double x = static_cast<double>(texel) - i;
    const auto at = static_cast<std::size_t>(i);
    return (1.0 - x) * before_[at] + x * before_[at + 1];
}

Spectrum ScatteringOrders::radiance(const Ray& ray, const std::vector<Incident>& incident) const {
    vec4 sum(0.0F);
    for (const Step& step : ray.step) {
        const ByDegree light = lookUp(incident, step.cell, step.basis);
        sum += step.molecules * (light.degree0 + 0.1F * light.degree2) +
               step.aerosol * (light.degree0 + moments_.x * light.degree1 + moments_.y * light.degree2);
    }
    return Spectrum(sum) + Spectrum(ray.ground) * irradianceAt(ray.sun);
}

void ScatteringOrders::nextOrder(int texel, const std::vector<Incident>& incident) {
    for (int direction = 0; direction < directions; ++direction) {
        double solidAngle = 0.0;
        const AirPoint from = start(texel, direction, solidAngle);
        const Ray& ray = rays_[static_cast<std::size_t>(texel) * directions + static_cast<std::size_t>(direction)];
        add(texel, from, solidAngle, radiance(ray, incident));
    }
}

void ScatteringOrders::run(MultipleScattering& result) {
    std::vector<Coefficients> all(texels, Coefficients{});
    std::vector<Incident> incident(texels);
    Spectrum first(0.0);
    for (result.orders_ = 1;; ++result.orders_) {
        Spectrum order(0.0), sum(0.0);
        for (std::size_t i = 0; i < texels; ++i) {
            for (std::size_t k = 0; k < 6; ++k) all[i][k] += coefficients_[i][k];
            incident[i] = incidentOf(coefficients_[i]);
            order += coefficients_[i][0];
            sum += all[i][0];
        }
        for (std::size_t i = 0; i < sunTexels; ++i) result.irradiance_[i] += irradiance_[i];
        const Spectrum share = order / glm::max(sum, Spectrum(1e-30));
        if (std::max({share.x, share.y, share.z, share.w}) < 1e-3 || result.orders_ == mostOrders) break;
        before_ = irradiance_;
        irradiance_ = {};
        std::fill(coefficients_.begin(), coefficients_.end(), Coefficients{});
        tbb::parallel_for(0, texels, [&](int texel) { nextOrder(texel, incident); });
    }
    for (std::size_t i = 0; i < texels; ++i) incident[i] = incidentOf(all[i]);
    result.incident_ = std::move(incident);
}

MultipleScattering::MultipleScattering(const Air& air, const ColumnTable& columns, double discRadius)
    : irradiance_{}, aerosolMoments_(air.aerosolMoments()), molecules_(air.molecules), aerosol_(air.aerosolScattering) {
    ScatteringOrders(air, columns, discRadius).run(*this);
}

Spectrum MultipleScattering::source(const AirPoint& point, const AirDensity& density) const {
    const ByDegree light = lookUp(incident_, cellOf(point.height, point.sun), basisOf(point));
    const Spectrum degree0(light.degree0), first(light.degree1), second(light.degree2);
    const Spectrum scattered =
        density.molecules * molecules_ * (degree0 + 0.1 * second) +
        density.aerosol * aerosol_ * (degree0 + aerosolMoments_[1] * first + aerosolMoments_[2] * second);
    return glm::max(scattered, Spectrum(0.0)) * fade(point.sun);
}

Spectrum MultipleScattering::groundIrradiance(double sun) const {
    const Cell cell = cellOf(0.0, sun);
    const std::size_t i = cell.first % sunTexels;
    const double x = static_cast<double>(cell.sun);
    return ((1.0 - x) * irradiance_[i] + x * irradiance_[i + 1]) * fade(sun);
}

}  // namespace lumulus::sky
