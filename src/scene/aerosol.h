#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <vector>

namespace lumulus::scene {

/// −ln(0.02): optical depth at the visibility (Koschmieder 1924).
inline constexpr double koschmieder = 3.912;

/// Particles of one kind: what their extinction is made of, and its colour.
struct Aerosol {
    std::string_view name;
    double albedo;         ///< of single scattering
    double g;              ///< mean cosine of scattering
    double exponentBlue;   ///< Ångström's exponent from 350 to 500 nm
    double exponentGreen;  ///< the same from 500 to 800 nm
};

/// Hess, Koepke and Schult (1998), "Optical Properties of Aerosols and Clouds: The Software Package OPAC", table 4: at
/// 550 nm and 80 % relative humidity; `fog`: droplets of 10 µm effective radius by Mie's theory.
inline constexpr std::array<Aerosol, 8> aerosols{{
    {"continental-clean", 0.972, 0.709, 1.10, 1.42},
    {"continental", 0.925, 0.703, 1.11, 1.42},
    {"continental-polluted", 0.892, 0.698, 1.13, 1.45},
    {"urban", 0.817, 0.689, 1.14, 1.43},
    {"desert", 0.888, 0.729, 0.20, 0.17},
    {"maritime", 0.997, 0.772, 0.12, 0.08},
    {"maritime-polluted", 0.975, 0.756, 0.41, 0.35},
    {"fog", 1.0, 0.863, 0.0, 0.0},
}};

/// Names of all aerosols, in their order.
std::vector<std::string_view> aerosolNames();

/// Extinction in red, green and blue (640, 540 and 440 nm) over that at 550 nm.
glm::dvec3 relativeExtinction(const Aerosol& aerosol);

/// Visibility in metres in a medium of that extinction in red, green and blue, where the density is 1: that at 550 nm,
/// by Ångström's law between red and green. None without extinction.
std::optional<double> visibilityOf(const glm::dvec3& extinction);

}  // namespace lumulus::scene
