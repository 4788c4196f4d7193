#include "query/clouds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace lumulus::query {

namespace {

constexpr std::size_t fewParts = 4;  // of a node that is not split

/// Whether a way meets a box; `inverse` is that of its direction, and infinite where that is 0.
bool meets(const glm::dvec3& lower, const glm::dvec3& upper, const Way& way, const glm::dvec3& inverse) {
    double begin = 0.0, end = way.length;
    for (int axis = 0; axis < 3; ++axis) {
        if (way.direction[axis] == 0.0) {
            if (way.origin[axis] < lower[axis] || way.origin[axis] > upper[axis]) return false;
            continue;
        }
        const double a = (lower[axis] - way.origin[axis]) * inverse[axis];
        const double b = (upper[axis] - way.origin[axis]) * inverse[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return begin <= end;
}

}  // namespace

Way Way::between(const glm::dvec3& from, const glm::dvec3& to) {
    const double length = glm::length(to - from);
    return {from, length > 0.0 ? (to - from) / length : glm::dvec3(0.0, 1.0, 0.0), length};
}

void Clouds::Box::add(const Box& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
}

Clouds::Clouds(std::vector<PlacedField> fields) {
    for (PlacedField& placed : fields) {
        if (!(placed.extinction > 0.0)) continue;
        Part part{std::move(placed), glm::dmat3(1.0), {}};
        part.metresToVoxel = glm::inverse(part.placed.voxelToMetres);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 voxel =
                glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2) * glm::dvec3(part.placed.field->size());
            const glm::dvec3 at = part.placed.origin + part.placed.voxelToMetres * voxel;
            part.box.add({at, at});
        }
        parts_.push_back(std::move(part));
    }
    if (!parts_.empty()) split(0, parts_.size());
}

void Clouds::split(std::size_t first, std::size_t count) {
    const std::size_t number = nodes_.size();
    nodes_.emplace_back();
    const auto begin = parts_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    Box box;
    for (auto part = begin; part != end; ++part) box.add(part->box);
    nodes_[number].box = box;
    nodes_[number].first = first;
    if (count <= fewParts) {
        nodes_[number].count = count;
        return;
    }
    const glm::dvec3 extent = box.upper - box.lower;
    const int axis = extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
    const std::size_t half = count / 2;
    std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half), end, [axis](const Part& a, const Part& b) {
        return a.box.lower[axis] + a.box.upper[axis] < b.box.lower[axis] + b.box.upper[axis];
    });
    split(first, half);
    nodes_[number].second = nodes_.size();
    split(first + half, count - half);
}

Clouds Clouds::movedBy(const glm::dvec3& way) const {
    std::vector<PlacedField> moved;
    for (const Part& part : parts_) {
        moved.push_back(part.placed);
        moved.back().origin += way;
    }
    return Clouds(std::move(moved));
}

std::uint64_t Clouds::bytes() const {
    std::set<const BrickField*> fields;
    for (const Part& part : parts_) fields.insert(part.placed.field.get());
    std::uint64_t sum = 0;
    for (const BrickField* field : fields) sum += field->bytes();
    return sum;
}

std::optional<Extent> Clouds::extent() const {
    if (nodes_.empty()) return std::nullopt;
    return Extent{nodes_.front().box.lower, nodes_.front().box.upper};
}

double Clouds::finestVoxel() const {
    double finest = 0.0;
    for (const Part& part : parts_) {
        const double edge = std::cbrt(std::abs(glm::determinant(part.placed.voxelToMetres)));
        if (finest == 0.0 || edge < finest) finest = edge;
    }
    return finest;
}

double Clouds::depthOf(const Part& part, const Way& way) const {
    const VoxelLine line{part.metresToVoxel * (way.origin - part.placed.origin), part.metresToVoxel * way.direction};
    return part.placed.extinction * part.placed.field->integral(line, 0.0, way.length);
}

double Clouds::opticalDepth(const Way& way) const {
    if (nodes_.empty() || !(way.length > 0.0)) return 0.0;
    const glm::dvec3 inverse = 1.0 / way.direction;
    double depth = 0.0;
    std::array<std::size_t, 64> waiting{};  // a tree of n parts has about log2 n levels
    std::size_t count = 1;
    while (count > 0) {
        const std::size_t number = waiting[--count];
        const Node& node = nodes_[number];
        if (!meets(node.box.lower, node.box.upper, way, inverse)) continue;
        for (std::size_t i = node.first; i < node.first + node.count; ++i)
            if (meets(parts_[i].box.lower, parts_[i].box.upper, way, inverse)) depth += depthOf(parts_[i], way);
        if (node.count > 0) continue;
        waiting[count++] = node.second;
        waiting[count++] = number + 1;
    }
    return depth;
}

}  // namespace lumulus::query
