#include "volume/footprint.h"

#include <algorithm>
#include <cmath>

#include "vdb/procedural.h"

namespace lumulus {

Footprint::Footprint(const std::string& kind, std::uint64_t seed, int resolution) {
    const vdb::Volume cloud = vdb::makeCloud({kind, resolution, seed});
    const glm::dvec3 voxel(cloud.toWorld.linear[0][0], cloud.toWorld.linear[1][1], cloud.toWorld.linear[2][2]);
    size_ = {cloud.size.x, cloud.size.z};
    low_ = {cloud.toWorld.translation.x, cloud.toWorld.translation.z};
    cell_ = {voxel.x, voxel.z};
    for (int z = 0; z < cloud.size.z; ++z) {
        for (int x = 0; x < cloud.size.x; ++x) {
            double sum = 0.0;
            int top = 0;
            for (int y = 0; y < cloud.size.y; ++y) {
                const auto density = static_cast<double>(cloud.density[cloud.index(x, y, z)]);
                sum += density;
                if (density > 0.0) top = y + 1;
            }
            top_ = std::max(top_, cloud.toWorld.translation.y + top * voxel.y);
            columns_.push_back(static_cast<float>(sum * voxel.y));
        }
    }
}

float Footprint::column(const glm::dvec2& place) const {
    const glm::dvec2 at = (place - low_) / cell_;
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < size_.x && at.y < size_.y)) return 0.0F;
    return columns_[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(size_.x) +
                    static_cast<std::size_t>(at.x)];
}

double Footprint::area(double threshold) const {
    const auto above = std::ranges::count_if(columns_, [&](float c) { return static_cast<double>(c) > threshold; });
    return static_cast<double>(above) * cell_.x * cell_.y;
}

CoverMap::CoverMap(const glm::dvec2& extent, double spacing) : low_(-0.5 * extent) {
    size_ = glm::max(glm::ivec2(glm::ceil(extent / spacing)), glm::ivec2(1));
    cell_ = extent / glm::dvec2(size_);
    points_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
}

bool CoverMap::covered(const glm::dvec2& place) const {
    const glm::dvec2 at = (place - low_) / cell_;
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < size_.x && at.y < size_.y)) return false;
    return points_[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(at.x)];
}

void CoverMap::add(const Footprint& footprint, const glm::dvec2& middle, const glm::dvec2& axis, double scale,
                   double threshold) {
    const double reach = footprint.reach() * scale;
    const glm::ivec2 first = glm::max(glm::ivec2(glm::floor((middle - reach - low_) / cell_)), glm::ivec2(0));
    const glm::ivec2 last = glm::min(glm::ivec2(glm::ceil((middle + reach - low_) / cell_)), size_ - 1);
    for (int z = first.y; z <= last.y; ++z) {
        for (int x = first.x; x <= last.x; ++x) {
            const std::size_t point =
                static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
            if (points_[point]) continue;
            const glm::dvec2 d = (low_ + cell_ * (glm::dvec2(x, z) + 0.5) - middle) / scale;
            const glm::dvec2 place(axis.x * d.x + axis.y * d.y, axis.x * d.y - axis.y * d.x);
            if (static_cast<double>(footprint.column(place)) <= threshold) continue;
            points_[point] = true;
            ++count_;
        }
    }
}

}  // namespace lumulus
