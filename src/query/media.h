#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "base/image.h"
#include "base/interrupt.h"
#include "query/clouds.h"
#include "scene/scene.h"
#include "volume/load.h"

namespace lumulus::query {

/// A straight line from one point to another, metres.
struct Segment {
    glm::dvec3 from{0.0}, to{0.0};
};

/// What light of each channel meets along a way, all clouds and all fog together.
struct Passage {
    glm::dvec3 opticalDepth{0.0};

    /// Share of the light that arrives as it left.
    glm::dvec3 transmittance() const { return glm::exp(-opticalDepth); }
};

/// A level rectangle, and the points in it at which light is asked for: the middles of width × height fields. Rows go
/// from z0 to z1, columns from x0 to x1. Metres.
struct Rectangle {
    double x0 = 0.0, z0 = 0.0, x1 = 1.0, z1 = 1.0;
    double y = 0.0;
    int width = 1, height = 1;

    glm::dvec3 point(int column, int row) const;
};

/// All that dims light in a scene, for questions without a picture.
struct Media {
    Clouds clouds;
    scene::Fog fog;
    std::optional<double> ground;  ///< height below which no light comes from the sun; absent: none

    /// Fog is integrated in closed form; media without an end stop `fog.sky_distance` after the beginning of the way.
    Passage along(const Way& way) const;
};

/// The media of a scene. `volumes` are those of loadClouds. Errors: what `check` throws.
Media mediaOf(const scene::Scene& scene, CloudVolumes volumes, const Check& check = stopIfInterrupted);

/// One passage for each segment, in their order. The threads of oneTBB share the work; their number changes no bit.
/// Errors: what `check` throws, which is asked on any thread.
std::vector<Passage> alongSegments(const Media& media, std::span<const Segment> segments, const Check& check);

/// One passage for each point, from there to the sun's middle: an infinite depth where the ground is before it.
/// Errors: as above.
std::vector<Passage> towardsSun(const Media& media, std::span<const glm::dvec3> points, const glm::dvec3& directionTo,
                                const Check& check);

/// Layers R, G, B: the sun's transmittance at the points of a rectangle. Errors: as above.
LayeredImage groundShadow(const Media& media, const Rectangle& rectangle, const glm::dvec3& directionTo,
                          const Check& check);

}  // namespace lumulus::query
