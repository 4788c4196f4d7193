#include "reference/instance_tree.h"

#include <cassert>
#include <numeric>

namespace lumulus::reference {
namespace {

/// One box a leaf: a test of a box is far cheaper than a walk through the voxels in it.
constexpr std::size_t leafSize = 1;

}  // namespace

InstanceTree::InstanceTree(std::span<const Box> boxes) : nodes_(1), order_(boxes.size()) {
    assert(!boxes.empty());
    std::iota(order_.begin(), order_.end(), 0U);
    split(0, order_, boxes);
}

void InstanceTree::split(std::size_t node, std::span<std::uint32_t> entries, std::span<const Box> boxes) {
    Box whole, middles;
    for (const std::uint32_t entry : entries) {
        whole.include(boxes[entry]);
        middles.include(0.5 * (boxes[entry].low + boxes[entry].high));
    }
    nodes_[node].box = whole;
    if (entries.size() <= leafSize) {
        nodes_[node].first = static_cast<std::uint32_t>(entries.data() - order_.data());
        nodes_[node].count = static_cast<std::uint32_t>(entries.size());
        return;
    }
    const glm::dvec3 extent = middles.high - middles.low;
    const int axis = extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
    const std::size_t half = entries.size() / 2;
    std::ranges::nth_element(entries, entries.begin() + static_cast<std::ptrdiff_t>(half), {},
                             [&](std::uint32_t entry) { return boxes[entry].low[axis] + boxes[entry].high[axis]; });
    const std::size_t children = nodes_.size();
    nodes_[node].first = static_cast<std::uint32_t>(children);
    nodes_.resize(children + 2);
    split(children, entries.first(half), boxes);
    split(children + 1, entries.subspan(half), boxes);
}

}  // namespace lumulus::reference
