#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "support/field.h"

namespace lumulus::test {

/// Lengths in metres, each times the density along it, of rays that cover the projection of the cloud's box evenly,
/// with their shares of it: quadrature for what parallel light meets.
struct SunRays {
    std::vector<double> lengths, weights;

    double meanTransmittance(double extinction) const {
        double sum = 0.0, total = 0.0;
        for (std::size_t i = 0; i < lengths.size(); ++i) {
            sum += weights[i] * std::exp(-extinction * lengths[i]);
            total += weights[i];
        }
        return sum / total;
    }
};

/// `travel` is the direction of the light in the world, `grid` the number of rays along an edge of each lit face.
inline SunRays sunRays(const Field& field, const glm::dmat3& voxelEdges, const glm::dvec3& travel, int grid) {
    SunRays rays;
    const glm::dvec3 step = glm::inverse(voxelEdges) * glm::normalize(travel);
    const glm::dvec3 size(field.size());
    for (int axis = 0; axis < 3; ++axis) {
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        const glm::dvec3 area = glm::cross(voxelEdges[b] * size[b], voxelEdges[c] * size[c]);
        const double projected = std::abs(glm::dot(area, glm::normalize(travel)));
        if (projected < 1e-9) continue;
        for (int i = 0; i < grid * grid; ++i) {
            glm::dvec3 point(0.0);
            point[axis] = step[axis] > 0.0 ? 0.0 : size[axis];
            point[b] = size[b] * (i % grid + 0.5) / grid;
            point[c] = size[c] * (i / grid + 0.5) / grid;
            rays.lengths.push_back(field.along(point, step, 8));
            rays.weights.push_back(projected);
        }
    }
    return rays;
}

}  // namespace lumulus::test
