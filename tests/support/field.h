#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "vdb/quantise.h"
#include "vdb/volume.h"

namespace lumulus::test {

/// The normalised density as the GPU holds it, interpolated on the host in double: what its passes are held against.
/// Voxel coordinates; zero outside.
class Field {
  public:
    explicit Field(const vdb::Volume& volume) : size_(volume.size) {
        const vdb::QuantisedVolume quantised = vdb::quantise(volume);
        format_ = quantised.format;
        const std::size_t bytes = vdb::texelBytes(format_);
        for (std::size_t i = 0; i < volume.density.size(); ++i)
            texels_.push_back(decode(quantised.texels.data() + i * bytes));
    }

    const glm::ivec3& size() const { return size_; }
    vdb::DensityFormat format() const { return format_; }

    double texel(const glm::ivec3& voxel) const {
        for (int axis = 0; axis < 3; ++axis)
            if (voxel[axis] < 0 || voxel[axis] >= size_[axis]) return 0.0;
        return texels_[(static_cast<std::size_t>(voxel.z) * static_cast<std::size_t>(size_.y) +
                        static_cast<std::size_t>(voxel.y)) *
                           static_cast<std::size_t>(size_.x) +
                       static_cast<std::size_t>(voxel.x)];
    }

    double at(const glm::dvec3& point) const {
        const glm::dvec3 place = point - 0.5;
        const glm::dvec3 base = glm::floor(place);
        const glm::dvec3 part = place - base;
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 step(corner & 1, (corner >> 1) & 1, corner >> 2);
            double weight = 1.0;
            for (int axis = 0; axis < 3; ++axis) weight *= step[axis] == 1 ? part[axis] : 1.0 - part[axis];
            if (weight > 0.0) sum += weight * texel(glm::ivec3(base) + step);
        }
        return sum;
    }

    /// Integral over the voxel's cube: on each axis the hats of the three nearest voxels have areas ⅛, ¾ and ⅛ in it.
    double voxelMass(const glm::ivec3& voxel) const {
        constexpr double area[3] = {0.125, 0.75, 0.125};
        double sum = 0.0;
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x)
                    sum += area[x + 1] * area[y + 1] * area[z + 1] * texel(voxel + glm::ivec3(x, y, z));
        return sum;
    }

    /// Integral over the voxels [lower, upper).
    double mass(const glm::ivec3& lower, const glm::ivec3& upper) const {
        double sum = 0.0;
        for (int z = lower.z; z < upper.z; ++z)
            for (int y = lower.y; y < upper.y; ++y)
                for (int x = lower.x; x < upper.x; ++x) sum += voxelMass({x, y, z});
        return sum;
    }

    double sumOfTexels() const {
        double sum = 0.0;
        for (const double texel : texels_) sum += texel;
        return sum;
    }

    /// Integral along a ray from `point` in the direction `step` (voxels per unit) until it leaves the box, in units of
    /// the length of `step`; midpoints, `perVoxel` of them on the longest component of a voxel.
    double along(const glm::dvec3& point, const glm::dvec3& step, int perVoxel = 16) const {
        double length = 1e300;
        for (int axis = 0; axis < 3; ++axis)
            if (step[axis] != 0.0)
                length = std::min(length, ((step[axis] > 0.0 ? double(size_[axis]) : 0.0) - point[axis]) / step[axis]);
        const double fastest = std::max(std::abs(step.x), std::max(std::abs(step.y), std::abs(step.z)));
        const int count = std::max(1, static_cast<int>(length * fastest * perVoxel));
        double sum = 0.0;
        for (int i = 0; i < count; ++i) sum += at(point + step * (length * (i + 0.5) / count));
        return sum * std::max(length, 0.0) / count;
    }

  private:
    glm::ivec3 size_;
    vdb::DensityFormat format_ = vdb::DensityFormat::r8;
    std::vector<double> texels_;

    double decode(const std::byte* texel) const {
        if (format_ == vdb::DensityFormat::r8) return static_cast<double>(*texel) / 255.0;
        if (format_ == vdb::DensityFormat::r16f) {
            std::uint16_t bits = 0;
            std::memcpy(&bits, texel, sizeof(bits));
            return static_cast<double>(glm::unpackHalf1x16(bits));
        }
        float value = 0.0F;
        std::memcpy(&value, texel, sizeof(value));
        return static_cast<double>(value);
    }
};

}  // namespace lumulus::test
