#include "bake/leaf_voxels.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "base/error.h"

namespace lumulus::bake {
namespace {

constexpr double mostInBox = 67108864.0;        // 256 MiB of numbers
constexpr std::size_t mostWithLight = 4194304;  // 0.9 GB of harmonics, and twice as much of grids

/// Pieces into which a leaf is divided along its axes: two a voxel at least.
glm::ivec3 piecesOf(const photon::LeafLight& leaf, double voxel) {
    glm::ivec3 pieces(1);
    for (int axis = 0; axis < 3; ++axis)
        pieces[axis] = std::max(1, static_cast<int>(std::ceil(2.0 * glm::length(leaf.edges[axis]) / voxel)));
    return pieces;
}

/// Calls `visit(place)` for the middle of each piece of a leaf; returns their number.
template <typename Visit>
int forPieces(const photon::LeafLight& leaf, double voxel, const Visit& visit) {
    const glm::ivec3 pieces = piecesOf(leaf, voxel);
    for (int x = 0; x < pieces.x; ++x)
        for (int y = 0; y < pieces.y; ++y)
            for (int z = 0; z < pieces.z; ++z) {
                const glm::dvec3 share = (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(pieces);
                visit(glm::ivec3(glm::round((leaf.corner + leaf.edges * share) / voxel)));
            }
    return pieces.x * pieces.y * pieces.z;
}

/// The step to one of the voxels around a voxel, 0 to 26, or to itself.
glm::ivec3 besides(int side) {
    return glm::ivec3(side / 9, side / 3 % 3, side % 3) - 1;
}

[[noreturn]] void refuse(double count, double voxel) {
    throw InputError(fmt::format("voxels of {:.4g} m would be {:.3g} million", voxel, 1e-6 * count), "--voxel",
                     "give larger ones");
}

class Spreader {
  public:
    Spreader(const VoxelBox& box, const Check& check) : check_(check) {
        result_.box = box;
        result_.number.assign(box.count(), -1);
    }

    VoxelHarmonics spread(std::span<const photon::LeafLight> leaves) {
        for (const photon::LeafLight& leaf : leaves) {
            check_();
            const glm::ivec3 pieces = piecesOf(leaf, result_.box.voxel);
            const double mass = leaf.mass / (static_cast<double>(pieces.x) * pieces.y * pieces.z);
            forPieces(leaf, result_.box.voxel, [&](const glm::ivec3& place) { add(place, leaf, mass); });
        }
        widen();
        smooth();
        return std::move(result_);
    }

  private:
    std::size_t numberOf(std::size_t index) {
        if (result_.number[index] < 0) {
            if (result_.coefficients.size() >= mostWithLight)
                refuse(static_cast<double>(result_.coefficients.size()) + 1.0, result_.box.voxel);
            result_.number[index] = static_cast<std::int32_t>(result_.coefficients.size());
            result_.coefficients.emplace_back();
        }
        return static_cast<std::size_t>(result_.number[index]);
    }

    void add(const glm::ivec3& place, const photon::LeafLight& leaf, double mass) {
        const std::size_t number = numberOf(result_.box.indexOf(place));
        masses_.resize(result_.coefficients.size());
        masses_[number] += mass;
        for (std::size_t i = 0; i < leaf.coefficients.size(); ++i)
            result_.coefficients[number][i] += mass * leaf.coefficients[i];
    }

    /// Whoever looks light up between voxels at the edge of a cloud meets voxels without density.
    void widen() {
        const std::size_t lit = result_.coefficients.size();
        for (std::size_t index = 0; index < result_.number.size(); ++index) {
            if (index % 65536 == 0) check_();
            const std::int32_t from = result_.number[index];
            if (from < 0 || static_cast<std::size_t>(from) >= lit) continue;
            const glm::ivec3 place = result_.box.placeOf(index);
            for (int side = 0; side < 27; ++side) numberOf(result_.box.indexOf(place + besides(side)));
        }
        masses_.resize(result_.coefficients.size());
    }

    /// Sums over masses, both of a voxel and those beside it: leaves at the rim of a cloud meet few photons.
    void smooth() {
        std::vector<std::array<glm::dvec3, 9>> sums(result_.coefficients.size());
        std::swap(sums, result_.coefficients);
        const int slabs = result_.box.size.x;
        for (int x = 0; x < slabs; ++x) {
            check_();
            const std::size_t inSlab = result_.box.count() / static_cast<std::size_t>(slabs);
            const std::size_t begin = static_cast<std::size_t>(x) * inSlab;
            tbb::parallel_for(begin, begin + inSlab, [&](std::size_t index) {
                if (result_.number[index] >= 0) smooth(index, sums);
            });
        }
    }

    void smooth(std::size_t index, const std::vector<std::array<glm::dvec3, 9>>& sums) {
        auto& result = result_.coefficients[static_cast<std::size_t>(result_.number[index])];
        const glm::ivec3 place = result_.box.placeOf(index);
        double mass = 0.0;
        for (int side = 0; side < 27; ++side) {
            const glm::ivec3 away = besides(side), at = place + away - result_.box.first;
            if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, result_.box.size)))
                continue;
            const std::int32_t from = result_.number[result_.box.indexOf(place + away)];
            if (from < 0) continue;
            const double weight = 1.0 / (1 << (std::abs(away.x) + std::abs(away.y) + std::abs(away.z)));
            mass += weight * masses_[static_cast<std::size_t>(from)];
            for (std::size_t i = 0; i < result.size(); ++i)
                result[i] += weight * sums[static_cast<std::size_t>(from)][i];
        }
        for (glm::dvec3& coefficient : result) coefficient /= mass;
    }

    const Check& check_;
    VoxelHarmonics result_;
    std::vector<double> masses_;  ///< of voxels, 0 of those without density
};

}  // namespace

glm::ivec3 VoxelBox::placeOf(std::size_t index) const {
    const auto ny = static_cast<std::size_t>(size.y), nz = static_cast<std::size_t>(size.z);
    return first + glm::ivec3(index / (ny * nz), index / nz % ny, index % nz);
}

VoxelBox boxOf(std::span<const photon::LeafLight> leaves, double voxel) {
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
    for (const photon::LeafLight& leaf : leaves)
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at = leaf.corner + leaf.edges * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
            lower = glm::min(lower, at);
            upper = glm::max(upper, at);
        }
    constexpr double mostCoordinate = 1e9;
    const glm::dvec3 first = glm::round(lower / voxel) - 1.0, last = glm::round(upper / voxel) + 1.0;
    const glm::dvec3 size = last - first + 1.0;
    const double count = size.x * size.y * size.z;
    if (!(count <= mostInBox)) refuse(count, voxel);
    if (glm::any(glm::greaterThan(glm::max(-first, last), glm::dvec3(mostCoordinate))))
        throw InputError(fmt::format("the clouds are too far from the origin for voxels of {:.4g} m", voxel), "--voxel",
                         "give larger ones");
    return {voxel, glm::ivec3(first), glm::ivec3(size)};
}

VoxelHarmonics spread(std::span<const photon::LeafLight> leaves, const VoxelBox& box, const Check& check) {
    return Spreader(box, check).spread(leaves);
}

}  // namespace lumulus::bake
