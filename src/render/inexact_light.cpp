#include "render/inexact_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "cloud/voxel_shape.h"
#include "render/asset_maker.h"

namespace lumulus {

namespace {

/// Longest over shortest edge.
double flatness(const glm::dmat3& edges) {
    const double x = glm::length(edges[0]), y = glm::length(edges[1]), z = glm::length(edges[2]);
    return std::max({x, y, z}) / cloud::shortestEdge(edges);
}

}  // namespace

void warnOfBackwardPeaks(const scene::Scene& scene, WorldReport& report) {
    constexpr double thick = 10.0;  // optical depths on average
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) {
        const scene::Cloud& cloud = scene.clouds[i];
        if (cloud.phase.model != scene::PhaseModel::henyeyGreenstein || !(cloud.phase.g < -0.5)) continue;
        const auto isOther = [&](const scene::Cloud& other) {
            return !(other.phase == cloud.phase) || other.albedo != cloud.albedo;
        };
        // light that goes to and fro along a ray is known in one medium (photon/sky_return.h)
        if (scene.sky.model != scene::SkyModel::constant && std::ranges::any_of(scene.clouds, isOther)) {
            report.clouds[i].inexact = true;
            warnings.emplace_back(
                "clouds that scatter backwards (phase.g below -0.5), beside others of another phase function or "
                "albedo, may be 20 % too dark or too bright under an atmosphere or a map by photons alone; lumulus "
                "reference is exact");
        } else if (scene.sun.irradiance != glm::dvec3(0.0) && report.clouds[i].meanThickness > thick) {
            report.clouds[i].inexact = true;
            warnings.push_back(fmt::format(
                "cloud.{} scatters backwards (phase.g {:g}) and is thick: by photons alone sunlight in it is some 10 % "
                "too bright, and up to half where the sun stands behind it; lumulus reference is exact",
                report.clouds[i].name, cloud.phase.g));
        }
    }
    if (!warnings.empty()) report.warnings.push_back(warnings.front());
}

void warnOfUnresolvedVoxels(const World& world, WorldReport& report) {
    constexpr double unresolved = 2.0;              // transport optical depths of a voxel
    constexpr double flat = 4.0, noticeable = 1.0;  // optical depths on average
    bool warned = false;
    for (std::size_t i = 0; i < world.instances.size() && i < report.clouds.size(); ++i) {
        const cloud::Instance& instance = world.instances[i];
        if (instance.asset == nullptr) continue;
        if (flatness(instance.voxelToMetres) >= flat && report.clouds[i].meanThickness > noticeable)
            report.clouds[i].inexact = true;
        const double depth = reducedExtinction(instance.medium, world.photonMap.bands) * instance.voxelEdge();
        if (!(depth >= unresolved)) continue;
        report.clouds[i].inexact = true;
        if (warned) continue;
        warned = true;
        report.warnings.push_back(
            fmt::format("cloud.{} is so dense that light enters it by {:.2g} of a voxel only: by photons alone its "
                        "surface is up to "
                        "15 % too dark at a tenth of a voxel and 60 % at a hundredth; lumulus reference is exact",
                        report.clouds[i].name, 1.0 / depth));
    }
}

}  // namespace lumulus
