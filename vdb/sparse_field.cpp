#include "vdb/sparse_field.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <tuple>

namespace lumulus::vdb {
namespace {

/// The blocks that touch each coarse slice: blocks[first[s]] … blocks[first[s + 1] − 1], in a fixed order.
struct SliceLists {
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> blocks;
};

class Rasteriser {
  public:
    Rasteriser(const SparseField& field, const IndexBox& crop, std::int64_t n, const Check& check)
        : field_(field), crop_(crop), n_(n), check_(check), size_(coarseSize(crop.extent(), n)), lists_(listSlices()) {}

    Volume rasterise() const {
        Volume volume;
        volume.size = size_ + 2;
        volume.density.assign(volume.index(0, 0, volume.size.z), 0.0F);
        std::vector<float> maxima(static_cast<std::size_t>(size_.z), 0.0F);
        tbb::parallel_for(0, size_.z, [&](int slice) {
            check_();
            maxima[static_cast<std::size_t>(slice)] = n_ == 1 ? copySlice(volume, slice) : averageSlice(volume, slice);
        });
        volume.maximum = *std::max_element(maxima.begin(), maxima.end());
        return volume;
    }

  private:
    std::int64_t coarse(int coordinate, int axis) const {
        return (static_cast<std::int64_t>(coordinate) - crop_.minimum[axis]) / n_;
    }

    /// The fine voxels of coarse voxel `i` along one axis, within the crop: first and last coordinate.
    std::pair<int, int> fine(std::int64_t i, int axis) const {
        const std::int64_t first = crop_.minimum[axis] + i * n_;
        return {static_cast<int>(first),
                static_cast<int>(std::min(first + n_ - 1, static_cast<std::int64_t>(crop_.maximum[axis])))};
    }

    SliceLists listSlices() const {
        SliceLists lists;
        lists.first.assign(static_cast<std::size_t>(size_.z) + 1, 0);
        const auto forEachSlice = [&](const auto& visit) {
            for (std::size_t b = 0; b < field_.blocks.size(); ++b) {
                const IndexBox box = intersect(field_.blocks[b].box, crop_);
                if (box.empty()) continue;
                const std::int64_t last = coarse(box.maximum.z, 2);
                for (std::int64_t s = coarse(box.minimum.z, 2); s <= last; ++s) visit(static_cast<std::size_t>(s), b);
            }
        };
        forEachSlice([&](std::size_t slice, std::size_t) { ++lists.first[slice + 1]; });
        for (std::size_t s = 1; s < lists.first.size(); ++s) lists.first[s] += lists.first[s - 1];
        lists.blocks.resize(lists.first.back());
        std::vector<std::size_t> next = lists.first;
        forEachSlice(
            [&](std::size_t slice, std::size_t b) { lists.blocks[next[slice]++] = static_cast<std::uint32_t>(b); });
        return lists;
    }

    /// Calls `visit(block, box)` with the part of each block in a slice.
    template <typename Visit>
    void forEachBlock(int slice, const Visit& visit) const {
        IndexBox here = crop_;
        std::tie(here.minimum.z, here.maximum.z) = fine(slice, 2);
        for (std::size_t i = lists_.first[static_cast<std::size_t>(slice)];
             i < lists_.first[static_cast<std::size_t>(slice) + 1]; ++i) {
            const Block& block = field_.blocks[lists_.blocks[i]];
            visit(block, intersect(block.box, here));
        }
    }

    /// Full resolution. Returns the largest value.
    float copySlice(Volume& volume, int slice) const {
        float largest = 0.0F;
        forEachBlock(slice, [&](const Block& block, const IndexBox& box) {
            forEachVoxel(box, [&](const glm::ivec3& at) {
                const float value = block.valueAt(at);
                const glm::ivec3 local(glm::i64vec3(at) - glm::i64vec3(crop_.minimum) + std::int64_t{1});
                volume.density[volume.index(local.x, local.y, local.z)] = value;
                largest = std::max(largest, value);
            });
        });
        return largest;
    }

    /// Box averages, summed in double.
    float averageSlice(Volume& volume, int slice) const {
        std::vector<double> sums(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y), 0.0);
        forEachBlock(slice, [&](const Block& block, const IndexBox& box) {
            if (block.leaf == nullptr) {
                addConstant(sums, box, static_cast<double>(block.tile));
            } else {
                addLeaf(sums, block, box);
            }
        });
        const auto edge = static_cast<double>(n_);
        float largest = 0.0F;
        for (int y = 0; y < size_.y; ++y) {
            for (int x = 0; x < size_.x; ++x) {
                const auto average = static_cast<float>(sums[cell(x, y)] / (edge * edge * edge));
                volume.density[volume.index(x + 1, y + 1, slice + 1)] = average;
                largest = std::max(largest, average);
            }
        }
        return largest;
    }

    void addConstant(std::vector<double>& sums, const IndexBox& box, double value) const {
        const auto depth = static_cast<double>(box.extent().z);
        const auto overlap = [&](std::int64_t i, int axis) {
            const auto [first, last] = fine(i, axis);
            return static_cast<double>(std::int64_t{std::min(last, box.maximum[axis])} -
                                       std::int64_t{std::max(first, box.minimum[axis])} + 1);
        };
        for (std::int64_t y = coarse(box.minimum.y, 1); y <= coarse(box.maximum.y, 1); ++y) {
            const double area = depth * overlap(y, 1) * value;
            for (std::int64_t x = coarse(box.minimum.x, 0); x <= coarse(box.maximum.x, 0); ++x) {
                sums[cell(x, y)] += area * overlap(x, 0);
            }
        }
    }

    void addLeaf(std::vector<double>& sums, const Block& block, const IndexBox& box) const {
        for (std::int64_t x = box.minimum.x; x <= box.maximum.x; ++x) {
            const std::int64_t column = coarse(static_cast<int>(x), 0);
            for (std::int64_t y = box.minimum.y; y <= box.maximum.y; ++y) {
                double row = 0.0;
                for (std::int64_t z = box.minimum.z; z <= box.maximum.z; ++z) {
                    row += static_cast<double>(block.valueAt(glm::ivec3(glm::i64vec3(x, y, z))));
                }
                sums[cell(column, coarse(static_cast<int>(y), 1))] += row;
            }
        }
    }

    std::size_t cell(std::int64_t x, std::int64_t y) const { return static_cast<std::size_t>(y * size_.x + x); }

    const SparseField& field_;
    IndexBox crop_;
    std::int64_t n_;
    const Check& check_;
    glm::ivec3 size_;
    SliceLists lists_;
};

}  // namespace

glm::ivec3 coarseSize(const glm::i64vec3& extent, std::int64_t n) {
    return glm::ivec3((extent + (n - std::int64_t{1})) / n);
}

std::int64_t chooseCoarsening(const glm::i64vec3& extent, double budget, int maxExtent) {
    const auto fits = [&](std::int64_t n) {
        const glm::dvec3 size = glm::dvec3((extent + (n - std::int64_t{1})) / n) + 2.0;
        return glm::compMax(size) <= maxExtent && 2.0 * size.x * size.y * size.z <= budget;
    };
    std::int64_t high = glm::compMax(extent);
    if (!fits(high)) return 0;
    std::int64_t low = 0;  // does not fit, or does not coarsen
    while (high - low > 1) {
        const std::int64_t middle = low + (high - low) / 2;
        (fits(middle) ? high : low) = middle;
    }
    return high;
}

Volume rasteriseField(const SparseField& field, const IndexBox& crop, std::int64_t n, const Check& check) {
    return Rasteriser(field, crop, n, check).rasterise();
}

}  // namespace lumulus::vdb
