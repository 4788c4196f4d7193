#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

/// What a procedural cloud covers, seen from above.
namespace lumulus {

class Footprint {
  public:
    /// Of the cloud of that kind, seed and resolution.
    Footprint(const std::string& kind, std::uint64_t seed, int resolution);

    /// Integral of the density over the column at a place of the cloud [m]; 0 outside.
    float column(const glm::dvec2& place) const;

    /// Area in m² where the column exceeds `threshold` metres.
    double area(double threshold) const;

    /// Height of the highest voxel with density above the base [m].
    double top() const { return top_; }

    /// Metres from the origin to the farthest corner of the box.
    double reach() const { return glm::length(glm::max(glm::abs(low_), glm::abs(low_ + cell_ * glm::dvec2(size_)))); }

  private:
    glm::ivec2 size_{0};
    glm::dvec2 low_{0.0}, cell_{1.0};  ///< metres, along x and z
    std::vector<float> columns_;
    double top_ = 0.0;
};

/// Which part of a rectangle is covered, on a grid of points.
class CoverMap {
  public:
    /// `extent` in metres, its middle at the origin. Points are `spacing` metres apart or a little less.
    CoverMap(const glm::dvec2& extent, double spacing);

    /// Whether the grid's point at a place is covered. False outside.
    bool covered(const glm::dvec2& place) const;

    /// Covers what a cloud covers where its optical thickness exceeds the least that counts. `axis`: cosine and sine of
    /// the rotation from x towards z. `threshold` as for Footprint::area().
    void add(const Footprint& footprint, const glm::dvec2& middle, const glm::dvec2& axis, double scale,
             double threshold);

    double cover() const { return static_cast<double>(count_) / static_cast<double>(points_.size()); }

  private:
    glm::ivec2 size_{0};
    glm::dvec2 low_{0.0}, cell_{1.0};
    std::vector<bool> points_;
    std::size_t count_ = 0;
};

}  // namespace lumulus
