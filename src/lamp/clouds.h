#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "lamp/cloud_phase.h"
#include "query/clouds.h"
#include "view/camera.h"

namespace lumulus::lamp {

/// A cloud as lamps light it.
struct Cloud {
    query::PlacedField placed;
    glm::dvec3 albedo{1.0};
    CloudPhase phase;
};

/// Where a ray may meet a cloud, metres from its origin.
struct CloudPart {
    std::size_t cloud = 0;
    double begin = 0.0, end = 0.0;
};

/// Where light meets something in a cloud.
struct Meeting {
    std::size_t cloud = 0;
    double metres = 0.0;
};

/// The clouds of a scene, whose extinction is the same for all channels. Where they overlap, it adds up. Places are in
/// the world, metres.
class Clouds {
  public:
    explicit Clouds(std::vector<Cloud> clouds);

    bool empty() const { return clouds_.empty(); }
    const Cloud& operator[](std::size_t number) const { return clouds_[number]; }
    double finestVoxel() const { return all_.finestVoxel(); }

    /// Sphere around all of them.
    const glm::dvec3& middle() const { return middle_; }
    double radius() const { return radius_; }

    /// Optical depth of all from the ray's origin to `metres`.
    double depth(const Ray& ray, double metres) const { return all_.opticalDepth({ray.origin, ray.direction, metres}); }

    /// Optical depth of one cloud between two distances.
    double depthOf(std::size_t cloud, const Ray& ray, double begin, double end) const;

    /// The parts of a ray up to `metres` that lie in the clouds' volumes.
    void addParts(const Ray& ray, double metres, std::vector<CloudPart>& parts) const;

    /// The first event on a ray up to `metres`; `depths()` draws an optical depth for each cloud that the ray meets.
    template <typename Depths>
    std::optional<Meeting> meet(const Ray& ray, double metres, const Depths& depths) const {
        std::optional<Meeting> found;
        for (std::size_t i = 0; i < clouds_.size(); ++i) {
            const query::VoxelLine line = lineIn(i, ray);
            double begin = 0.0, end = found ? found->metres : metres;
            if (!clouds_[i].placed.field->clip(line, begin, end)) continue;
            const double at = clouds_[i].placed.field->reach(line, begin, end, depths() / clouds_[i].placed.extinction);
            if (at < end) found = Meeting{i, at};
        }
        return found;
    }

  private:
    query::VoxelLine lineIn(std::size_t cloud, const Ray& ray) const {
        return {metresToVoxel_[cloud] * (ray.origin - clouds_[cloud].placed.origin),
                metresToVoxel_[cloud] * ray.direction};
    }

    std::vector<Cloud> clouds_;
    std::vector<glm::dmat3> metresToVoxel_;
    query::Clouds all_;
    glm::dvec3 middle_{0.0};
    double radius_ = 0.0;
};

}  // namespace lumulus::lamp
