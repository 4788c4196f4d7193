#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reference/tracer.h"
#include "support/statistics.h"

/// Light of a ray through clouds as the reference finds it, with its standard error.
namespace lumulus::reference {

/// A volume at another place, `by` metres from its own.
inline vdb::PlacedVolume shifted(const vdb::Volume& volume, const glm::dvec3& by) {
    return {volume, {volume.toWorld.linear, volume.toWorld.translation + by}};
}

struct Seen {
    std::array<test::RunningMean, 3> channel;
};

/// Radiance along a ray with the sky behind, from so many paths.
inline Seen seen(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, const Ray& ray, int samples,
                 std::uint64_t seed) {
    const PathTracer tracer(scene, volumes, Majorant::local);
    Random random(seed, 0, 0);
    Seen result;
    for (int i = 0; i < samples; ++i) {
        const PathSample sample = tracer.trace(ray, random);
        const glm::dvec3 radiance = sample.radiance + sample.passed * tracer.environment().unit();
        for (int c = 0; c < 3; ++c) result.channel[static_cast<std::size_t>(c)].add(radiance[c]);
    }
    return result;
}

}  // namespace lumulus::reference
