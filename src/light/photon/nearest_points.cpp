// The one file that includes FLANN, which takes 15 s to compile.
#include "light/photon/nearest_points.h"

#include <algorithm>
#include <flann/flann.hpp>
#include <vector>

namespace lumulus::photon {

struct NearestPoints::Index {
    explicit Index(std::span<const glm::dvec3> points) : origin(points.front()) {
        coordinates.reserve(3 * points.size());
        for (const glm::dvec3& point : points)
            for (int axis = 0; axis < 3; ++axis) coordinates.push_back(point[axis] - origin[axis]);
        tree.buildIndex(flann::Matrix<double>(coordinates.data(), points.size(), 3));
    }

    glm::dvec3 origin;  ///< distances far from that of the world keep their digits
    std::vector<double> coordinates;
    flann::Index<flann::L2<double>> tree{flann::KDTreeSingleIndexParams(12)};
};

NearestPoints::NearestPoints(std::span<const glm::dvec3> points) : index_(std::make_unique<Index>(points)) {}
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;
NearestPoints::~NearestPoints() = default;

NearestPoints::Found NearestPoints::near(const glm::dvec3& place) const {
    Found found;
    found.count = static_cast<int>(std::min<std::size_t>(most, index_->tree.size()));
    const auto count = static_cast<std::size_t>(found.count);
    glm::dvec3 query = place - index_->origin;
    const flann::Matrix<double> queries(&query.x, 1, 3);
    flann::Matrix<std::size_t> numbers(found.numbers.data(), 1, count);
    flann::Matrix<double> squares(found.squares.data(), 1, count);
    const flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED, 0.0F, true);
    index_->tree.knnSearch(queries, numbers, squares, count, exact);
    return found;
}

}  // namespace lumulus::photon
