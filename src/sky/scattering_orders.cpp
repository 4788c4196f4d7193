#include "sky/scattering_orders.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sky/scattering_table.h"
#include "sky/shell.h"
#include "sky/sun_reach.h"

namespace lumulus::sky {

using glm::vec4;
using std::numbers::pi;

namespace {

constexpr double smallOrder = 0.005;  // what follows an order of this share is taken for a geometric series

/// Gauss's rule in [0,1].
constexpr std::array<double, 6> nodes{0.033765242898423975, 0.16939530676686776, 0.3806904069584015,
                                      0.6193095930415985,   0.8306046932331322,  0.966234757101576};
constexpr std::array<double, 6> nodeWeights{0.08566224618958487, 0.18038078652406947, 0.23395696728634569,
                                            0.23395696728634569, 0.18038078652406947, 0.08566224618958487};

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

}  // namespace

ScatteringOrders::ScatteringOrders(const Air& air, const ColumnTable& columns, double discRadius)
    : air_(air),
      columns_(columns),
      discRadius_(discRadius),
      moments_(momentsOf(air)),
      paths_(at(heightTexels * polarAngles)),
      places_(at(heightTexels * polarAngles * steps * raysOfPath)),
      ends_(at(heightTexels * polarAngles * raysOfPath)),
      coefficients_(texels),
      irradiance_{},
      before_{} {
    tbb::parallel_for(0, heightTexels, [&](int height) { firstOrder(height); });
}

/// A ray that arrives at a texel: its beginning there. Above and below the horizon have a rule each.
AirPoint ScatteringOrders::start(int path, int ray) const {
    AirPoint p;
    p.height = heightOfTexel(path / polarAngles);
    p.sun = sunOfTexel(ray / azimuths);
    const double horizon = horizonCosine(p.height), node = nodes[at(path % polar)];
    const bool above = path % polarAngles < polar;
    p.up = above ? horizon + (1.0 - horizon) * node : horizon - (1.0 + horizon) * node;
    const double azimuth = pi * (ray % azimuths + 0.5) / azimuths;
    p.toSun = p.up * p.sun + std::sqrt((1.0 - p.up * p.up) * std::max(0.0, 1.0 - p.sun * p.sun)) * std::cos(azimuth);
    return p;
}

/// Share of the sphere that a ray of a path stands for.
double ScatteringOrders::solidAngle(int path) const {
    const double horizon = horizonCosine(heightOfTexel(path / polarAngles));
    const double width = path % polarAngles < polar ? 1.0 - horizon : 1.0 + horizon;
    return width * nodeWeights[at(path % polar)] * 2.0 * pi / azimuths;
}

/// Integral of aerosol's phase function by the directions of a texel: not 1, because they are too few for its peak.
double ScatteringOrders::aerosolSum(int height, int sun) const {
    double sum = 0.0;
    for (int path = height * polarAngles; path < (height + 1) * polarAngles; ++path)
        for (int ray = sun * azimuths; ray < (sun + 1) * azimuths; ++ray)
            sum += solidAngle(path) * air_.aerosolPhase(start(path, ray).toSun);
    return sum;
}

void ScatteringOrders::firstOrder(int height) {
    std::array<double, sunTexels> sums{};
    for (int sun = 0; sun < sunTexels; ++sun) sums[at(sun)] = aerosolSum(height, sun);
    for (int path = height * polarAngles; path < (height + 1) * polarAngles; ++path) {
        const AirPoint first = start(path, 0);
        paths_[at(path)] = makeAirPath(air_, first.height, first.up, distanceToGround(first.height, first.up), steps);
        for (int ray = 0; ray < raysOfPath; ++ray) {
            const AirPoint from = start(path, ray);
            add(path, ray, prepare(from, path, ray, air_.aerosolPhase(from.toSun) / sums[at(ray / azimuths)]));
        }
    }
}

/// Finds the places of a ray and the light that reaches its beginning after one scattering or reflection.
Spectrum ScatteringOrders::prepare(const AirPoint& from, int path, int ray, double aerosolPhase) {
    const auto placeOf = [](const AirPoint& p) -> Place {
        const TableCell cell = tableCell(p.height, p.sun);
        return {cell.first % sunTexels, cell.sun, static_cast<float>(acrossTowardsSun(p)),
                static_cast<float>(sunFade(p.sun))};
    };
    Spectrum light(0.0);
    const double moleculesPhase = moleculePhase(from.toSun);
    const AirPath& air = paths_[at(path)];
    for (int i = 0; i < steps; ++i) {
        const AirStep& step = air.steps[at(i)];
        const AirPoint p = pointOf(from, step);
        light += sunTransmittance(air_, columns_, p.height, p.sun, discRadius_) * step.weight *
                 (moleculesPhase * step.density.molecules * air_.molecules +
                  aerosolPhase * step.density.aerosol * air_.aerosolScattering);
        places_[at((path * steps + i) * raysOfPath + ray)] = placeOf(p);
    }
    const double ground = distanceToGround(from.height, from.up);
    if (std::isfinite(ground)) {
        const AirPoint p = from.after(ground);
        ends_[at(path * raysOfPath + ray)] = placeOf(p);
        light += air.transmittance * air_.groundAlbedo / pi * std::max(0.0, p.sun) *
                 sunTransmittance(air_, columns_, 0.0, p.sun, discRadius_);
    }
    return light;
}

void ScatteringOrders::add(int path, int ray, const Spectrum& radiance) {
    const AirPoint from = start(path, ray);
    const int height = path / polarAngles, sun = ray / azimuths;
    const HeightFactors byHeight = heightFactors(from.up);
    const AzimuthFactors byAzimuth =
        azimuthFactors(static_cast<float>(from.up), static_cast<float>(acrossTowardsSun(from)));
    const Spectrum light = radiance * solidAngle(path);
    Coefficients& sum = coefficients_[at(height * sunTexels + sun)];
    for (int l = 0; l <= highestDegree; ++l)
        for (int m = 0; m <= l; ++m)
            sum[at(harmonicAt(l, m))] += light * static_cast<double>(byHeight[at(harmonicAt(l, m))] * byAzimuth[at(m)]);
    if (height == 0 && from.up > 0.0) irradiance_[at(sun)] += light * from.up;
}

std::array<ScatteringOrders::Scattered, ScatteringOrders::sunTexels> ScatteringOrders::scattered(
    const AirStep& step, const std::vector<Incident>& incident) const {
    const vec4 molecules(step.density.molecules * air_.molecules * step.weight);
    const vec4 aerosol(step.density.aerosol * air_.aerosolScattering * step.weight);
    const HeightFactors factors = heightFactors(step.up);
    std::array<vec4, harmonicCount> weights;
    for (int l = 0; l <= highestDegree; ++l) {
        const float ofMolecules = l == 0 ? 1.0F : l == 2 ? 0.1F : 0.0F;
        const vec4 weight = ofMolecules * molecules + moments_[at(l)] * aerosol;
        for (int m = 0; m <= l; ++m) weights[at(harmonicAt(l, m))] = weight * factors[at(harmonicAt(l, m))];
    }
    const TableCell cell = tableCell(step.height, 1.0);
    const Incident* const row = &incident[cell.first / sunTexels * sunTexels];
    std::array<Scattered, sunTexels> result;
    for (std::size_t sun = 0; sun < sunTexels; ++sun) {
        const Incident &below = row[sun], &above = row[sun + sunTexels];
        result[sun].logMean = glm::mix(below.logMean, above.logMean, cell.height);
        result[sun].byOrder = {};
        for (int l = 0; l <= highestDegree; ++l)
            for (int m = 0; m <= l; ++m) {
                const std::size_t k = at(harmonicAt(l, m));
                result[sun].byOrder[at(m)] += weights[k] * glm::mix(below.shape[k], above.shape[k], cell.height);
            }
    }
    return result;
}

/// What a ray sees of the order before that the ground reflects.
Spectrum ScatteringOrders::fromGround(int path, int ray) const {
    const Place& end = ends_[at(path * raysOfPath + ray)];
    const auto x = static_cast<double>(end.fraction);
    return paths_[at(path)].transmittance * air_.groundAlbedo / pi * static_cast<double>(end.lit) *
           ((1.0 - x) * before_[end.sun] + x * before_[end.sun + 1]);
}

void ScatteringOrders::nextOrder(int height, const std::vector<Incident>& incident) {
    for (int path = height * polarAngles; path < (height + 1) * polarAngles; ++path) {
        std::array<vec4, raysOfPath> radiance{};
        for (int i = 0; i < steps; ++i) {
            const AirStep& step = paths_[at(path)].steps[at(i)];
            const auto bySun = scattered(step, incident);
            const Place* const places = &places_[at((path * steps + i) * raysOfPath)];
            for (std::size_t ray = 0; ray < raysOfPath; ++ray) {
                const Place& place = places[ray];
                const Scattered &one = bySun[place.sun], &other = bySun[place.sun + 1];
                const AzimuthFactors factors = azimuthFactors(static_cast<float>(step.up), place.across);
                vec4 sum(0.0F);
                for (std::size_t m = 0; m <= highestDegree; ++m)
                    sum += factors[m] * glm::mix(one.byOrder[m], other.byOrder[m], place.fraction);
                radiance[ray] += place.lit * sum * glm::exp(glm::mix(one.logMean, other.logMean, place.fraction));
            }
        }
        // the few harmonics swing below 0 where it is dark, which light does not
        for (int ray = 0; ray < raysOfPath; ++ray)
            add(path, ray, glm::max(Spectrum(radiance[at(ray)]) + fromGround(path, ray), Spectrum(0.0)));
    }
}

void ScatteringOrders::run(MultipleScattering& result) {
    std::vector<Coefficients> all(texels, Coefficients{});
    std::vector<Incident> incident(texels);
    Spectrum before(0.0), tail(0.0);
    for (result.orders_ = 1;; ++result.orders_) {
        Spectrum order(0.0), sum(0.0);
        for (std::size_t i = 0; i < texels; ++i) {
            for (std::size_t k = 0; k < harmonicCount; ++k) all[i][k] += coefficients_[i][k];
            incident[i] = incidentOf(coefficients_[i]);
            order += coefficients_[i][0];
            sum += all[i][0];
        }
        for (std::size_t i = 0; i < sunTexels; ++i) result.irradiance_[i] += irradiance_[i];
        const Spectrum share = order / glm::max(sum, Spectrum(1e-30));
        if (std::max({share.x, share.y, share.z, share.w}) < smallOrder || result.orders_ == mostOrders) {
            // the orders that follow, each of which has about this share of the one before
            tail = order / glm::max(before - order, Spectrum(1e-30));
            break;
        }
        before = order;
        before_ = irradiance_;
        irradiance_ = {};
        std::fill(coefficients_.begin(), coefficients_.end(), Coefficients{});
        tbb::parallel_for(0, heightTexels, [&](int height) { nextOrder(height, incident); });
    }
    for (std::size_t i = 0; i < sunTexels; ++i) result.irradiance_[i] += tail * irradiance_[i];
    for (std::size_t i = 0; i < texels; ++i) {
        for (std::size_t k = 0; k < harmonicCount; ++k) all[i][k] += tail * coefficients_[i][k];
        incident[i] = incidentOf(all[i]);
    }
    result.incident_ = std::move(incident);
}

}  // namespace lumulus::sky
