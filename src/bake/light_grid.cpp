#include "bake/light_grid.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bake/leaf_voxels.h"
#include "base/error.h"
#include "light/photon/leaf_light.h"

namespace lumulus::bake {
namespace {

using std::numbers::pi;

/// Longest side of the box around all leaves [m].
double longestSide(std::span<const photon::LeafLight> leaves) {
    glm::dvec3 lower(leaves.front().corner), upper(lower);
    for (const photon::LeafLight& leaf : leaves)
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at = leaf.corner + leaf.edges * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
            lower = glm::min(lower, at);
            upper = glm::max(upper, at);
        }
    const glm::dvec3 extent = upper - lower;
    return std::max({extent.x, extent.y, extent.z});
}

/// The sun in a voxel: the mean of eight points.
glm::vec3 sunIn(const Renderer& renderer, const query::Media& media, const glm::dvec3& middle, double voxel) {
    const scene::Sun sun = renderer.sunAt(middle);
    if (sun.irradiance == glm::dvec3(0.0)) return glm::vec3(0.0F);
    double transmittance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
        const query::Way way{middle + voxel * 0.25 * (2.0 * side - 1.0), sun.directionTo};
        transmittance += 0.125 * std::exp(-media.clouds.opticalDepth(way));
    }
    return glm::vec3(sun.irradiance * transmittance);
}

/// Harmonics by where light goes, as those by where it comes from: odd bands change their sign.
VoxelLight seenFrom(const std::array<glm::dvec3, 9>& travel) {
    VoxelLight light;
    for (std::size_t i = 0; i < travel.size(); ++i)
        light.coefficients[i] = glm::vec3(i >= 1 && i <= 3 ? -travel[i] : travel[i]);
    return light;
}

void addSun(LightGrid& grid, Renderer& renderer, const Report& report, const Check& check) {
    const query::Media media = renderer.media();
    constexpr std::size_t together = 16384;
    for (std::size_t begin = 0; begin < grid.places.size(); begin += together) {
        check();
        report("sunlight", begin, grid.places.size());
        tbb::parallel_for(begin, std::min(begin + together, grid.places.size()), [&](std::size_t i) {
            grid.light[i].sun = sunIn(renderer, media, grid.voxel * glm::dvec3(grid.places[i]), grid.voxel);
        });
    }
    report("sunlight", grid.places.size(), grid.places.size());
}

/// The box of voxels that leaves reach. Errors: as bakeLight().
VoxelBox voxelsOf(std::span<const photon::LeafLight> leaves, std::optional<double> voxel) {
    if (leaves.empty())
        throw InputError("no light is scattered in a cloud", "scene",
                         "give it a cloud with density and an albedo above 0, and a light");
    constexpr double voxelsAlong = 96.0;
    const double longest = longestSide(leaves), edge = voxel.value_or(longest / voxelsAlong);
    if (edge > longest)
        throw InputError(fmt::format("voxels of {:.4g} m are larger than the clouds, {:.4g} m", edge, longest),
                         "--voxel", "give smaller ones");
    return boxOf(leaves, edge);
}

}  // namespace

glm::vec3 VoxelLight::fluence() const {
    return static_cast<float>(std::sqrt(4.0 * pi)) * coefficients[0] + sun;
}

glm::vec3 VoxelLight::flux(int channel, const glm::vec3& toSun) const {
    const glm::vec3 from(coefficients[3][channel], coefficients[1][channel], coefficients[2][channel]);
    return -static_cast<float>(std::sqrt(4.0 * pi / 3.0)) * from - sun[channel] * toSun;
}

void checkVoxels(Renderer& renderer, std::optional<double> voxel) {
    voxelsOf(renderer.leafLight(), voxel);
}

LightGrid bakeLight(Renderer& renderer, std::optional<double> voxel, const Report& report, const Check& check) {
    const std::vector<photon::LeafLight> leaves = renderer.leafLight();
    const VoxelHarmonics harmonics = spread(leaves, voxelsOf(leaves, voxel), check);
    LightGrid grid;
    grid.voxel = harmonics.box.voxel;
    for (std::size_t index = 0; index < harmonics.number.size(); ++index) {
        const std::int32_t number = harmonics.number[index];
        if (number < 0) continue;
        grid.places.push_back(harmonics.box.placeOf(index));
        grid.light.push_back(seenFrom(harmonics.coefficients[static_cast<std::size_t>(number)]));
    }
    grid.toSun = renderer.sunAt(grid.voxel * glm::dvec3(grid.places.front())).directionTo;
    addSun(grid, renderer, report, check);
    return grid;
}

}  // namespace lumulus::bake
