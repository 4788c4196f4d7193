#include "vdb/optical_thickness.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vdb/sparse_volume.h"

namespace lumulus::vdb {
namespace {

/// What is known of some columns along one axis.
struct Columns {
    double largest = 0.0;
    double total = 0.0;
    double count = 0.0;

    void add(double sum) {
        if (!(sum > 0.0)) return;
        largest = std::max(largest, sum);
        total += sum;
        count += 1.0;
    }
};

/// Columns along x and y in a slice of z.
void addSlice(const Volume& volume, int z, Columns& alongX, Columns& alongY) {
    std::vector<double> sums(static_cast<std::size_t>(volume.size.x), 0.0);
    for (int y = 0; y < volume.size.y; ++y) {
        const float* row = &volume.density[volume.index(0, y, z)];
        double sum = 0.0;
        for (std::size_t x = 0; x < sums.size(); ++x) {
            const auto value = static_cast<double>(row[x]);
            sum += value;
            sums[x] += value;
        }
        alongX.add(sum);
    }
    for (const double sum : sums) alongY.add(sum);
}

/// Columns along z in a slice of y.
void addDepth(const Volume& volume, int y, Columns& alongZ) {
    std::vector<double> sums(static_cast<std::size_t>(volume.size.x), 0.0);
    for (int z = 0; z < volume.size.z; ++z) {
        const float* row = &volume.density[volume.index(0, y, z)];
        for (std::size_t x = 0; x < sums.size(); ++x) sums[x] += static_cast<double>(row[x]);
    }
    for (const double sum : sums) alongZ.add(sum);
}

}  // namespace

ColumnSums columnSums(const Volume& volume, const Check& check) {
    const glm::ivec3 size = volume.size;
    if (volume.density.empty()) return {};
    // a value for each slice, so that the order of threads does not matter
    std::vector<Columns> along[3];
    along[0].resize(static_cast<std::size_t>(size.z));
    along[1].resize(static_cast<std::size_t>(size.z));
    along[2].resize(static_cast<std::size_t>(size.y));
    tbb::parallel_for(0, size.z, [&](int z) {
        check();
        addSlice(volume, z, along[0][static_cast<std::size_t>(z)], along[1][static_cast<std::size_t>(z)]);
    });
    tbb::parallel_for(0, size.y, [&](int y) {
        check();
        addDepth(volume, y, along[2][static_cast<std::size_t>(y)]);
    });
    ColumnSums result;
    for (int axis = 0; axis < 3; ++axis) {
        Columns all;
        for (const Columns& part : along[axis]) {
            all.largest = std::max(all.largest, part.largest);
            all.total += part.total;
            all.count += part.count;
        }
        result.largest[axis] = all.largest;
        result.mean[axis] = all.count > 0.0 ? all.total / all.count : 0.0;
    }
    return result;
}

ColumnSums columnSums(const SparseVolume& volume) {
    constexpr double across = LeafTable::edge * LeafTable::edge;
    ColumnSums result;
    std::vector<std::pair<std::uint64_t, double>> columns;
    for (int axis = 0; axis < 3; ++axis) {
        columns.clear();
        for (const LeafTable::Leaf& leaf : volume.leaves.leaves) {
            const auto first = static_cast<std::uint64_t>(leaf.at[(axis + 1) % 3]);
            const auto second = static_cast<std::uint64_t>(leaf.at[(axis + 2) % 3]);
            columns.emplace_back(first << 32U | second, static_cast<double>(leaf.mass) / across);
        }
        std::ranges::sort(columns);
        Columns all;
        for (std::size_t i = 0; i < columns.size();) {
            double sum = 0.0;
            const std::uint64_t column = columns[i].first;
            for (; i < columns.size() && columns[i].first == column; ++i) sum += columns[i].second;
            all.add(sum);
        }
        result.largest[axis] = all.largest;
        result.mean[axis] = all.count > 0.0 ? all.total / all.count : 0.0;
    }
    return result;
}

}  // namespace lumulus::vdb
