#include "light/fog_light/fog_layers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::fog_light {

namespace {

/// Intervals between levels, on the whole.
constexpr int intervals = 72;

double luminance(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// Vertical optical depth of all layers between two heights.
double depthBetween(const std::vector<FogLayer>& layers, double from, double to) {
    double sum = 0.0;
    for (const FogLayer& layer : layers) sum += luminance(layer.scattering + layer.absorption) * layer.column(from, to);
    return sum;
}

/// Ends a layer that has no end where it thins out: with an optical depth beyond it that nobody sees.
void endWhereThin(FogLayer& layer) {
    constexpr double invisible = 1e-6;
    const glm::dvec3 extinction = layer.scattering + layer.absorption;
    const double thickest = std::max(extinction.x, std::max(extinction.y, extinction.z));
    if (layer.falloff == 0.0) return;
    const double scale = 1.0 / std::abs(layer.falloff);
    const double away = scale * std::log(std::max(1.0, thickest * scale / invisible));
    if (layer.falloff > 0.0 && !std::isfinite(layer.top)) layer.top = std::max(layer.bottom, layer.offset) + away;
    if (layer.falloff < 0.0 && !std::isfinite(layer.bottom)) layer.bottom = std::min(layer.top, layer.offset) - away;
}

/// Adds `count` heights above `from`, up to `to`, at equal shares of height and of optical depth.
void divide(const std::vector<FogLayer>& layers, double from, double to, int count, std::vector<double>& levels) {
    const double depth = depthBetween(layers, from, to);
    const auto share = [&](double height) {
        const double ofHeight = (height - from) / (to - from);
        return depth > 0.0 ? 0.5 * (ofHeight + depthBetween(layers, from, height) / depth) : ofHeight;
    };
    for (int i = 1; i < count; ++i) {
        double low = levels.back(), high = to;
        for (int step = 0; step < 50; ++step) {
            const double middle = 0.5 * (low + high);
            (share(middle) < static_cast<double>(i) / count ? low : high) = middle;
        }
        levels.push_back(0.5 * (low + high));
    }
    levels.push_back(to);
}

}  // namespace

double FogLayer::density(double height) const {
    return height < bottom || height > top ? 0.0 : std::exp(-falloff * (height - offset));
}

double FogLayer::column(double from, double to) const {
    const double low = std::max(from, bottom), high = std::min(to, top);
    if (!(high > low)) return 0.0;
    const double exponent = falloff * (high - low);
    const double mean = std::abs(exponent) < 1e-9 ? 1.0 : -std::expm1(-exponent) / exponent;
    return (high - low) * std::exp(-falloff * (low - offset)) * mean;
}

double FogLayer::phase(double cosine) const {
    if (scatterer == Scatterer::molecules) return 3.0 / (16.0 * std::numbers::pi) * (1.0 + cosine * cosine);
    const double away = std::max(1.0 + g * g - 2.0 * g * cosine, 1e-6);
    const double spread = (1.0 - g * g) / (4.0 * std::numbers::pi * away * std::sqrt(away));
    return scatterer == Scatterer::droplets ? spread : spread * 1.5 * (1.0 + cosine * cosine) / (2.0 + g * g);
}

std::vector<double> FogLayer::moments(int count) const {
    std::vector<double> powers(static_cast<std::size_t>(count) + 2, 0.0);
    powers[0] = 1.0;
    for (std::size_t l = 1; l < powers.size(); ++l)
        powers[l] = powers[l - 1] * (scatterer == Scatterer::molecules ? 0.0 : g);
    std::vector<double> made(powers.begin(), powers.end() - 2);
    if (scatterer == Scatterer::droplets) return made;
    // those of the same times 1 + cos², by the recurrence of Legendre's polynomials
    const auto timesCosine = [](const std::vector<double>& of) {
        std::vector<double> moments(of.size(), 0.0);
        for (std::size_t l = 0; l + 1 < of.size(); ++l) {
            const auto n = static_cast<double>(l);
            moments[l] = ((n + 1.0) * of[l + 1] + (l > 0 ? n * of[l - 1] : 0.0)) / (2.0 * n + 1.0);
        }
        return moments;
    };
    const std::vector<double> squared = timesCosine(timesCosine(powers));
    const double whole = powers[0] + squared[0];
    for (std::size_t l = 0; l < made.size(); ++l) made[l] = (powers[l] + squared[l]) / whole;
    return made;
}

double FogLayer::truncated() const {
    return scatterer == Scatterer::droplets ? truncatedShare(g) : 0.0;
}

std::optional<std::vector<FogLayer>> layersOf(const scene::Fog& fog) {
    std::vector<FogLayer> layers;
    for (const scene::FogMedium& medium : fog.media) {
        const bool exponential = medium.kind == scene::MediumKind::exponential;
        if (!exponential && medium.kind != scene::MediumKind::homogeneous) return std::nullopt;
        const glm::dvec3& axis = medium.direction;
        if (exponential && (axis.x != 0.0 || axis.z != 0.0)) return std::nullopt;
        FogLayer layer;
        layer.scattering = medium.scattering;
        layer.absorption = medium.absorption;
        layer.emission = medium.emission;
        layer.g = medium.g;
        if (exponential) {
            layer.falloff = medium.falloff * axis.y;
            layer.offset = medium.offset.y;
        }
        layer.bottom = medium.bottom;
        layer.top = medium.top;
        endWhereThin(layer);
        if (!std::isfinite(layer.bottom) || !std::isfinite(layer.top)) return std::nullopt;
        layers.push_back(layer);
    }
    return layers;
}

std::vector<double> levelsOf(const std::vector<FogLayer>& layers, std::optional<double> ground) {
    std::vector<double> ends;
    for (const FogLayer& layer : layers)
        for (const double end : {layer.bottom, layer.top}) ends.push_back(ground ? std::max(*ground, end) : end);
    std::ranges::sort(ends);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    if (ends.size() < 2) return {};
    const double height = ends.back() - ends.front(), depth = depthBetween(layers, ends.front(), ends.back());
    std::vector<double> levels{ends.front()};
    for (std::size_t i = 1; i < ends.size(); ++i) {
        double share = (ends[i] - ends[i - 1]) / height;
        if (depth > 0.0) share = 0.5 * (share + depthBetween(layers, ends[i - 1], ends[i]) / depth);
        divide(layers, ends[i - 1], ends[i], std::max(1, static_cast<int>(std::lround(share * intervals))), levels);
    }
    return levels;
}

}  // namespace lumulus::fog_light
