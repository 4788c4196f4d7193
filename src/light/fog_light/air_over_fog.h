#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "light/fog_light/fog_light.h"
#include "sky/sky_view.h"

namespace lumulus::fog_light {

/// The sun or the moon as an atmosphere has it: the brighter of the two first, and the other one.
struct AirLights {
    scene::Sun direct;
    std::optional<scene::Sun> other{};

    bool operator==(const AirLights&) const = default;
};

/// An atmosphere and level fog in it, which ends at a height: the air above it, as the fog and the clouds see it, and
/// the air that is in the fog. Heights are y in metres. The planet is flat below the top, as the fog is. Seen from
/// above, fog and what is below it count as a Lambert ground that sends as much light up; what it changes in the sky
/// that it sends it in other directions is the factor between two plane-parallel worlds.
class AirOverFog {
  public:
    /// `albedo`: of the ground, RGB. `highest`: of the clouds. `check` as of FogLight.
    AirOverFog(const sky::Atmosphere& atmosphere, const AirLights& lights, const std::vector<FogLayer>& fog,
               const glm::dvec3& albedo, double highest, const Check& check = stopIfInterrupted);

    /// Whether it is that of these.
    bool isOf(const AirLights& lights, const std::vector<FogLayer>& fog, double highest) const;
    double top() const { return top_; }
    /// With fog for its ground.
    const sky::Atmosphere& atmosphere() const { return atmosphere_; }
    /// Share of the direct light above the air that comes to a height, without the fog.
    glm::dvec3 sunAt(double height) const;
    /// Molecules and aerosol between the ground and the top, in RGB: exact for thin layers in the light of the sun.
    std::vector<FogLayer> layers() const;
    /// What falls on the fog, and the ground.
    FogSetting setting() const;

    /// Tables of the sky above the fog as an eye sees it; one in the fog, as its top does.
    sky::SkyView skyFrom(const glm::dvec3& eye, const scene::Sun& sun) const;

    /// Light that the air above the fog sends to a height not below the top, and how much it lets through of what comes
    /// from the top. Looking up there is nothing behind it.
    struct Seen {
        glm::dvec3 radiance{0.0}, transmittance{0.0};
    };
    Seen above(double height, const glm::dvec3& direction) const;

  private:
    struct Eye {
        double height;
        std::vector<sky::SkyView> views;  ///< of each light
    };
    void addEyes(const std::vector<double>& heights, const Check& check);
    glm::dvec3 albedoAbove() const;
    void addPlanes(const Check& check);
    glm::dvec3 changeOfSky(double height, double up, double azimuth) const;
    std::vector<FogLayer> layersUpTo(double height) const;
    Seen seenFrom(const Eye& eye, const glm::dvec3& direction) const;

    sky::Atmosphere atmosphere_;
    AirLights lights_;
    std::vector<FogLayer> fog_;
    glm::dvec3 albedo_;
    double top_, highest_;
    glm::dvec3 albedoOfFog_{0.0};
    std::vector<Eye> eyes_;  ///< from the top up
    /// Of the direct light, in plane-parallel air: with the fog, and with the ground that counts for it.
    std::optional<FogLight> withFog_, withGround_;
};

/// Light of sun, sky and ground in level fog, and above it.
struct FogSurroundings {
    const FogLight& fog;
    const AirOverFog* air = nullptr;  ///< null: there is no air

    /// Share of the direct light above air and fog that comes to a height.
    glm::dvec3 sunShare(double height) const;
    /// All light that comes from a direction, without the sun's disc.
    glm::dvec3 radiance(double height, const glm::dvec3& direction) const;
};

}  // namespace lumulus::fog_light
