#include "lamp/clouds.h"

#include <utility>

namespace lumulus::lamp {

namespace {

query::Clouds placedOf(const std::vector<Cloud>& clouds) {
    std::vector<query::PlacedField> placed;
    for (const Cloud& cloud : clouds) placed.push_back(cloud.placed);
    return query::Clouds(std::move(placed));
}

}  // namespace

Clouds::Clouds(std::vector<Cloud> clouds) : clouds_(std::move(clouds)), all_(placedOf(clouds_)) {
    for (const Cloud& cloud : clouds_) metresToVoxel_.push_back(glm::inverse(cloud.placed.voxelToMetres));
    if (const auto extent = all_.extent()) {
        middle_ = 0.5 * (extent->lower + extent->upper);
        radius_ = 0.5 * glm::length(extent->upper - extent->lower);
    }
}

double Clouds::depthOf(std::size_t cloud, const Ray& ray, double begin, double end) const {
    const query::PlacedField& placed = clouds_[cloud].placed;
    return placed.extinction * placed.field->integral(lineIn(cloud, ray), begin, end);
}

void Clouds::addParts(const Ray& ray, double metres, std::vector<CloudPart>& parts) const {
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
        double begin = 0.0, end = metres;
        if (clouds_[i].placed.field->clip(lineIn(i, ray), begin, end)) parts.push_back({i, begin, end});
    }
}

}  // namespace lumulus::lamp
