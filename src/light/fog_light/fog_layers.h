#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scene/fog.h"

namespace lumulus::fog_light {

/// What scatters in a layer: droplets by Henyey and Greenstein, molecules by Rayleigh, aerosol of the air by Cornette
/// and Shanks.
enum class Scatterer { droplets, molecules, aerosol };

/// A level layer of fog, or of the air in it, without end to the sides. Its coefficients hold where the relative
/// density is 1.
struct FogLayer {
    glm::dvec3 scattering{0.0}, absorption{0.0};  ///< 1/m, RGB
    glm::dvec3 emission{0.0};                     ///< W/(m³ sr)
    double g = 0.85;                              ///< mean cosine of scattering
    double falloff = 0.0;                         ///< density: exp(−falloff (y − offset)), 1/m; 0: 1 everywhere
    double offset = 0.0;                          ///< m
    double bottom = 0.0, top = 0.0;               ///< heights y between which it lies [m]
    Scatterer scatterer = Scatterer::droplets;

    double density(double height) const;
    /// ∫ density between two heights [m].
    double column(double from, double to) const;
    /// Phase function [1/sr].
    double phase(double cosine) const;
    /// Moments of the phase function from the degree 0 on.
    std::vector<double> moments(int count) const;
    /// Share of scattered light that changes its direction so little that transport takes it for not scattered.
    double truncated() const;
    bool operator==(const FogLayer&) const = default;
};

/// Share of light that a Henyey–Greenstein phase function scatters so little that transport takes it for not scattered.
double truncatedShare(double g);

/// The media of a scene as level layers; none where one of them is not level (a ball, a slanted exponential) or without
/// a bottom or a top.
std::optional<std::vector<FogLayer>> layersOf(const scene::Fog& fog);

/// Heights at which light is known, ascending: the ends of all layers, and between them by equal shares of height and
/// of optical depth. Nothing lies below `ground`. Empty where there is no layer above it.
std::vector<double> levelsOf(const std::vector<FogLayer>& layers, std::optional<double> ground);

}  // namespace lumulus::fog_light
