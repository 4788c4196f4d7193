#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <span>

namespace lumulus::photon {

/// The nearest of a set of points, found exactly by a kD-tree. May be asked by several threads at once.
class NearestPoints {
  public:
    static constexpr int most = 8;

    struct Found {
        int count = 0;  ///< most, or as many as there are
        std::array<std::size_t, most> numbers{};
        std::array<double, most> squares{};  ///< of the distances, rising
    };

    /// At least one point.
    explicit NearestPoints(std::span<const glm::dvec3> points);
    NearestPoints(NearestPoints&&) noexcept;
    ~NearestPoints();

    Found near(const glm::dvec3& place) const;

  private:
    struct Index;
    std::unique_ptr<Index> index_;
};

}  // namespace lumulus::photon
