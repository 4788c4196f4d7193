#include "light/fog_change/fog_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/lit_fog.h"

namespace lumulus::fog_change {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// The part of a way that lies in a layer: distances x to y.
glm::dvec2 partIn(const fog_light::FogLayer& layer, double height, double rise, double length) {
    if (std::abs(rise) < 1e-9)
        return height > layer.bottom && height < layer.top ? glm::dvec2(0.0, length) : glm::dvec2(0.0);
    const double a = (layer.bottom - height) / rise, b = (layer.top - height) / rise;
    return {std::clamp(std::min(a, b), 0.0, length), std::clamp(std::max(a, b), 0.0, length)};
}

WalkedLayer walkedOf(const fog_light::FogLayer& layer) {
    WalkedLayer walked{
        layer, CutPhase([&](double cosine) { return layer.phase(cosine); }, static_cast<double>(shared::FOG_CUT))};
    walked.scattering = (1.0 - walked.phase.peak()) * layer.scattering;
    walked.extinction = walked.scattering + layer.absorption;
    walked.peak = walked.phase.peak() * layer.scattering;
    walked.walked = (walked.extinction.x + walked.extinction.y + walked.extinction.z) / 3.0;
    return walked;
}

}  // namespace

double densityOnWay(const fog_light::FogLayer& layer, double height, double rise, double length) {
    const glm::dvec2 part = partIn(layer, height, rise, length);
    const double metres = part.y - part.x;
    if (!(metres > 0.0)) return 0.0;
    if (layer.falloff == 0.0) return metres;
    const double begin = std::exp(-layer.falloff * (height + part.x * rise - layer.offset));
    const double exponent = layer.falloff * rise * metres;
    return begin * metres * (std::abs(exponent) < 1e-6 ? 1.0 - 0.5 * exponent : -std::expm1(-exponent) / exponent);
}

FogPaths::FogPaths(const std::vector<fog_light::FogLayer>& layers) {
    for (const fog_light::FogLayer& layer : layers) {
        layers_.push_back(walkedOf(layer));
        const glm::dvec3 &s = layer.scattering, &a = layer.absorption;
        if (s != glm::dvec3(s.x) || a != glm::dvec3(a.x)) grey_ = false;
    }
}

glm::dvec3 FogPaths::depth(double height, double rise, double length) const {
    glm::dvec3 sum(0.0);
    for (const WalkedLayer& walked : layers_)
        sum += walked.extinction * densityOnWay(walked.layer, height, rise, length);
    return sum;
}

glm::dvec3 FogPaths::peakDepth(double height, double rise, double length) const {
    glm::dvec3 sum(0.0);
    for (const WalkedLayer& walked : layers_) sum += walked.peak * densityOnWay(walked.layer, height, rise, length);
    return sum;
}

glm::dvec3 FogPaths::excessDepth(double height, double rise, double length) const {
    glm::dvec3 sum(0.0);
    for (const WalkedLayer& walked : layers_)
        sum += (walked.extinction - walked.walked) * densityOnWay(walked.layer, height, rise, length);
    return sum;
}

double FogPaths::distanceOf(const WalkedLayer& walked, double height, double rise, double depth) {
    const fog_light::FogLayer& layer = walked.layer;
    const glm::dvec2 part = partIn(layer, height, rise, 1e7);
    if (!(part.y > part.x) || !(walked.walked > 0.0)) return endless;
    double metres = depth / walked.walked;
    if (layer.falloff != 0.0) {
        metres /= std::exp(-layer.falloff * (height + part.x * rise - layer.offset));
        const double x = layer.falloff * rise * metres;
        if (x >= 1.0) return endless;
        if (std::abs(x) > 1e-6) metres *= -std::log1p(-x) / x;
    }
    return part.x + metres < part.y ? part.x + metres : endless;
}

}  // namespace lumulus::fog_change
