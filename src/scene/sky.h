#pragma once

#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>

/// What lights the clouds: sun, moon, sky and ground of a scene.
namespace lumulus::scene {

/// The unit vector towards a point of the sky. Azimuth 0 looks along −Z and 90 along +X (north and east where −Z is
/// north); elevation is the angle above the horizon. Degrees.
inline glm::dvec3 skyDirection(double azimuth, double elevation) {
    const double a = glm::radians(azimuth), e = glm::radians(elevation);
    return {std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a)};
}

inline constexpr double defaultAzimuth = 70.0, defaultElevation = 35.0;  ///< of the sun, degrees

struct Sun {
    glm::dvec3 directionTo = skyDirection(defaultAzimuth, defaultElevation);  ///< unit vector towards the sun
    glm::dvec3 irradiance{5.0, 4.8, 4.4};                                     ///< on a plane that faces the sun, RGB
    double angularDiameter = 0.53;                                            ///< degrees
    bool refraction = false;     ///< whether the air lifts the disc (its place only)
    bool limbDarkening = false;  ///< whether the disc is darker towards its rim

    bool operator==(const Sun&) const = default;
};

enum class SkyModel { constant, atmosphere, map };

/// What surrounds the world. Which members count depends on the model.
struct Sky {
    SkyModel model = SkyModel::constant;
    glm::dvec3 radiance{0.12, 0.22, 0.42};  ///< constant over the sphere, RGB
    bool hillaire = false;                  ///< atmosphere: the medium of Hillaire (2020), in three wavelengths' stead
    double aerosolDepth = 0.084;            ///< atmosphere: vertical optical depth of the aerosol at 500 nm
    double angstrom = 1.14;                 ///< atmosphere: its Ångström exponent
    double ozone = 300.0;                   ///< atmosphere: column in Dobson units
    glm::dvec3 groundAlbedo{0.2};           ///< atmosphere: of the planet, where the scene has no `ground`
    bool groundBelowClouds = false;         ///< atmosphere: see groundedScene() in view/ground.h
    std::filesystem::path map;              ///< map: latitude-longitude EXR
    double mapScale = 1.0;                  ///< map: factor for its radiance
    double mapRotation = 0.0;               ///< map: degrees by which it is rotated, clockwise seen from above
    bool mapSun = true;                     ///< map: whether its sun is taken out and becomes the scene's

    bool operator==(const Sky&) const = default;
};

/// The moon as a second sun.
struct Moon {
    bool shines = false;
    glm::dvec3 directionTo = skyDirection(250.0, 30.0);  ///< unit vector towards the moon
    double phaseAngle = 0.0;                             ///< degrees: 0 is full, 180 new

    bool operator==(const Moon&) const = default;
};

/// When and where: the sun and the moon then stand where they stood.
struct Time {
    std::string utc;                         ///< "2026-06-21T10:00:00Z"
    double latitude = 0.0, longitude = 0.0;  ///< degrees, north and east positive

    bool operator==(const Time&) const = default;
};

/// The ground below the clouds: level at the height of the origin's foot; a sphere where the sky is an atmosphere.
struct Ground {
    glm::dvec3 albedo{0.2};  ///< share of the light that is reflected, equally in all directions (Lambert)
    double height = 0.0;     ///< y of the ground, metres
    glm::dvec2 foot{0.0};    ///< of a planet: x and z of the point above its centre, metres

    bool operator==(const Ground&) const = default;
};

}  // namespace lumulus::scene
