#include "mesh/bvh/tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <type_traits>
#include <utility>

namespace lumulus::bvh {
namespace {

constexpr int bins = 16;
constexpr std::size_t mostInLeaf = 4;       ///< and only where splitting costs more than it saves
constexpr int halvedFrom = 32;              ///< levels below which ranges are halved: 2^24 boxes end before MESH_DEPTH
constexpr std::size_t parallelFrom = 4096;  ///< boxes for which threads are worth while

struct Bin {
    Box box;
    std::size_t count = 0;

    void add(const Bin& other) {
        box.add(other.box);
        count += other.count;
    }
};

/// Bins of all axes, or the box of all middles.
using Bins = std::array<std::array<Bin, bins>, 3>;

struct Range {
    std::size_t begin = 0, end = 0;

    std::size_t size() const { return end - begin; }
};

struct Split {
    int axis = -1;
    int bin = 0;  ///< the last of the first child
    float cost = std::numeric_limits<float>::max();
};

class Builder {
  public:
    Builder(std::span<const Box> boxes, const Check& check) : boxes_(boxes), check_(check), order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
        nodes_.resize(std::max<std::size_t>(1, boxes.size() - 1));
    }

    Tree build() {
        const Range all{0, boxes_.size()};
        if (all.size() <= mostInLeaf) {
            setChild(nodes_[0], 0, boxOf(all), static_cast<int>(all.begin), static_cast<int>(all.size()));
            setChild(nodes_[0], 1, {}, -1, 0);
        } else {
            addNode(0, all, 0);
        }
        return {compacted(), std::move(order_)};
    }

  private:
    static void setChild(shared::MeshNode& node, int which, const Box& box, int child, int count) {
        (which == 0 ? node.lower0 : node.lower1) = box.lower;
        (which == 0 ? node.upper0 : node.upper1) = box.upper;
        (which == 0 ? node.child0 : node.child1) = child;
        (which == 0 ? node.count0 : node.count1) = count;
    }

    template <class Value, class Add>
    Value reduced(const Range& range, const Add& addBox) const {
        if (range.size() < parallelFrom) {
            Value value;
            for (std::size_t i = range.begin; i < range.end; ++i) addBox(value, boxes_[order_[i]]);
            return value;
        }
        return tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(range.begin, range.end, parallelFrom), Value(),
            [&](const tbb::blocked_range<std::size_t>& part, Value value) {
                for (std::size_t i = part.begin(); i < part.end(); ++i) addBox(value, boxes_[order_[i]]);
                return value;
            },
            [](Value a, const Value& b) {
                if constexpr (std::is_same_v<Value, Box>)
                    a.add(b);
                else
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        for (std::size_t i = 0; i < bins; ++i) a[axis][i].add(b[axis][i]);
                return a;
            });
    }

    Box boxOf(const Range& range) const {
        return reduced<Box>(range, [](Box& box, const Box& each) { box.add(each); });
    }
    Box middlesOf(const Range& range) const {
        return reduced<Box>(range, [](Box& box, const Box& each) { box.add(each.middle()); });
    }

    static int binOf(const Box& box, const Box& middles, int axis) {
        const float extent = middles.upper[axis] - middles.lower[axis];
        const float place = (box.middle()[axis] - middles.lower[axis]) / extent * static_cast<float>(bins);
        return std::clamp(static_cast<int>(place), 0, bins - 1);
    }

    Split bestSplit(const Range& range, const Box& middles) const {
        const Bins all = reduced<Bins>(range, [&](Bins& to, const Box& box) {
            for (int axis = 0; axis < 3; ++axis)
                if (middles.upper[axis] > middles.lower[axis])
                    to[static_cast<std::size_t>(axis)][static_cast<std::size_t>(binOf(box, middles, axis))].add(
                        {box, 1});
        });
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(middles.upper[axis] > middles.lower[axis])) continue;
            const auto& of = all[static_cast<std::size_t>(axis)];
            std::array<float, bins> after{};  // cost of all bins behind this one
            Bin behind;
            for (std::size_t i = bins - 1; i > 0; --i) {
                behind.add(of[i]);
                after[i - 1] = behind.box.area() * static_cast<float>(behind.count);
            }
            Bin before;
            for (std::size_t i = 0; i + 1 < bins; ++i) {
                before.add(of[i]);
                const float cost = before.box.area() * static_cast<float>(before.count) + after[i];
                if (before.count > 0 && before.count < range.size() && cost < best.cost)
                    best = {axis, static_cast<int>(i), cost};
            }
        }
        return best;
    }

    /// Reorders a range into two; the begin of the second. 0 where it should stay a leaf.
    std::size_t divide(const Range& range, const Box& box, int level) {
        constexpr float nodeCost = 1.0F;  // against that of a triangle
        const Box middles = middlesOf(range);
        const Split split = level < halvedFrom ? bestSplit(range, middles) : Split{};
        const float area = std::max(box.area(), std::numeric_limits<float>::min());
        if (range.size() <= mostInLeaf && !(nodeCost + split.cost / area < static_cast<float>(range.size()))) return 0;
        const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(range.begin);
        const auto end = order_.begin() + static_cast<std::ptrdiff_t>(range.end);
        if (split.axis >= 0) {
            const auto second = std::partition(
                begin, end, [&](std::uint32_t i) { return binOf(boxes_[i], middles, split.axis) <= split.bin; });
            return static_cast<std::size_t>(second - order_.begin());
        }
        const glm::vec3 extent = middles.upper - middles.lower;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const auto half = begin + (end - begin) / 2;
        std::nth_element(begin, half, end, [&](std::uint32_t a, std::uint32_t b) {
            const float at = boxes_[a].middle()[axis], other = boxes_[b].middle()[axis];
            return at != other ? at < other : a < b;
        });
        return static_cast<std::size_t>(half - order_.begin());
    }

    /// Fills the node `index` and those below it, which lie before index + range.size() − 1.
    void addNode(std::size_t index, const Range& range, int level) {
        check_();
        const std::size_t second = divide(range, boxOf(range), level);
        const Range first{range.begin, second}, last{second, range.end};
        const std::size_t firstNode = index + 1, lastNode = index + first.size();
        const auto add = [&](int which, const Range& part, std::size_t node) {
            const Box box = boxOf(part);
            if (part.size() <= mostInLeaf && divide(part, box, level + 1) == 0) {
                setChild(nodes_[index], which, box, static_cast<int>(part.begin), static_cast<int>(part.size()));
                return;
            }
            setChild(nodes_[index], which, box, static_cast<int>(node), 0);
            addNode(node, part, level + 1);
        };
        if (range.size() < parallelFrom) {
            add(0, first, firstNode);
            add(1, last, lastNode);
        } else {
            tbb::parallel_invoke([&] { add(0, first, firstNode); }, [&] { add(1, last, lastNode); });
        }
    }

    /// The nodes that are used, each before those below it.
    std::vector<shared::MeshNode> compacted() const {
        std::vector<shared::MeshNode> used{nodes_[0]};
        for (std::size_t i = 0; i < used.size(); ++i)
            for (const int which : {0, 1}) {
                const shared::MeshNode node = used[i];
                const int child = which == 0 ? node.child0 : node.child1;
                if (child < 0 || (which == 0 ? node.count0 : node.count1) > 0) continue;
                (which == 0 ? used[i].child0 : used[i].child1) = static_cast<int>(used.size());
                used.push_back(nodes_[static_cast<std::size_t>(child)]);
            }
        return used;
    }

    std::span<const Box> boxes_;
    const Check& check_;
    std::vector<std::uint32_t> order_;
    std::vector<shared::MeshNode> nodes_;
};

}  // namespace

float Box::area() const {
    const glm::vec3 size = upper - lower;
    return size.x < 0.0F ? 0.0F : size.x * size.y + size.y * size.z + size.z * size.x;
}

Tree buildTree(std::span<const Box> boxes, const Check& check) {
    return Builder(boxes, check).build();
}

}  // namespace lumulus::bvh
