#include "sky/row_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sky/scattering_table.h"
#include "sky/shell.h"

namespace lumulus::sky {

namespace {

/// Between two nodes the sun's height above the horizon changes by this share of it at most, and its cosine by so much:
/// light is then linear to a few thousandths.
constexpr double largestShare = 0.05, largestStep = 0.005;
constexpr int mostIntervals = 24;

/// Intervals between cosines of the sun at a height, from `low` to `high`; 0 where it sets between them.
int intervalsOf(double height, double low, double high, double discRadius) {
    const double horizon = horizonCosine(height), rim = 1.5 * discRadius;
    const bool lit = low > horizon + rim, dark = high < horizon - rim;
    if (!lit && !dark) return 0;
    const double step = lit ? std::min(largestShare * (low - horizon), largestStep) : largestStep;
    const double needed = std::ceil((high - low) / step);
    return needed > mostIntervals ? 0 : std::max(1, static_cast<int>(needed));
}

}  // namespace

RowLight::RowLight(const Atmosphere& atmosphere, double height, double up, double sun, int steps)
    : RowLight(atmosphere, height, up, sun, distanceToGround(height, up), atmosphere.path(height, up, steps)) {}

RowLight::RowLight(const Atmosphere& atmosphere, double height, double up, double sun, double length, int steps)
    : RowLight(atmosphere, height, up, sun, std::numeric_limits<double>::infinity(),
               makeAirPath(atmosphere.air(), height, up, length, steps)) {}

RowLight::RowLight(const Atmosphere& atmosphere, double height, double up, double sun, double ground,
                   const AirPath& path)
    : atmosphere_(atmosphere),
      height_(height),
      up_(up),
      sun_(sun),
      ground_(ground),
      transmittance_(path.transmittance) {
    const double level = std::sqrt(std::max(0.0, 1.0 - up * up) * std::max(0.0, 1.0 - sun * sun));
    for (const AirStep& air : path.steps) {
        const double r = planetRadius + air.height;
        Step step{air, air.height, (planetRadius + height) * sun / r, air.distance / r};
        const double low = std::clamp(step.sun + step.perToSun * (up * sun - level), -1.0, 1.0);
        const double high = std::clamp(step.sun + step.perToSun * (up * sun + level), low, 1.0);
        addTexels(step, low, high);
        addNodes(step, low, high);
        steps_.push_back(step);
    }
}

void RowLight::addTexels(Step& step, double low, double high) {
    const MultipleScattering& multiple = atmosphere_.multipleScattering();
    constexpr int across = MultipleScattering::sunTexels;
    const TableCell first = tableCell(step.height, low), last = tableCell(step.height, high);
    step.firstTexel = static_cast<int>(first.first % across);
    step.texels = static_cast<std::uint32_t>(texels_.size());
    const HeightFactors byHeight = heightFactors(step.air.up);
    const glm::vec4 molecules(step.air.density.molecules * multiple.molecules());
    const glm::vec4 aerosol(step.air.density.aerosol * multiple.aerosol());
    ByOrder moments{};  // by degree, of all that scatters
    for (std::size_t l = 0; l < moments.size(); ++l) moments[l] = aerosol * multiple.aerosolMoments()[l];
    moments[0] += molecules;
    moments[2] += 0.1F * molecules;
    for (std::uint32_t i = first.first; i <= last.first + 1; ++i) {
        const MultipleScattering::Incident &lower = multiple.incident()[i], &upper = multiple.incident()[i + across];
        const float share = first.height;
        Texel& texel = texels_.emplace_back();
        texel.logMean = (1.0F - share) * lower.logMean + share * upper.logMean;
        std::size_t k = 0;
        for (std::size_t l = 0; l <= highestDegree; ++l)
            for (std::size_t m = 0; m <= l; ++m, ++k)
                texel.byOrder[m] +=
                    byHeight[k] * moments[l] * ((1.0F - share) * lower.shape[k] + share * upper.shape[k]);
    }
}

void RowLight::addNodes(Step& step, double low, double high) {
    step.intervals = intervalsOf(step.height, low, high, atmosphere_.discRadius());
    step.low = low;
    step.perNode = step.intervals / std::max(high - low, 1e-12);
    step.nodes = static_cast<std::uint32_t>(nodes_.size());
    for (int i = 0; step.intervals > 0 && i <= step.intervals; ++i)
        nodes_.push_back(nodeAt(step, low + (high - low) * i / step.intervals));
}

RowLight::ByOrder RowLight::sourceAt(const Step& step, double sun) const {
    const TableCell cell = tableCell(step.height, sun);
    const auto column = static_cast<int>(cell.first % MultipleScattering::sunTexels) - step.firstTexel;
    const Texel* const at = &texels_[step.texels + static_cast<std::uint32_t>(std::max(0, column))];
    const float x = cell.sun;
    const glm::vec4 mean = glm::exp((1.0F - x) * at[0].logMean + x * at[1].logMean) * static_cast<float>(sunFade(sun));
    ByOrder source;
    for (std::size_t m = 0; m < source.size(); ++m)
        source[m] = mean * ((1.0F - x) * at[0].byOrder[m] + x * at[1].byOrder[m]);
    return source;
}

RowLight::Node RowLight::nodeAt(const Step& step, double sun) const {
    return {glm::vec4(atmosphere_.sunTransmittance(step.height, sun) * step.air.weight), sourceAt(step, sun)};
}

RowLight::Node RowLight::between(const Step& step, double sun) const {
    const double place = std::clamp((sun - step.low) * step.perNode, 0.0, static_cast<double>(step.intervals));
    const int first = std::min(static_cast<int>(place), step.intervals - 1);
    const auto x = static_cast<float>(place - first);
    const Node* const at = &nodes_[step.nodes + static_cast<std::uint32_t>(first)];
    Node node{(1.0F - x) * at[0].sun + x * at[1].sun, {}};
    for (std::size_t m = 0; m < node.source.size(); ++m)
        node.source[m] = (1.0F - x) * at[0].source[m] + x * at[1].source[m];
    return node;
}

AirLight RowLight::sky(double toSun) const {
    const Air& air = atmosphere_.air();
    AirLight light;
    light.transmittance = transmittance_;
    const Spectrum molecules = moleculePhase(toSun) * air.molecules;
    for (const Step& step : steps_) {
        const double sun = std::clamp(step.sun + step.perToSun * toSun, -1.0, 1.0);
        const Node node = step.intervals > 0 ? between(step, sun) : nodeAt(step, sun);
        const auto across = static_cast<float>(acrossTowardsSun({step.height, step.air.up, sun, toSun}));
        const AzimuthFactors byAzimuth = azimuthFactors(static_cast<float>(step.air.up), across);
        glm::vec4 source(0.0F);
        for (std::size_t m = 0; m < node.source.size(); ++m) source += byAzimuth[m] * node.source[m];
        const Spectrum direct(node.sun);
        light.scattered += step.air.weight * Spectrum(glm::max(source, glm::vec4(0.0F))) +
                           step.air.density.molecules * molecules * direct;
        light.aerosol += step.air.density.aerosol * direct;
    }
    light.aerosol *= air.aerosolScattering;
    if (std::isfinite(ground_)) {
        const AirPoint from{height_, up_, sun_, toSun};
        light.scattered += transmittance_ * atmosphere_.groundRadiance(from.after(ground_).sun);
    }
    return light;
}

}  // namespace lumulus::sky
