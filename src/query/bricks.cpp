#include "query/bricks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumulus::query {

namespace {

constexpr int edge = 8;            // cells of a brick along each axis
constexpr int corners = edge + 1;  // values along each axis
constexpr std::size_t valuesOfBrick = corners * corners * corners;
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

}  // namespace

BrickField::BrickField(const vdb::Volume& volume, const Check& check) : size_(volume.size) {
    count_ = glm::max((size_ - 1 + edge - 1) / edge, glm::ivec3(1));
    const auto layer = static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y);
    bricks_.resize(layer * static_cast<std::size_t>(count_.z));
    std::vector<std::vector<std::uint16_t>> layers(static_cast<std::size_t>(count_.z));
    tbb::parallel_for(0, count_.z, [&](int z) {
        check();
        std::vector<std::uint16_t>& values = layers[static_cast<std::size_t>(z)];
        std::uint16_t one[valuesOfBrick];
        Brick* brick = &bricks_[layer * static_cast<std::size_t>(z)];
        for (int y = 0; y < count_.y; ++y)
            for (int x = 0; x < count_.x; ++x, ++brick) {
                fill(volume, glm::ivec3(x, y, z) * edge, *brick, one);
                if (!(brick->unit > 0.0F)) continue;
                brick->values = static_cast<std::uint32_t>(values.size() / valuesOfBrick);
                values.insert(values.end(), one, one + valuesOfBrick);
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

void BrickField::fill(const vdb::Volume& volume, const glm::ivec3& corner, Brick& brick, std::uint16_t* values) const {
    float densities[valuesOfBrick];
    float largest = 0.0F;
    float* to = densities;
    for (int z = 0; z < corners; ++z)
        for (int y = 0; y < corners; ++y)
            for (int x = 0; x < corners; ++x, ++to) {
                const glm::ivec3 voxel = corner + glm::ivec3(x, y, z);
                const bool inside = voxel.x < size_.x && voxel.y < size_.y && voxel.z < size_.z;
                *to = inside ? volume.density[volume.index(voxel.x, voxel.y, voxel.z)] : 0.0F;
                largest = std::max(largest, *to);
            }
    brick.unit = largest / steps;
    if (!(brick.unit > 0.0F)) return;
    for (std::size_t i = 0; i < valuesOfBrick; ++i)
        values[i] = static_cast<std::uint16_t>(std::lround(densities[i] / largest * steps));
}

std::uint64_t BrickField::bytes() const {
    return bricks_.size() * sizeof(Brick) + pool_.size() * sizeof(std::uint16_t);
}

double BrickField::brickIntegral(const Brick& brick, const glm::dvec3& start, const glm::dvec3& velocity,
                                 double length) const {
    const std::uint16_t* values = &pool_[valuesOfBrick * brick.values];
    const glm::vec3 origin(start), v(velocity);
    Planes<glm::vec3> planes(origin, v);
    const auto last = static_cast<float>(length);
    double sum = 0.0;
    for (float t = 0.0F; t < last;) {
        const float end = std::clamp(planes.take(), t, last);
        const float span = end - t, middle = t + 0.5F * span;
        const glm::vec3 centre = origin + middle * v;
        const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(centre)), glm::ivec3(0), glm::ivec3(edge - 1));
        const Corners at(values + (cell.z * corners + cell.y) * corners + cell.x);
        const glm::vec3 inCell = centre - glm::vec3(cell), aside = gauss * span * v;
        sum += static_cast<double>(span * (at.at(inCell - aside) + at.at(inCell + aside)));
        t = end;
    }
    return 0.5 * sum * static_cast<double>(brick.unit);
}

double BrickField::integral(const VoxelLine& line, double begin, double end) const {
    // in cells between voxel centres, of which the first begins at the middle of voxel 0
    const glm::dvec3 origin = line.start - 0.5, limit(size_ - 1);
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(line.velocity[axis]) < 1e-30) {
            if (!(origin[axis] > 0.0 && origin[axis] < limit[axis])) return 0.0;
            continue;
        }
        const double a = -origin[axis] / line.velocity[axis], b = (limit[axis] - origin[axis]) / line.velocity[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    if (!(begin < end)) return 0.0;
    const glm::dvec3 start = origin + begin * line.velocity;
    Planes<glm::dvec3> planes(start / double(edge), line.velocity / double(edge));
    const double length = end - begin;
    double sum = 0.0;
    for (double t = 0.0; t < length;) {
        const double next = std::clamp(planes.take(), t, length);
        const glm::dvec3 middle = start + 0.5 * (t + next) * line.velocity;
        const glm::ivec3 number = glm::clamp(glm::ivec3(glm::floor(middle / double(edge))), glm::ivec3(0), count_ - 1);
        const auto index = (static_cast<std::size_t>(number.z) * static_cast<std::size_t>(count_.y) +
                            static_cast<std::size_t>(number.y)) *
                               static_cast<std::size_t>(count_.x) +
                           static_cast<std::size_t>(number.x);
        const Brick& brick = bricks_[index];
        if (brick.unit > 0.0F)
            sum += brickIntegral(brick, start + t * line.velocity - glm::dvec3(number * edge), line.velocity, next - t);
        t = next;
    }
    return sum;
}

}  // namespace lumulus::query
