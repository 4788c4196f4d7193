#include "vdb/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumulus::vdb {
namespace {

/// Finaliser of MurmurHash3 (Appleby 2011).
std::uint32_t mixBits(std::uint32_t h) {
    h ^= h >> 16U;
    h *= 0x85ebca6bU;
    h ^= h >> 13U;
    h *= 0xc2b2ae35U;
    h ^= h >> 16U;
    return h;
}

/// Perlin's (2002) twelve edge directions of the cube, four of them twice, dotted with the offset.
float gradientDot(std::uint32_t hash, const glm::vec3& d) {
    const std::uint32_t h = hash >> 28U;
    const float u = h < 8U ? d.x : d.y;
    const float v = h < 4U ? d.y : (h == 12U || h == 14U ? d.x : d.z);
    return ((h & 1U) != 0U ? -u : u) + ((h & 2U) != 0U ? -v : v);
}

}  // namespace

std::uint32_t hashCell(const glm::ivec3& cell, std::uint32_t seed) {
    const auto bits = [](int i) { return static_cast<std::uint32_t>(i); };
    return mixBits(seed ^ (bits(cell.x) * 0x8da6b343U) ^ mixBits(bits(cell.y) * 0xd8163841U + 0x9e3779b9U) ^
                   (bits(cell.z) * 0xcb1ab31fU));
}

std::uint32_t deriveSeed(std::uint64_t seed, std::uint32_t stream) {
    const auto low = static_cast<std::uint32_t>(seed);
    const auto high = static_cast<std::uint32_t>(seed >> 32U);
    return mixBits(low + 0x9e3779b9U * mixBits(high + 0x85ebca6bU * mixBits(stream + 1U)));
}

float gradientNoise(const glm::vec3& point, std::uint32_t seed) {
    const glm::vec3 base = glm::floor(point);
    const glm::ivec3 cell(base);
    const glm::vec3 f = point - base;
    const glm::vec3 w = f * f * f * (f * (f * 6.0F - 15.0F) + 10.0F);
    const auto corner = [&](int x, int y, int z) {
        return gradientDot(hashCell(cell + glm::ivec3(x, y, z), seed), f - glm::vec3(glm::ivec3(x, y, z)));
    };
    const auto row = [&](int y, int z) { return glm::mix(corner(0, y, z), corner(1, y, z), w.x); };
    return glm::mix(glm::mix(row(0, 0), row(1, 0), w.y), glm::mix(row(0, 1), row(1, 1), w.y), w.z);
}

float fractalNoise(const glm::vec3& point, std::uint32_t seed, int octaves) {
    float sum = 0.0F;
    float amplitude = 0.5F;
    glm::vec3 p = point;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += amplitude * gradientNoise(p, seed + static_cast<std::uint32_t>(octave));
        amplitude *= 0.5F;
        p = p * 2.0F + 19.19F;  // the shift keeps the grids of the octaves from coinciding
    }
    return sum;
}

float cellDistance(const glm::vec3& point, std::uint32_t seed) {
    const glm::vec3 base = glm::floor(point);
    const glm::ivec3 cell(base);
    const glm::vec3 f = point - base;
    float nearest = 8.0F;
    for (int z = -1; z <= 1; ++z) {
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                const std::uint32_t h = hashCell(cell + glm::ivec3(x, y, z), seed);
                const glm::uvec3 tenBits(h & 1023U, (h >> 10U) & 1023U, (h >> 20U) & 1023U);
                const glm::vec3 d = glm::vec3(glm::ivec3(x, y, z)) + (glm::vec3(tenBits) + 0.5F) * (1.0F / 1024.0F) - f;
                nearest = std::min(nearest, glm::dot(d, d));
            }
        }
    }
    return std::sqrt(nearest);
}

float billowNoise(const glm::vec3& point, std::uint32_t seed) {
    const float d = cellDistance(point, seed);
    return std::sqrt(std::max(0.0F, 1.0F - d * d));
}

float RandomStream::uniform() {
    return static_cast<float>(hashCell(glm::ivec3(draws_++, 0, 0), seed_) >> 8U) * 0x1p-24F;
}

float RandomStream::uniform(float low, float high) {
    return low + (high - low) * uniform();
}

}  // namespace lumulus::vdb
