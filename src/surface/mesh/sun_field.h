#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace lumulus::surface {

/// Irradiance by the sun on a plane that faces it [W/m²], at points of the world.
using SunIrradiance = std::function<std::vector<glm::dvec3>(std::span<const glm::dvec3>)>;

/// The sun's irradiance near meshes, known at the corners of cells as far as they are asked for, and linear between
/// them.
class SunField {
  public:
    /// `cell`: edge in metres, as fine as the light can change. `lowest`: height below which no corner lies.
    SunField(double cell, std::optional<double> lowest, SunIrradiance irradiance);

    /// Irradiance at each point. Errors: those of `irradiance`.
    std::vector<glm::dvec3> at(std::span<const glm::dvec3> points);

  private:
    struct Hash {
        std::size_t operator()(const glm::i64vec3& corner) const;
    };

    double cell_;
    std::optional<double> lowest_;
    SunIrradiance irradiance_;
    std::unordered_map<glm::i64vec3, glm::dvec3, Hash> known_;
};

}  // namespace lumulus::surface
