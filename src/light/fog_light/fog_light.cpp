#include "light/fog_light/fog_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/fog_light/fog_sources.h"
#include "light/fog_light/rows.h"
#include "shared/fog_light.h"

namespace lumulus::fog_light {

namespace {

using std::numbers::pi;

/// Modes of the azimuth. Light of higher ones is scattered so little that no more than a thousandth is missing.
constexpr int modeCount = 16;
constexpr auto rows = static_cast<std::size_t>(shared::FOG_ROWS),
               columns = static_cast<std::size_t>(shared::FOG_COLUMNS);

/// What is seen of one colour: modes by [level][row].
struct Solved {
    std::vector<Vector> modes;
    double irradianceBelow = 0.0;
};

void solveMode(const Stack& stack, const FogSetting& setting, const SkyLight& sky, int channel, int mode,
               Solved& solved) {
    const std::optional<double> albedo =
        setting.groundHeight ? std::optional(setting.groundAlbedo[channel]) : std::nullopt;
    const ModeTransport transport(stack, mode, albedo);
    const Beam beam{sunAbove(setting)[channel], sunSine(setting)};
    const Incoming incoming = incomingOf(setting, sky, mode, channel);
    const Vector moments = transport.solve(beam, incoming);
    if (mode == 0) solved.irradianceBelow = transport.irradianceBelow(transport.radiance(moments, beam, incoming));
    solved.modes[static_cast<std::size_t>(mode)] = seenAlongRows(stack, mode, moments);
}

/// Light of all modes together: of each colour by [level][row][column].
std::vector<Vector> seenByAzimuth(const std::vector<Solved>& solved) {
    std::vector<std::vector<double>> cosines;  // by column and mode
    for (const double azimuth : columnAzimuths()) {
        std::vector<double>& ofColumn = cosines.emplace_back();
        for (std::size_t mode = 0; mode < solved.front().modes.size(); ++mode)
            ofColumn.push_back(std::cos(static_cast<double>(mode) * azimuth));
    }
    std::vector<Vector> seen;
    for (const Solved& colour : solved) {
        Vector& light = seen.emplace_back(colour.modes.front().size() * columns);
        tbb::parallel_for(std::size_t{0}, colour.modes.front().size(), [&](std::size_t place) {
            for (std::size_t column = 0; column < columns; ++column) {
                double sum = 0.0;
                for (std::size_t mode = 0; mode < colour.modes.size(); ++mode)
                    sum += cosines[column][mode] * colour.modes[mode][place];
                light[place * columns + column] = std::max(sum, 0.0);
            }
        });
    }
    return seen;
}

double between(double a, double b, double share) {
    return a + share * (b - a);
}

}  // namespace

bool FogSetting::isSame(const FogSetting& other) const {
    return !skyAt && !other.skyAt && toSun == other.toSun && sun == other.sun && sky == other.sky &&
           groundHeight == other.groundHeight && groundAlbedo == other.groundAlbedo;
}

FogLight::FogLight(const std::vector<FogLayer>& layers, const FogSetting& setting, const Check& check)
    : layers_(layers), setting_(setting), levels_(levelsOf(layers, setting.groundHeight)) {
    std::vector<Stack> stacks;
    for (int channel = 0; channel < 3; ++channel) stacks.push_back(makeStack(layers_, levels_, channel));
    const bool turned = setting.skyAt || sunAbove(setting) != glm::dvec3(0.0);
    const int modes = turned ? modeCount : 1;
    const SkyLight sky = skyLight(setting_);
    std::vector<Solved> solved(3, Solved{std::vector<Vector>(static_cast<std::size_t>(modes)), 0.0});
    tbb::parallel_for(0, 3 * modes, [&](int task) {
        check();
        const int channel = task % 3;
        const auto c = static_cast<std::size_t>(channel);
        solveMode(stacks[c], setting_, sky, channel, task / 3, solved[c]);
    });
    for (int channel = 0; channel < 3; ++channel)
        irradianceBelow_[channel] = solved[static_cast<std::size_t>(channel)].irradianceBelow;
    for (std::size_t k = 0; k < levels_.size(); ++k)
        above_.emplace_back(stacks[0].above[k], stacks[1].above[k], stacks[2].above[k]);
    const std::vector<Vector> byColour = seenByAzimuth(solved);
    for (std::size_t i = 0; i < byColour.front().size(); ++i)
        scattered_.emplace_back(byColour[0][i], byColour[1][i], byColour[2][i]);
    once_.assign(layers_.size(), std::vector<glm::vec3>(levels_.size() * 2 * rows));
    for (std::size_t n = 0; n < layers_.size(); ++n)
        for (int c = 0; c < 3; ++c) {
            const Stack& stack = stacks[static_cast<std::size_t>(c)];
            const Vector seen = onceAlongRows(stack, stack.scattered[n], sunSine(setting));
            for (std::size_t i = 0; i < seen.size(); ++i) once_[n][i][c] = static_cast<float>(seen[i]);
        }
    addAir();
}

/// Air scatters so evenly that a table by direction has what it scatters once, too.
void FogLight::addAir() {
    const Vector cosines = rowCosines(), azimuths = columnAzimuths();
    const double sun = sunSine(setting_), across = std::sqrt(1.0 - sun * sun);
    while (!once_.empty() && layers_[once_.size() - 1].scatterer != Scatterer::droplets) {
        const FogLayer& layer = layers_[once_.size() - 1];
        tbb::parallel_for(std::size_t{0}, levels_.size() * 2 * rows, [&](std::size_t place) {
            const std::size_t row = place % (2 * rows);
            const double up = row < rows ? cosines[row] : -cosines[row - rows], level = std::sqrt(1.0 - up * up);
            const glm::dvec3 light = sunAbove(setting_) * glm::dvec3(once_.back()[place]);
            for (std::size_t column = 0; column < columns; ++column)
                scattered_[place * columns + column] +=
                    glm::vec3(layer.phase(up * sun + level * across * std::cos(azimuths[column])) * light);
        });
        once_.pop_back();
    }
}

FogLight::Place FogLight::placeOf(double height) const {
    const double within = std::clamp(height, bottom(), top());
    const auto next = std::upper_bound(levels_.begin() + 1, levels_.end() - 1, within);
    const auto level = static_cast<std::size_t>(next - levels_.begin()) - 1;
    return {level, (within - levels_[level]) / (levels_[level + 1] - levels_[level])};
}

glm::dvec3 FogLight::sunTransmittance(double height) const {
    if (!(setting_.toSun.y > 0.0)) return glm::dvec3(0.0);
    return transmittance(height, sunSine(setting_));
}

double FogLight::depthAbove(int channel, double height) const {
    double depth = 0.0;
    for (const FogLayer& layer : layers_)
        depth += (layer.scattering[channel] * (1.0 - layer.truncated()) + layer.absorption[channel]) *
                 layer.column(std::max(height, bottom()), top());
    return depth;
}

glm::dvec3 FogLight::transmittance(double height, double up) const {
    glm::dvec3 depth;
    for (int c = 0; c < 3; ++c) {
        const double above = depthAbove(c, height);
        depth[c] = up >= 0.0 ? above : above_.front()[c] - above;
    }
    return glm::exp(-depth / std::max(std::abs(up), 1e-7));
}

glm::dvec3 FogLight::similarDepthBelow(double height) const {
    glm::dvec3 depth(0.0);
    for (const FogLayer& layer : layers_)
        depth += (layer.scattering * (1.0 - layer.g) + layer.absorption) * layer.column(bottom(), height);
    return depth;
}

glm::dvec3 FogLight::scatteredLight(double height, const glm::dvec3& direction) const {
    const Place place = placeOf(height);
    const double row = std::min(static_cast<double>(shared::fogRow(static_cast<float>(direction.y))), rows - 1.0);
    const auto firstRow = std::min(static_cast<std::size_t>(row), rows - 2);
    const glm::dvec2 a(direction.x, direction.z), b(setting_.toSun.x, setting_.toSun.z);
    const double lengths = glm::length(a) * glm::length(b);
    const double column =
        static_cast<double>(shared::fogColumn(lengths > 1e-12 ? static_cast<float>(glm::dot(a, b) / lengths) : 1.0F));
    const auto firstColumn = std::min(static_cast<std::size_t>(column), columns - 2);
    const std::size_t side = direction.y >= 0.0 ? 0 : rows;
    const double cosine = glm::dot(direction, setting_.toSun);
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t r = 0; r < 2; ++r) {
            const std::size_t at = (place.level + k) * 2 * rows + side + firstRow + r;
            const double share = between(1.0 - place.share, place.share, static_cast<double>(k)) *
                                 between(1.0 - row + static_cast<double>(firstRow), row - static_cast<double>(firstRow),
                                         static_cast<double>(r));
            const double across = column - static_cast<double>(firstColumn);
            sum += share * glm::mix(glm::dvec3(scattered_[at * columns + firstColumn]),
                                    glm::dvec3(scattered_[at * columns + firstColumn + 1]), across);
            for (std::size_t n = 0; n < once_.size(); ++n)
                sum +=
                    share * glm::dvec3(once_[n][at]) * sunAbove(setting_) *
                    static_cast<double>(shared::fogPhase(static_cast<float>(layers_[n].g), static_cast<float>(cosine)));
        }
    return sum * (1.0 - transmittance(height, direction.y));
}

glm::dvec3 FogLight::groundRadiance() const {
    const glm::dvec3 beam = sunAbove(setting_) * std::max(0.0, setting_.toSun.y) * sunTransmittance(bottom());
    return setting_.groundAlbedo / pi * (beam + irradianceBelow_);
}

glm::dvec3 FogLight::skyTowards(const glm::dvec3& direction) const {
    if (!setting_.skyAt) return setting_.sky;
    const glm::dvec2 a(direction.x, direction.z), b(setting_.toSun.x, setting_.toSun.z);
    const double lengths = glm::length(a) * glm::length(b);
    const double cosine = lengths > 1e-12 ? std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0) : 1.0;
    return setting_.skyAt(direction.y, std::acos(cosine));
}

glm::dvec3 FogLight::radiance(double height, const glm::dvec3& direction) const {
    const glm::dvec3 behind = setting_.groundHeight && direction.y < 0.0 ? groundRadiance() : skyTowards(direction);
    return scatteredLight(height, direction) + transmittance(height, direction.y) * behind;
}

}  // namespace lumulus::fog_light
