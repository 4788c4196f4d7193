#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "light/fog_change/cut_phase.h"

namespace lumulus::fog_change {

constexpr int coefficientCount = bandCount * bandCount;

/// Light that passes through a cell, in power times metres over the volume of the cell.
struct Passing {
    int cell = 0;
    glm::vec3 direction{0.0F};  ///< of travel
    glm::vec3 light{0.0F};      ///< W/m²
    bool isBeam = false;        ///< whether it is the sun's beam, which at most peaks of the fog have scattered
    glm::vec3 straight{0.0F};   ///< of a beam, what not even peaks have scattered [W/m²]
};

/// Light that travels through a point.
struct Travelling {
    std::array<glm::vec3, bandCount> bands{};  ///< without the beam; weighed by harmonics of one direction, by band
    glm::vec3 beam{0.0F}, straight{0.0F};      ///< the beam, and what of it peaks have not scattered [W/m²]
};

/// Light by place and direction, with a sign, in squares of cells around a middle: each level is twice as wide as the
/// one before, and has cells twice as wide of the same heights.
class ChangeCells {
  public:
    static constexpr int levels = 4, across = 24;

    /// `halfWidth`: of the finest square [m]. `heights`: ends of the layers of cells, ascending.
    ChangeCells(const glm::dvec2& middle, double halfWidth, std::vector<double> heights);

    double halfWidth(int level) const;
    double edge(int level) const { return 2.0 * halfWidth(level) / across; }
    const glm::dvec2& middle() const { return middle_; }
    double bottom() const { return heights_.front(); }
    double top() const { return heights_.back(); }
    std::size_t bytes() const { return light_.size() * sizeof(float); }

    /// The cell of a level that holds a point within its square and its heights.
    int cellAt(int level, const glm::dvec3& point) const;
    double volume(int cell) const;
    /// Adds light, in its order in each cell.
    void add(std::span<const Passing> passing);
    /// Scales all light by `scale` and fills the middle of each level by the finer one: after the last add().
    void finish(double scale);

    Travelling at(const glm::dvec3& point, const std::array<float, coefficientCount>& harmonics) const;

  private:
    static constexpr std::size_t beamPlace = 3 * coefficientCount;
    using Sums = std::array<float, beamPlace + 6>;

    std::size_t layers() const { return heights_.size() - 1; }
    std::size_t layerOf(double height) const;
    float* valuesOf(int cell) { return light_.data() + static_cast<std::size_t>(cell) * Sums().size(); }
    int number(int level, const glm::ivec3& cell) const;
    void addLevel(Sums& sums, int level, const glm::dvec3& point, float weight) const;

    glm::dvec2 middle_;
    double halfWidth_;
    std::vector<double> heights_, middles_;
    std::vector<float> light_;  ///< [level][layer][z][x]: [coefficient][colour], beam, straight
};

/// Harmonics of a direction.
std::array<float, coefficientCount> harmonicsOf(const glm::vec3& direction);

}  // namespace lumulus::fog_change
