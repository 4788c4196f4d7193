#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "base/interrupt.h"
#include "light/fog_light/fog_layers.h"

namespace lumulus::fog_light {

/// Light that falls on fog, and what is below it.
struct FogSetting {
    glm::dvec3 toSun{0.0, 1.0, 0.0};
    glm::dvec3 sun{0.0};  ///< irradiance across the sun's direction above all fog [W/m²]
    glm::dvec3 sky{0.0};  ///< radiance of a constant sky [W/(m² sr)], also from below where there is no ground
    /// Radiance of a sky that differs by direction, by the sine of elevation and by the azimuth from the sun's, and is
    /// the same to both sides of the sun. Empty: `sky`.
    std::function<glm::dvec3(double, double)> skyAt{};
    std::optional<double> groundHeight{};
    glm::dvec3 groundAlbedo{0.0};

    /// Whether light of both is the same, under constant skies.
    bool isSame(const FogSetting& other) const;
};

/// Light in level fog as if there were no cloud: of the sun, of the sky and of a ground, scattered any number of times.
/// Immutable. Directions are those that are looked at; heights are clamped to those of the fog.
class FogLight {
  public:
    /// Solves the transport. Needs layers with some height above the ground (levelsOf()). Layers of air follow those of
    /// droplets. `check` is asked between the steps, on any thread; what it throws ends them.
    FogLight(const std::vector<FogLayer>& layers, const FogSetting& setting, const Check& check = stopIfInterrupted);

    const std::vector<FogLayer>& layers() const { return layers_; }
    const FogSetting& setting() const { return setting_; }
    const std::vector<double>& levels() const { return levels_; }
    double bottom() const { return levels_.front(); }
    double top() const { return levels_.back(); }

    /// Light that fog has scattered last, but for that of the sun that droplets scattered once, over the share of light
    /// that the fog along the row lets not pass [W/(m² sr)]: [level][row][column] of shared/fog_light.h.
    const std::vector<glm::vec3>& scattered() const { return scattered_; }
    /// Of a layer of droplets: the sun's light that it scattered once, over that share, irradiance and phase function:
    /// [level][row].
    const std::vector<std::vector<glm::vec3>>& once() const { return once_; }
    /// Irradiance of a plane that faces up at the bottom, without the sun's beam [W/m²].
    const glm::dvec3& irradianceBelow() const { return irradianceBelow_; }
    /// Share of the sun's light that comes to a height without being scattered by more than the truncated peak.
    glm::dvec3 sunTransmittance(double height) const;
    /// The same of light from outside of the fog.
    glm::dvec3 transmittance(double height, double up) const;
    /// Vertical optical depth between the bottom and a height, of a medium that scatters evenly and changes as much of
    /// the light's direction: σa + (1 − g) σs.
    glm::dvec3 similarDepthBelow(double height) const;
    /// Light that fog has scattered last.
    glm::dvec3 scatteredLight(double height, const glm::dvec3& direction) const;
    /// All light that comes from a direction, without the sun's disc.
    glm::dvec3 radiance(double height, const glm::dvec3& direction) const;
    /// Radiance of the ground, in any direction.
    glm::dvec3 groundRadiance() const;

  private:
    void addAir();
    struct Place {
        std::size_t level;
        double share;  ///< of the next one
    };
    Place placeOf(double height) const;
    double depthAbove(int channel, double height) const;
    glm::dvec3 skyTowards(const glm::dvec3& direction) const;

    std::vector<FogLayer> layers_;
    FogSetting setting_;
    std::vector<double> levels_;
    std::vector<glm::vec3> scattered_;
    std::vector<std::vector<glm::vec3>> once_;
    std::vector<glm::dvec3> above_;  ///< optical depth above each level
    glm::dvec3 irradianceBelow_{0.0};
};

}  // namespace lumulus::fog_light
