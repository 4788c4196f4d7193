#include "vdb/deform.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vdb/transform.h"

namespace lumulus::vdb {

namespace {

/// Trilinear, 0 outside.
double densityAt(const Volume& volume, const glm::dvec3& voxel) {
    const glm::dvec3 at = voxel - 0.5, low = glm::floor(at), share = at - low;
    if (glm::any(glm::lessThan(low, glm::dvec3(0.0))) ||
        glm::any(glm::greaterThanEqual(low + 1.0, glm::dvec3(volume.size))))
        return 0.0;
    double density = 0.0;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2), from = glm::ivec3(low) + corner;
        const glm::dvec3 each = glm::mix(1.0 - share, share, glm::dvec3(corner));
        density += each.x * each.y * each.z * static_cast<double>(volume.density[volume.index(from.x, from.y, from.z)]);
    }
    return density;
}

/// Voxels by which a cloud may have grown on each side.
double marginOf(const Volume& cloud, const Flow& flow, double seconds) {
    const double shortest = std::min({glm::length(cloud.toWorld.linear[0]), glm::length(cloud.toWorld.linear[1]),
                                      glm::length(cloud.toWorld.linear[2])});
    constexpr double fastest = 2.0 / std::numbers::sqrt3;  // of one component, over the root mean square
    return std::ceil(fastest * flow.swirl * std::abs(seconds) / shortest) + 1.0;
}

}  // namespace

Flow::Flow(const Volume& cloud, const glm::dvec3& theWind, double theSwirl) : wind(theWind), swirl(theSwirl) {
    const glm::dvec3 edges(glm::length(cloud.toWorld.linear[0]), glm::length(cloud.toWorld.linear[1]),
                           glm::length(cloud.toWorld.linear[2]));
    const glm::dvec3 extent = edges * glm::dvec3(cloud.size);
    wave = 0.5 * std::max({extent.x, extent.y, extent.z});
}

glm::dvec3 Flow::velocity(const glm::dvec3& place, double seconds) const {
    const glm::dvec3 phase = 2.0 * std::numbers::pi / wave * (place - seconds * wind);
    const glm::dvec3 s = glm::sin(phase), c = glm::cos(phase);
    return wind + swirl / std::numbers::sqrt3 * glm::dvec3(s.z + c.y, s.x + c.z, s.y + c.x);
}

glm::dvec3 Flow::origin(const glm::dvec3& place, double seconds) const {
    constexpr double stepsOfWave = 25.0;
    const double steps = std::ceil(std::abs(seconds) * swirl * stepsOfWave / wave);
    glm::dvec3 at = place - seconds * wind;  // carried along with the wind, the flow stands still
    const double step = -seconds / std::max(1.0, steps);
    const Flow still = [this] {
        Flow flow = *this;
        flow.wind = glm::dvec3(0.0);
        return flow;
    }();
    for (double done = 0.0; done < steps; ++done) {  // Runge and Kutta, fourth order
        const glm::dvec3 a = still.velocity(at, 0.0), b = still.velocity(at + 0.5 * step * a, 0.0),
                         c = still.velocity(at + 0.5 * step * b, 0.0), d = still.velocity(at + step * c, 0.0);
        at += step / 6.0 * (a + 2.0 * (b + c) + d);
    }
    return at;
}

double voxelsOfDeformed(const Volume& cloud, const Flow& flow, double seconds) {
    const glm::dvec3 size = glm::dvec3(cloud.size) + 2.0 * marginOf(cloud, flow, seconds);
    return size.x * size.y * size.z;
}

Volume deformed(const Volume& cloud, const Flow& flow, double seconds, const Check& check) {
    const glm::dmat3 toVoxels = glm::inverse(cloud.toWorld.linear);
    const auto margin = static_cast<int>(marginOf(cloud, flow, seconds));
    Volume volume;
    volume.name = cloud.name;
    volume.size = cloud.size + 2 * margin;
    volume.toWorld = cloud.toWorld;
    volume.toWorld.translation += seconds * flow.wind - cloud.toWorld.vector(glm::dvec3(margin));
    volume.density.resize(volume.index(0, 0, volume.size.z));
    std::vector<float> most(static_cast<std::size_t>(volume.size.z));
    tbb::parallel_for(1, volume.size.z - 1, [&](int z) {
        check();
        for (int y = 1; y < volume.size.y - 1; ++y)
            for (int x = 1; x < volume.size.x - 1; ++x) {
                const glm::dvec3 place = volume.toWorld.point(glm::dvec3(x, y, z) + 0.5);
                const glm::dvec3 from = toVoxels * (flow.origin(place, seconds) - cloud.toWorld.translation);
                const auto value = static_cast<float>(densityAt(cloud, from));
                volume.density[volume.index(x, y, z)] = value;
                most[static_cast<std::size_t>(z)] = std::max(most[static_cast<std::size_t>(z)], value);
            }
    });
    volume.maximum = std::ranges::max(most);
    return volume;
}

VelocityGrid velocitiesOf(const Volume& cloud, const Flow& flow, double seconds) {
    constexpr int across = 2;
    VelocityGrid grid;
    grid.size = (cloud.size + across - 1) / across;
    grid.toWorld = composed(cloud.toWorld, {glm::dmat3(static_cast<double>(across)), glm::dvec3(0.0)});
    for (int z = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x)
                grid.values.emplace_back(flow.velocity(grid.toWorld.point(glm::dvec3(x, y, z) + 0.5), seconds));
    return grid;
}

}  // namespace lumulus::vdb
