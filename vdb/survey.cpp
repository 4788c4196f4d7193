#include "vdb/survey.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lumulus::vdb {
namespace {

std::uint64_t countOf(const IndexBox& box) {
    const glm::i64vec3 extent = box.extent();
    return static_cast<std::uint64_t>(extent.x * extent.y * extent.z);
}

auto key(const glm::ivec3& at) {
    return std::tuple(at.x, at.y, at.z);
}

void keepFirst(std::optional<BadValue>& kept, const std::optional<BadValue>& other) {
    if (other && (!kept || key(other->at) < key(kept->at))) kept = other;
}

void keepLowest(std::optional<BadValue>& kept, const std::optional<BadValue>& other) {
    if (!other) return;
    if (!kept || std::tuple(other->value, key(other->at)) < std::tuple(kept->value, key(kept->at))) kept = other;
}

/// Notes the value of all voxels of a box.
void note(Survey& survey, BlockContent& content, const IndexBox& box, float value) {
    if (!std::isfinite(value)) {
        survey.notFinite += countOf(box);
        keepFirst(survey.firstOfThem, BadValue{box.minimum, value});
    } else if (value < 0.0F) {
        survey.negatives += countOf(box);
        keepLowest(survey.lowest, BadValue{box.minimum, value});
    } else if (value > 0.0F) {
        include(content.occupied, box);
        content.mass += static_cast<double>(value) * static_cast<double>(countOf(box));
        content.voxels += countOf(box);
        survey.maximum = std::max(survey.maximum, value);
    }
}

/// Surveys one block; its content goes to `content`.
void surveyBlock(Survey& survey, BlockContent& content, const Block& block) {
    if (block.leaf == nullptr) {
        note(survey, content, block.box, block.tile);
    } else {
        forEachVoxel(block.box, [&](const glm::ivec3& at) { note(survey, content, {at, at}, block.valueAt(at)); });
    }
}

/// Joins everything but the contents of blocks.
Survey merge(Survey a, const Survey& b) {
    a.maximum = std::max(a.maximum, b.maximum);
    a.notFinite += b.notFinite;
    a.negatives += b.negatives;
    keepFirst(a.firstOfThem, b.firstOfThem);
    keepLowest(a.lowest, b.lowest);
    return a;
}

/// The mass between two faces across an axis, from `first` to `last`.
struct Group {
    int first = 0;
    int last = 0;
    double mass = 0.0;
};

/// Blocks that are kept, as groups along an axis with gaps between them, in order.
std::vector<Group> groupsAlong(int axis, const std::vector<BlockContent>& blocks, const IndexBox& kept) {
    constexpr std::int64_t gap = Block::leafEdge;
    std::vector<Group> parts;
    for (const BlockContent& block : blocks) {
        if (block.occupied.empty() || intersect(block.occupied, kept).empty()) continue;
        parts.push_back({block.occupied.minimum[axis], block.occupied.maximum[axis], block.mass});
    }
    std::ranges::sort(parts, {}, [](const Group& group) { return std::tuple(group.first, group.last, group.mass); });
    std::vector<Group> groups;
    for (const Group& part : parts) {
        if (groups.empty() || std::int64_t{part.first} - groups.back().last > gap) {
            groups.push_back(part);
        } else {
            groups.back().last = std::max(groups.back().last, part.last);
            groups.back().mass += part.mass;
        }
    }
    return groups;
}

/// Takes the lightest ends off the kept box along an axis, as long as `allowance` lasts, and makes the box as small as
/// what is left. Returns whether any end was taken off.
bool trim(int axis, const std::vector<BlockContent>& blocks, IndexBox& kept, double& allowance) {
    const std::vector<Group> groups = groupsAlong(axis, blocks, kept);
    if (groups.empty()) return false;
    std::size_t first = 0, last = groups.size() - 1;
    while (first < last) {
        const bool low = groups[first].mass <= groups[last].mass;
        const double mass = groups[low ? first : last].mass;
        if (mass > allowance) break;
        allowance -= mass;
        low ? ++first : --last;
    }
    kept.minimum[axis] = std::max(kept.minimum[axis], groups[first].first);
    kept.maximum[axis] = std::min(kept.maximum[axis], groups[last].last);
    return first > 0 || last + 1 < groups.size();
}

double volumeOf(const IndexBox& box) {
    const glm::dvec3 extent(box.extent());
    return extent.x * extent.y * extent.z;
}

}  // namespace

void append(Survey& survey, Survey&& part) {
    survey.blocks.insert(survey.blocks.end(), part.blocks.begin(), part.blocks.end());
    if (!part.occupied.empty()) include(survey.occupied, part.occupied);
    survey.mass += part.mass;
    std::vector<BlockContent> blocks = std::move(survey.blocks);
    survey = merge(std::move(survey), part);
    survey.blocks = std::move(blocks);
}

Survey surveyField(const SparseField& field, const Check& check) {
    std::vector<BlockContent> contents(field.blocks.size());
    Survey survey = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, field.blocks.size(), 64), Survey{},
        [&](const tbb::blocked_range<std::size_t>& range, Survey part) {
            check();
            for (std::size_t i = range.begin(); i != range.end(); ++i) surveyBlock(part, contents[i], field.blocks[i]);
            return part;
        },
        merge);
    survey.blocks = std::move(contents);
    for (const BlockContent& block : survey.blocks) {
        if (block.occupied.empty()) continue;
        include(survey.occupied, block.occupied);
        survey.mass += block.mass;
    }
    return survey;
}

void clampValues(SparseField& field) {
    const auto clamped = [](float value) { return std::isfinite(value) && value > 0.0F ? value : 0.0F; };
    tbb::parallel_for(std::size_t{0}, field.blocks.size(), [&](std::size_t i) {
        Block& block = field.blocks[i];
        constexpr int values = Block::leafEdge * Block::leafEdge * Block::leafEdge;
        block.tile = clamped(block.tile);
        if (block.leaf != nullptr) std::transform(block.leaf, block.leaf + values, block.leaf, clamped);
    });
}

Apart findApart(const Survey& survey) {
    constexpr double largestShare = 1e-6, largestVolume = 0.5;
    const Apart nothing{survey.occupied, {}, 0, 0.0};
    Apart apart = nothing;
    double allowance = largestShare * survey.mass;
    for (bool again = true; again;) {
        again = false;
        for (int axis = 0; axis < 3; ++axis) again = trim(axis, survey.blocks, apart.kept, allowance) || again;
    }
    double left = 0.0;
    for (const BlockContent& block : survey.blocks) {
        if (block.occupied.empty() || !intersect(block.occupied, apart.kept).empty()) continue;
        if (apart.voxels == 0) apart.at = block.occupied.minimum;
        apart.voxels += block.voxels;
        left += block.mass;
    }
    if (apart.voxels == 0 || volumeOf(apart.kept) > largestVolume * volumeOf(survey.occupied)) return nothing;
    apart.share = left / survey.mass;
    return apart;
}

}  // namespace lumulus::vdb
