#include "reference/medium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lumulus::reference {
namespace {

constexpr glm::ivec3 brick(4, 2, 2);
constexpr std::size_t brickVoxels = 16;

/// Offsets of the coordinates −1…count of one axis: bricks before it, then voxels within it.
std::vector<std::size_t> offsetsOf(int count, int edge, std::size_t brickStride, std::size_t voxelStride) {
    std::vector<std::size_t> offsets;
    for (int padded = 0; padded < count + 2; ++padded) {
        offsets.push_back(static_cast<std::size_t>(padded / edge) * brickStride +
                          static_cast<std::size_t>(padded % edge) * voxelStride);
    }
    return offsets;
}

std::size_t bricksAlong(int count, int edge) {
    return static_cast<std::size_t>((count + 2 + edge - 1) / edge);
}

/// Mean position in [0, 1] of a first collision within a piece of optical depth τ, given that there is one.
double meanPosition(double tau) {
    if (tau < 1e-3) return 0.5 - tau / 12.0;
    return 1.0 / tau - 1.0 / std::expm1(tau);
}

/// Density on the ray, which rounding may have taken just out of the box.
double densityAt(const Medium& medium, const VoxelRay& ray, double metres) {
    return medium.density(glm::clamp(ray.at(metres), glm::dvec3(0.0), glm::dvec3(medium.size())));
}

/// Calls `visit` for the pieces of the ray between planes of voxel centres, nearest first, until it returns false.
template <typename Visit>
void eachPiece(const Medium& medium, const VoxelRay& ray, Visit&& visit) {
    const std::optional<Interval> inside = medium.clip(ray);
    if (!inside) return;
    glm::dvec3 next(std::numeric_limits<double>::infinity()), stride(next);
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.step[axis] == 0.0) continue;
        const double sign = std::copysign(1.0, ray.step[axis]);
        const double from = ray.at(inside->begin)[axis] - 0.5;
        const double plane = (sign > 0.0 ? std::floor(from) + 1.0 : std::ceil(from) - 1.0) + 0.5;
        next[axis] = (plane - ray.origin[axis]) / ray.step[axis];
        stride[axis] = 1.0 / std::abs(ray.step[axis]);
    }
    for (double t = inside->begin; t < inside->end;) {
        const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        const double end = std::clamp(next[axis], t, inside->end);
        next[axis] += stride[axis];
        if (!visit(Interval{t, end})) return;
        t = end;
    }
}

}  // namespace

DensityField::DensityField(const vdb::Volume& volume) : size_(volume.size) {
    const std::size_t bricksX = bricksAlong(size_.x, brick.x), bricksY = bricksAlong(size_.y, brick.y);
    offsetX_ = offsetsOf(size_.x, brick.x, brickVoxels, 1);
    offsetY_ = offsetsOf(size_.y, brick.y, brickVoxels * bricksX, 4);
    offsetZ_ = offsetsOf(size_.z, brick.z, brickVoxels * bricksX * bricksY, 8);
    voxels_.assign(brickVoxels * bricksX * bricksY * bricksAlong(size_.z, brick.z), 0.0F);
    for (int z = 0; z < size_.z; ++z) {
        for (int y = 0; y < size_.y; ++y) {
            for (int x = 0; x < size_.x; ++x) {
                const float value = volume.density[volume.index(x, y, z)];
                voxels_[indexOf(x, y, z)] = value;
                maximumDensity_ = std::max(maximumDensity_, static_cast<double>(value));
            }
        }
    }
}

std::size_t DensityField::indexOf(int x, int y, int z) const {
    return offsetX_[static_cast<std::size_t>(x + 1)] + offsetY_[static_cast<std::size_t>(y + 1)] +
           offsetZ_[static_cast<std::size_t>(z + 1)];
}

double DensityField::maximumWithin(const glm::ivec3& low, const glm::ivec3& high) const {
    // a point between two voxel centres takes from both: the box reaches half a voxel further
    const glm::ivec3 first = glm::max(low - 1, glm::ivec3(0));
    const glm::ivec3 last = glm::min(high, size_ - 1);
    float result = 0.0F;
    for (int z = first.z; z <= last.z; ++z) {
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) result = std::max(result, voxels_[indexOf(x, y, z)]);
        }
    }
    return result;
}

Medium::Medium(std::shared_ptr<const DensityField> field, const vdb::Affine& toWorld, double extinction)
    : field_(std::move(field)),
      extinction_(extinction),
      toWorld_(toWorld.linear),
      toVoxel_(glm::inverse(toWorld.linear)),
      translation_(toWorld.translation) {}

Box Medium::box() const {
    Box box;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 share(corner & 1, corner >> 1 & 1, corner >> 2);
        box.include(translation_ + toWorld_ * (share * glm::dvec3(size())));
    }
    return box;
}

std::optional<Interval> Medium::clip(const VoxelRay& ray) const {
    const glm::ivec3& size = field_->size();
    Interval interval{0.0, std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.step[axis] == 0.0) {
            if (ray.origin[axis] < 0.0 || ray.origin[axis] > size[axis]) return std::nullopt;
            continue;
        }
        const double a = (0.0 - ray.origin[axis]) / ray.step[axis];
        const double b = (size[axis] - ray.origin[axis]) / ray.step[axis];
        interval.begin = std::max(interval.begin, std::min(a, b));
        interval.end = std::min(interval.end, std::max(a, b));
    }
    if (!(interval.begin < interval.end)) return std::nullopt;
    return interval;
}

std::vector<OpticalPiece> opticalPieces(const Medium& medium, const VoxelRay& ray, double limit) {
    std::vector<OpticalPiece> pieces;
    double passed = 1.0;
    constexpr double gauss = 0.28867513459481287;  // 1/(2√3)
    eachPiece(medium, ray, [&](const Interval& whole) {
        const Interval piece{whole.begin, std::min(whole.end, limit)};
        if (!(piece.begin < limit)) return false;
        const double length = piece.end - piece.begin, middle = 0.5 * (piece.begin + piece.end);
        const double depth =
            0.5 * length * medium.extinctionScale() *
            (densityAt(medium, ray, middle - gauss * length) + densityAt(medium, ray, middle + gauss * length));
        if (depth > 0.0) {
            pieces.push_back({piece, depth});
            passed *= std::exp(-depth);
        }
        return passed > 0.0;
    });
    return pieces;
}

LineIntegrals integrateAlong(std::span<const std::vector<OpticalPiece>> media) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    LineIntegrals result;
    std::vector<std::size_t> current(media.size(), 0);  // the piece that each medium has come to
    const auto pieceOf = [&](std::size_t m) { return current[m] < media[m].size() ? &media[m][current[m]] : nullptr; };
    for (double begin = -endless; result.transmittance > 0.0;) {
        // from here to the next end or beginning of a piece of any medium
        double start = endless, end = endless;
        for (std::size_t m = 0; m < media.size(); ++m) {
            if (const OpticalPiece* piece = pieceOf(m)) start = std::min(start, piece->interval.begin);
        }
        begin = std::max(begin, start);
        for (std::size_t m = 0; m < media.size(); ++m) {
            const OpticalPiece* piece = pieceOf(m);
            if (piece != nullptr)
                end = std::min(end, piece->interval.begin > begin ? piece->interval.begin : piece->interval.end);
        }
        if (end == endless) return result;
        const double length = end - begin;
        double depth = 0.0;
        for (std::size_t m = 0; m < media.size(); ++m) {
            const OpticalPiece* piece = pieceOf(m);
            if (piece == nullptr || piece->interval.begin > begin) continue;
            depth += piece->depth * (length / (piece->interval.end - piece->interval.begin));
            if (piece->interval.end <= end) ++current[m];
        }
        const double collided = -std::expm1(-depth);
        result.distance += result.transmittance * collided * (begin + length * meanPosition(depth));
        result.transmittance *= 1.0 - collided;
        begin = end;
    }
    return result;
}

std::optional<double> frontAlong(const Medium& medium, const VoxelRay& ray) {
    std::optional<double> front;
    eachPiece(medium, ray, [&](const Interval& piece) {
        // corners that have a share in the middle of a piece have one all along it
        if (densityAt(medium, ray, 0.5 * (piece.begin + piece.end)) > 0.0) front = piece.begin;
        return !front;
    });
    return front;
}

}  // namespace lumulus::reference
