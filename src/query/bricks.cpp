#include "query/bricks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace lumulus::query {

namespace {

constexpr int edge = vdb::SparseVolume::brickEdge;    // cells of a brick along each axis
constexpr int corners = vdb::SparseVolume::slotEdge;  // values along each axis
constexpr int nodeEdge = vdb::SparseVolume::nodeEdge;
constexpr std::size_t nodeEntries = vdb::SparseVolume::nodeEntries;
constexpr std::size_t valuesOfBrick = vdb::SparseVolume::slotTexels;
constexpr float steps = 65535.0F;      // of a 16-bit value
constexpr float gauss = 0.288675135F;  // 1/(2√3): distance of Gauss's two points from the middle of an interval of 1

/// Distances at which a line meets the planes of whole coordinates, axis by axis.
template <typename Vec>
struct Planes {
    Vec next, stride;

    Planes(const Vec& start, const Vec& velocity) {
        using Real = typename Vec::value_type;
        for (int axis = 0; axis < 3; ++axis) {
            const Real v = velocity[axis];
            const bool aside = std::abs(v) < Real(1e-30);
            const Real plane = v > Real(0) ? std::floor(start[axis]) + Real(1) : std::ceil(start[axis]) - Real(1);
            next[axis] = aside ? std::numeric_limits<Real>::max() : (plane - start[axis]) / v;
            stride[axis] = aside ? Real(0) : Real(1) / std::abs(v);
        }
    }

    /// The next distance, which is passed.
    auto take() {
        const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        const auto at = next[axis];
        next[axis] += stride[axis];
        return at;
    }
};

/// The eight values at the corners of a cell.
struct Corners {
    float v[8];

    explicit Corners(const std::uint16_t* at) {
        constexpr int row = corners, layer = corners * corners;
        const int offsets[8] = {0, 1, row, row + 1, layer, layer + 1, layer + row, layer + row + 1};
        for (int i = 0; i < 8; ++i) v[i] = static_cast<float>(at[offsets[i]]);
    }

    float at(const glm::vec3& f) const {
        const float x0 = v[0] + f.x * (v[1] - v[0]), x1 = v[2] + f.x * (v[3] - v[2]);
        const float x2 = v[4] + f.x * (v[5] - v[4]), x3 = v[6] + f.x * (v[7] - v[6]);
        const float near = x0 + f.y * (x1 - x0), far = x2 + f.y * (x3 - x2);
        return near + f.z * (far - near);
    }
};

/// The 9³ values from a corner on, zero beyond the volume. Returns the largest.
float readCorners(const vdb::Volume& volume, const glm::ivec3& corner, std::span<float, valuesOfBrick> to) {
    float largest = 0.0F;
    std::size_t place = 0;
    for (int z = 0; z < corners; ++z)
        for (int y = 0; y < corners; ++y)
            for (int x = 0; x < corners; ++x, ++place) {
                const glm::ivec3 voxel = corner + glm::ivec3(x, y, z);
                const bool inside = glm::all(glm::lessThan(voxel, volume.size));
                to[place] = inside ? volume.density[volume.index(voxel.x, voxel.y, voxel.z)] : 0.0F;
                largest = std::max(largest, to[place]);
            }
    return largest;
}

glm::ivec3 bricksOf(const glm::ivec3& size) {
    return glm::max((size + edge - 1) / edge, glm::ivec3(1));
}

glm::ivec3 nodesOf(const glm::ivec3& bricks) {
    return (bricks + nodeEdge - 1) / nodeEdge;
}

std::size_t numberOf(const glm::ivec3& at, const glm::ivec3& extent) {
    return static_cast<std::size_t>(at.x) +
           static_cast<std::size_t>(extent.x) *
               (static_cast<std::size_t>(at.y) + static_cast<std::size_t>(extent.y) * static_cast<std::size_t>(at.z));
}

}  // namespace

BrickField::BrickField(const vdb::Volume& volume, const Check& check) : size_(volume.size), count_(bricksOf(size_)) {
    const glm::ivec3 nodes = nodesOf(count_);
    const std::size_t layer = nodeEntries * static_cast<std::size_t>(nodes.x) * static_cast<std::size_t>(nodes.y);
    nodes_.resize(layer / nodeEntries * static_cast<std::size_t>(nodes.z));
    std::iota(nodes_.begin(), nodes_.end(), 0U);
    bricks_.resize(nodes_.size() * nodeEntries);
    std::vector<std::vector<std::uint16_t>> layers(static_cast<std::size_t>(nodes.z));
    tbb::parallel_for(0, nodes.z, [&](int z) {
        check();
        std::vector<std::uint16_t>& values = layers[static_cast<std::size_t>(z)];
        float densities[valuesOfBrick];
        glm::ivec3 at(0, 0, nodeEdge * z);
        for (; at.z < std::min(nodeEdge * (z + 1), count_.z); ++at.z)
            for (at.y = 0; at.y < count_.y; ++at.y)
                for (at.x = 0; at.x < count_.x; ++at.x) {
                    const float largest = readCorners(volume, edge * at, densities);
                    if (!(largest > 0.0F)) continue;
                    Brick& brick = bricks_[entryOf(at)];
                    brick.step = largest / steps;
                    brick.values = static_cast<std::uint32_t>(values.size() / valuesOfBrick);
                    for (const float density : densities)
                        values.push_back(static_cast<std::uint16_t>(std::lround(density / largest * steps)));
                }
    });
    std::size_t total = 0;
    for (const auto& values : layers) total += values.size();
    pool_.reserve(total);
    for (std::size_t z = 0; z < layers.size(); ++z) {
        const auto before = static_cast<std::uint32_t>(pool_.size() / valuesOfBrick);
        for (std::size_t i = 0; i < layer; ++i) bricks_[layer * z + i].values += before;
        pool_.insert(pool_.end(), layers[z].begin(), layers[z].end());
        layers[z] = {};
    }
}

BrickField::BrickField(const BrickIndex& index, const SlotReader& read, const Check& check)
    : size_(index.size), count_(bricksOf(size_)), nodes_(index.nodes.begin(), index.nodes.end()) {
    bricks_.reserve(index.entries.size());
    std::unordered_map<std::uint32_t, std::uint32_t> known;  // values of a place of the pool
    std::vector<std::uint32_t> places;
    for (const vdb::BrickEntry& entry : index.entries) {
        const glm::vec2 range = glm::unpackHalf2x16(entry.range);
        Brick brick{0, range.x, std::max(range.y, 0.0F) / steps, vdb::levelOf(entry)};
        if (brick.step > 0.0F) {
            const std::uint32_t place = vdb::slotPlace(vdb::slotOf(entry.place));
            const auto [found, isNew] = known.emplace(place, static_cast<std::uint32_t>(places.size()));
            if (isNew) places.push_back(place);
            brick.values = found->second;
        }
        bricks_.push_back(brick);
    }
    pool_.resize(places.size() * valuesOfBrick);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, places.size(), 4096), [&](const auto& range) {
        check();
        float texels[valuesOfBrick];
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            read(places[i], std::span<float, valuesOfBrick>(texels));
            for (std::size_t k = 0; k < valuesOfBrick; ++k)
                pool_[valuesOfBrick * i + k] = static_cast<std::uint16_t>(std::lround(texels[k] * steps));
        }
    });
}

BrickField::BrickField(vdb::SparseVolume& volume, const Check& check) {
    const std::vector<std::byte> texels = vdb::allTexels(volume, check);
    const auto read = [&](std::uint32_t place, std::span<float, valuesOfBrick> to) {
        const glm::uvec3 slot = vdb::slotOf(place);
        const auto width = static_cast<std::size_t>(volume.poolWidth);
        const std::size_t first = valuesOfBrick * (slot.x + width * (slot.y + width * slot.z) - volume.firstSlot);
        for (std::size_t i = 0; i < valuesOfBrick; ++i) to[i] = vdb::texelValue(texels, first + i, volume.format);
    };
    *this = BrickField({volume.size, volume.nodes, volume.entries}, read, check);
}

std::size_t BrickField::entryOf(const glm::ivec3& brick) const {
    const glm::ivec3 within = brick % nodeEdge;
    return nodeEntries * nodes_[numberOf(brick / nodeEdge, nodesOf(count_))] + numberOf(within, glm::ivec3(nodeEdge));
}

std::optional<vdb::Volume> BrickField::volume(const Check& check) const {
    if (std::ranges::any_of(bricks_, [](const Brick& brick) { return brick.level > 0; })) return std::nullopt;
    vdb::Volume volume;
    volume.size = size_;
    volume.density.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                          static_cast<std::size_t>(size_.z));
    glm::ivec3 at(0);
    for (at.z = 0; at.z < size_.z; ++at.z) {
        check();
        for (at.y = 0; at.y < size_.y; ++at.y)
            for (at.x = 0; at.x < size_.x; ++at.x) {
                const Brick& brick = bricks_[entryOf(at / edge)];
                float value = brick.low;
                if (brick.step > 0.0F) {
                    const std::size_t place = numberOf(at % edge, glm::ivec3(corners));
                    value += brick.step * static_cast<float>(pool_[valuesOfBrick * brick.values + place]);
                }
                volume.density[volume.index(at.x, at.y, at.z)] = value;
                volume.maximum = std::max(volume.maximum, value);
            }
    }
    return volume;
}

std::uint64_t BrickField::bytes() const {
    return nodes_.size() * sizeof(std::uint32_t) + bricks_.size() * sizeof(Brick) +
           pool_.size() * sizeof(std::uint16_t);
}

template <typename Visit>
void BrickField::visitCells(const Brick& brick, const glm::ivec3& number, const VoxelLine& line, double length,
                            const Visit& visit) const {
    const std::uint16_t* values = &pool_[valuesOfBrick * brick.values];
    const double unit = std::exp2(-brick.level);  // of a voxel, in texels
    const glm::dvec3 group(edge * ((number >> brick.level) << brick.level));
    const glm::vec3 origin(unit * (line.start - group)), v(unit * line.velocity);
    Planes<glm::vec3> planes(origin, v);
    const auto last = static_cast<float>(length);
    for (float t = 0.0F; t < last;) {
        const float end = std::clamp(planes.take(), t, last);
        const float span = end - t, middle = t + 0.5F * span;
        const glm::vec3 centre = origin + middle * v;
        const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(centre)), glm::ivec3(0), glm::ivec3(edge - 1));
        const Corners at(values + (cell.z * corners + cell.y) * corners + cell.x);
        const glm::vec3 inCell = centre - glm::vec3(cell), aside = gauss * span * v;
        if (!visit(t, span, at.at(inCell - aside), at.at(inCell + aside))) return;
        t = end;
    }
}

double BrickField::brickIntegral(const glm::ivec3& number, const VoxelLine& line, double length) const {
    const Brick& brick = bricks_[entryOf(number)];
    const double constant = length * static_cast<double>(brick.low);
    if (!(brick.step > 0.0F)) return constant;
    double sum = 0.0;
    visitCells(brick, number, line, length, [&](float /*begin*/, float span, float near, float far) {
        sum += static_cast<double>(span * (near + far));
        return true;
    });
    return 0.5 * sum * static_cast<double>(brick.step) + constant;
}

double BrickField::brickReach(const glm::ivec3& number, const VoxelLine& line, double length, double wanted) const {
    const Brick& brick = bricks_[entryOf(number)];
    const auto low = static_cast<double>(brick.low), step = static_cast<double>(brick.step);
    if (!(step > 0.0)) return std::min(length, wanted / low);
    double sum = 0.0, found = length;
    visitCells(brick, number, line, length, [&](float begin, float span, float near, float far) {
        const double all = static_cast<double>(span), one = low + step * static_cast<double>(near),
                     other = low + step * static_cast<double>(far), more = 0.5 * all * (one + other);
        if (sum + more < wanted || !(all > 0.0)) {
            sum += more;
            return true;
        }
        // first + slope · t, of which the integral is wanted
        const double slope = (other - one) / (2.0 * static_cast<double>(gauss) * all);
        const double first = std::max(0.0, 0.5 * (one + other) - 0.5 * slope * all), left = wanted - sum;
        const double root = std::sqrt(std::max(0.0, first * first + 2.0 * slope * left));
        found = static_cast<double>(begin) + std::clamp(2.0 * left / std::max(first + root, 1e-300), 0.0, all);
        return false;
    });
    return found;
}

bool BrickField::clip(const VoxelLine& line, double& begin, double& end) const {
    // in cells between voxel centres, of which the first begins at the middle of voxel 0
    const glm::dvec3 origin = line.start - 0.5, limit(size_ - 1);
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(line.velocity[axis]) < 1e-30) {
            if (!(origin[axis] > 0.0 && origin[axis] < limit[axis])) return false;
            continue;
        }
        const double a = -origin[axis] / line.velocity[axis], b = (limit[axis] - origin[axis]) / line.velocity[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return begin < end;
}

template <typename Visit>
void BrickField::visitBricks(const VoxelLine& line, double begin, double end, const Visit& visit) const {
    if (!clip(line, begin, end)) return;
    const glm::dvec3 start = line.start - 0.5 + begin * line.velocity;
    Planes<glm::dvec3> planes(start / double(edge), line.velocity / double(edge));
    const double length = end - begin;
    for (double t = 0.0; t < length;) {
        const double next = std::clamp(planes.take(), t, length);
        const glm::dvec3 middle = start + 0.5 * (t + next) * line.velocity;
        const glm::ivec3 number = glm::clamp(glm::ivec3(glm::floor(middle / double(edge))), glm::ivec3(0), count_ - 1);
        if (!visit(number, VoxelLine{start + t * line.velocity, line.velocity}, begin + t, next - t)) return;
        t = next;
    }
}

double BrickField::integral(const VoxelLine& line, double begin, double end) const {
    double sum = 0.0;
    visitBricks(line, begin, end, [&](const glm::ivec3& number, const VoxelLine& part, double, double length) {
        sum += brickIntegral(number, part, length);
        return true;
    });
    return sum;
}

double BrickField::reach(const VoxelLine& line, double begin, double end, double wanted) const {
    double sum = 0.0, found = std::numeric_limits<double>::infinity();
    visitBricks(line, begin, end, [&](const glm::ivec3& number, const VoxelLine& part, double from, double length) {
        const double more = brickIntegral(number, part, length);
        if (sum + more < wanted || !(more > 0.0)) {
            sum += more;
            return true;
        }
        found = from + brickReach(number, part, length, wanted - sum);
        return false;
    });
    return found;
}

}  // namespace lumulus::query
