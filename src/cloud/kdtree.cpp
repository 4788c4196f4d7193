#include "cloud/kdtree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <queue>

namespace lumulus::cloud {

namespace {

using shared::LeafBox;

/// A node that still may be split, with its samples [begin, end).
struct Work {
    int node;
    LeafBox box;
    std::size_t begin, end;
};

struct Split {
    int axis = -1;
    int plane = 0;
    std::size_t middle = 0;  // first sample of the second half
};

/// Sum over both parts of the squared deviations of density from the part's mean.
double spread(std::span<const Sample> samples, int axis, float plane) {
    double n[2] = {0, 0}, sum[2] = {0, 0}, squares[2] = {0, 0};
    for (const Sample& s : samples) {
        const int half = s.position[axis] < plane ? 0 : 1;
        n[half] += 1.0;
        sum[half] += static_cast<double>(s.density);
        squares[half] += static_cast<double>(s.density) * static_cast<double>(s.density);
    }
    double total = 0.0;
    for (int half = 0; half < 2; ++half)
        if (n[half] > 0.0) total += std::max(0.0, squares[half] - sum[half] * sum[half] / n[half]);
    return total;
}

/// The sample median on the axis, as a voxel boundary strictly inside the box.
int medianPlane(std::span<const Sample> samples, const LeafBox& box, int axis, std::vector<float>& scratch) {
    scratch.clear();
    for (const Sample& s : samples) scratch.push_back(s.position[axis]);
    const auto middle = scratch.begin() + static_cast<std::ptrdiff_t>(scratch.size() / 2);
    std::nth_element(scratch.begin(), middle, scratch.end());
    return std::clamp(static_cast<int>(std::lround(*middle)), box.lower[axis] + 1, box.upper[axis] - 1);
}

bool wantsSplit(std::span<const Sample> samples, double threshold) {
    if (samples.size() < 2) return false;
    const auto [low, high] = std::minmax_element(
        samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.density < b.density; });
    return static_cast<double>(high->density - low->density) >= threshold;
}

Split chooseSplit(std::span<Sample> samples, const LeafBox& box) {
    std::vector<float> scratch;
    Split best;
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (box.upper[axis] - box.lower[axis] < 2) continue;
        const int plane = medianPlane(samples, box, axis, scratch);
        const double variance = spread(samples, axis, static_cast<float>(plane));
        if (variance < least) {
            least = variance;
            best = {axis, plane, 0};
        }
    }
    if (best.axis >= 0) {
        const auto middle = std::stable_partition(samples.begin(), samples.end(), [&](const Sample& s) {
            return s.position[best.axis] < static_cast<float>(best.plane);
        });
        best.middle = static_cast<std::size_t>(middle - samples.begin());
    }
    return best;
}

std::pair<LeafBox, LeafBox> halves(const LeafBox& box, int axis, int plane) {
    LeafBox first = box, second = box;
    first.upper[axis] = plane;
    second.lower[axis] = plane;
    return {first, second};
}

class Builder {
  public:
    Builder(std::vector<Sample> samples, const glm::ivec3& size, const KdTreeOptions& options)
        : samples_(std::move(samples)), options_(options) {
        tree_.nodes.emplace_back();
        open_.push_back({0, LeafBox{glm::ivec3(0), size}, 0, samples_.size()});
    }

    KdTree build() {
        while (!open_.empty()) splitLevel();
        finalise();
        splitOpticallyLarge();
        for (const Work& work : done_) {
            tree_.nodes[static_cast<std::size_t>(work.node)].leaf = static_cast<int>(tree_.leaves.size());
            tree_.leaves.push_back(work.box);
        }
        return std::move(tree_);
    }

  private:
    std::vector<Sample> samples_;
    const KdTreeOptions& options_;
    KdTree tree_;
    std::vector<Work> open_;
    std::vector<Work> done_;

    std::span<Sample> samplesOf(const Work& work) {
        return std::span(samples_).subspan(work.begin, work.end - work.begin);
    }

    std::size_t leafCount() const { return open_.size() + done_.size(); }
    bool full() const { return leafCount() >= static_cast<std::size_t>(options_.maxLeaves); }

    /// Makes two nodes out of one and returns them as work.
    std::pair<Work, Work> divide(const Work& work, const Split& split, bool median) {
        const auto [first, second] = halves(work.box, split.axis, split.plane);
        const int child = static_cast<int>(tree_.nodes.size());
        tree_.nodes.resize(tree_.nodes.size() + 2);
        KdNode& node = tree_.nodes[static_cast<std::size_t>(work.node)];
        node.axis = split.axis;
        node.plane = split.plane;
        node.child[0] = child;
        node.child[1] = child + 1;
        node.median = median;
        const std::size_t middle = work.begin + split.middle;
        return {Work{child, first, work.begin, middle}, Work{child + 1, second, middle, work.end}};
    }

    void splitLevel() {
        options_.check();
        std::vector<Split> splits(open_.size());
        tbb::parallel_for(std::size_t{0}, open_.size(), [&](std::size_t i) {
            const auto samples = samplesOf(open_[i]);
            if (wantsSplit(samples, options_.densityThreshold)) splits[i] = chooseSplit(samples, open_[i].box);
        });
        std::vector<Work> level;
        level.swap(open_);
        std::size_t unseen = level.size();
        for (std::size_t i = 0; i < level.size(); ++i, --unseen) {
            const bool room = leafCount() + unseen < static_cast<std::size_t>(options_.maxLeaves);
            if (splits[i].axis >= 0 && room) {
                const auto [first, second] = divide(level[i], splits[i], true);
                open_.push_back(first);
                open_.push_back(second);
            } else {
                tree_.limited = tree_.limited || splits[i].axis >= 0;
                done_.push_back(level[i]);
            }
        }
    }

    /// The widest slab of the leaf that lies beyond every sample's radius of influence, if it is a quarter of the edge.
    Split uncoveredSlab(const Work& work) {
        Split best;
        double widest = 0.25;
        const auto samples = samplesOf(work);
        for (int axis = 0; axis < 3 && !samples.empty(); ++axis) {
            const auto [low, high] = std::minmax_element(
                samples.begin(), samples.end(),
                [axis](const Sample& a, const Sample& b) { return a.position[axis] < b.position[axis]; });
            const double edge = work.box.upper[axis] - work.box.lower[axis];
            const double radius = options_.influenceRadius[axis];
            const int below = static_cast<int>(
                std::floor(std::max(static_cast<double>(low->position[axis]) - radius, double(work.box.lower[axis]))));
            const int above = static_cast<int>(
                std::ceil(std::min(static_cast<double>(high->position[axis]) + radius, double(work.box.upper[axis]))));
            if ((below - work.box.lower[axis]) / edge > widest) {
                widest = (below - work.box.lower[axis]) / edge;
                best = {axis, below, 0};
            }
            if ((work.box.upper[axis] - above) / edge > widest) {
                widest = (work.box.upper[axis] - above) / edge;
                best = {axis, above, samples.size()};
            }
        }
        return best;
    }

    void finalise() {
        for (std::size_t i = 0; i < done_.size(); ++i) {
            options_.check();
            for (Split slab = uncoveredSlab(done_[i]); slab.axis >= 0 && !full(); slab = uncoveredSlab(done_[i])) {
                const auto [first, second] = divide(done_[i], slab, false);
                const bool samplesFirst = slab.middle > 0;
                done_[i] = samplesFirst ? first : second;
                done_.push_back(samplesFirst ? second : first);
            }
        }
    }

    struct Thickness {
        double value = 0.0;
        int axis = 0;
    };

    /// Reduced optical thickness along the longest axis that has at least two voxels.
    Thickness opticalThickness(const LeafBox& box) const {
        Thickness most;
        for (int axis = 0; axis < 3; ++axis) {
            const double edge = (box.upper[axis] - box.lower[axis]) * options_.voxelEdge[axis];
            if (box.upper[axis] - box.lower[axis] >= 2 && edge > most.value) most = {edge, axis};
        }
        most.value *= options_.reducedExtinction * options_.density->mean(box);
        return most;
    }

    void splitOpticallyLarge() {
        if (options_.reducedExtinction <= 0.0) return;
        assert(options_.density != nullptr);
        using Entry = std::pair<double, std::size_t>;  // thickness, then the lower number: a definite order
        std::priority_queue<Entry> queue;
        const auto push = [&](std::size_t i) {
            const double value = opticalThickness(done_[i].box).value;
            if (value > options_.opticalLimit) queue.emplace(value, i);
        };
        for (std::size_t i = 0; i < done_.size(); ++i) push(i);
        while (!queue.empty() && !full()) {
            options_.check();
            const std::size_t i = queue.top().second;
            queue.pop();
            const LeafBox box = done_[i].box;
            const int axis = opticalThickness(box).axis;
            const int plane = (box.lower[axis] + box.upper[axis]) / 2;
            const auto samples = samplesOf(done_[i]);
            const auto middle = std::stable_partition(samples.begin(), samples.end(), [&](const Sample& s) {
                return s.position[axis] < static_cast<float>(plane);
            });
            const auto [first, second] =
                divide(done_[i], {axis, plane, static_cast<std::size_t>(middle - samples.begin())}, false);
            done_[i] = first;
            done_.push_back(second);
            push(i);
            push(done_.size() - 1);
        }
    }
};

}  // namespace

int KdTree::find(const glm::ivec3& voxel) const {
    std::size_t node = 0;
    while (nodes[node].axis >= 0)
        node = static_cast<std::size_t>(nodes[node].child[voxel[nodes[node].axis] < nodes[node].plane ? 0 : 1]);
    return nodes[node].leaf;
}

KdTree buildKdTree(std::vector<Sample> samples, const glm::ivec3& size, const KdTreeOptions& options) {
    return Builder(std::move(samples), size, options).build();
}

BlockDensity::BlockDensity(std::span<const float> density, const glm::ivec3& size, float maximum, int scale,
                           const Check& check)
    : blocks_((size + shared::BLOCK_EDGE - 1) / shared::BLOCK_EDGE), size_(size), scale_(scale) {
    const glm::ivec3 table = blocks_ + 1;
    sums_.assign(
        static_cast<std::size_t>(table.x) * static_cast<std::size_t>(table.y) * static_cast<std::size_t>(table.z), 0.0);
    const auto at = [&](int x, int y, int z) {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(table.y) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(table.x) +
               static_cast<std::size_t>(x);
    };
    tbb::parallel_for(0, size.z, shared::BLOCK_EDGE, [&](int zFirst) {
        check();
        for (int z = zFirst; z < std::min(zFirst + shared::BLOCK_EDGE, size.z); ++z)
            for (int y = 0; y < size.y; ++y) {
                const float* row = density.data() + (static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) +
                                                     static_cast<std::size_t>(y)) *
                                                        static_cast<std::size_t>(size.x);
                for (int x = 0; x < size.x; ++x)
                    sums_[at(x / shared::BLOCK_EDGE + 1, y / shared::BLOCK_EDGE + 1, z / shared::BLOCK_EDGE + 1)] +=
                        static_cast<double>(row[x] / maximum);
            }
    });
    for (int z = 1; z < table.z; ++z)
        for (int y = 1; y < table.y; ++y)
            for (int x = 1; x < table.x; ++x)
                sums_[at(x, y, z)] += sums_[at(x - 1, y, z)] + sums_[at(x, y - 1, z)] + sums_[at(x, y, z - 1)] -
                                      sums_[at(x - 1, y - 1, z)] - sums_[at(x - 1, y, z - 1)] -
                                      sums_[at(x, y - 1, z - 1)] + sums_[at(x - 1, y - 1, z - 1)];
}

double BlockDensity::prefix(int x, int y, int z) const {
    const glm::ivec3 table = blocks_ + 1;
    return sums_[(static_cast<std::size_t>(z) * static_cast<std::size_t>(table.y) + static_cast<std::size_t>(y)) *
                     static_cast<std::size_t>(table.x) +
                 static_cast<std::size_t>(x)];
}

double BlockDensity::mean(const shared::LeafBox& box) const {
    const int edge = shared::BLOCK_EDGE * scale_;
    const glm::ivec3 low = box.lower / edge;
    const glm::ivec3 high = (box.upper + edge - 1) / edge;
    const double sum = prefix(high.x, high.y, high.z) - prefix(low.x, high.y, high.z) - prefix(high.x, low.y, high.z) -
                       prefix(high.x, high.y, low.z) + prefix(low.x, low.y, high.z) + prefix(low.x, high.y, low.z) +
                       prefix(high.x, low.y, low.z) - prefix(low.x, low.y, low.z);
    const glm::dvec3 extent = glm::dvec3(glm::min(high * shared::BLOCK_EDGE, size_) - low * shared::BLOCK_EDGE);
    return std::max(0.0, sum) / (extent.x * extent.y * extent.z);
}

}  // namespace lumulus::cloud
