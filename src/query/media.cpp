#include "query/media.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "medium/fog_media.h"

namespace lumulus::query {

namespace {

constexpr std::size_t grain = 256;  // ways between two questions whether to go on

template <typename PassageOf>
std::vector<Passage> passages(std::size_t count, const PassageOf& passageOf, const Check& check) {
    std::vector<Passage> result(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
        check();
        for (std::size_t i = range.begin(); i < range.end(); ++i) result[i] = passageOf(i);
    });
    return result;
}

Passage toSun(const Media& media, const glm::dvec3& point, const glm::dvec3& directionTo) {
    if (media.ground && (point.y < *media.ground || directionTo.y <= 0.0))
        return {glm::dvec3(std::numeric_limits<double>::infinity())};
    return media.along({point, directionTo});
}

}  // namespace

glm::dvec3 Rectangle::point(int column, int row) const {
    return {x0 + (column + 0.5) / width * (x1 - x0), y, z0 + (row + 0.5) / height * (z1 - z0)};
}

Passage Media::along(const Way& way) const {
    Passage passage;
    passage.opticalDepth = glm::dvec3(clouds.opticalDepth(way));
    if (fog.media.empty() || !(way.length > 0.0)) return passage;
    shared::FogPath path = shared::clearPath();
    const auto distance = static_cast<float>(std::min(way.length, 1e30));
    for (const shared::FogMedium& medium : fog::mediaAround(fog, way.origin))
        shared::addMedium(path, medium,
                          shared::densityIntegral(medium, glm::vec3(0.0F), glm::vec3(way.direction), distance,
                                                  static_cast<float>(fog.skyDistance)));
    passage.opticalDepth += glm::dvec3(path.scattering + path.absorption);
    return passage;
}

Media mediaOf(const scene::Scene& scene, CloudVolumes volumes, const Check& check) {
    std::vector<std::shared_ptr<const BrickField>> fields;
    std::vector<double> units;  // densities of bricks are of the field's maximum
    for (vdb::SparseVolume& volume : volumes.bricks) {
        fields.push_back(std::make_shared<const BrickField>(volume, check));
        units.push_back(static_cast<double>(volume.maximum));
        volume = {};
    }
    if (!volumes.isSparse())
        for (const auto& volume : volumes.volumes) fields.push_back(std::make_shared<const BrickField>(*volume, check));
    units.resize(fields.size(), 1.0);
    std::vector<PlacedField> placed;
    for (std::size_t i = 0; i < volumes.clouds.size(); ++i) {
        const CloudVolumes::Cloud& cloud = volumes.clouds[i];
        placed.push_back({fields[cloud.volume], cloud.toWorld.linear, cloud.toWorld.translation,
                          scene.clouds[i].extinction * scene.clouds[i].densityScale * units[cloud.volume]});
    }
    return {Clouds(std::move(placed)), scene.fog, scene.ground ? std::optional(scene.ground->height) : std::nullopt};
}

std::vector<Passage> alongSegments(const Media& media, std::span<const Segment> segments, const Check& check) {
    return passages(
        segments.size(), [&](std::size_t i) { return media.along(Way::between(segments[i].from, segments[i].to)); },
        check);
}

std::vector<Passage> towardsSun(const Media& media, std::span<const glm::dvec3> points, const glm::dvec3& directionTo,
                                const Check& check) {
    return passages(
        points.size(), [&](std::size_t i) { return toSun(media, points[i], directionTo); }, check);
}

LayeredImage groundShadow(const Media& media, const Rectangle& rectangle, const glm::dvec3& directionTo,
                          const Check& check) {
    LayeredImage image;
    image.width = rectangle.width;
    image.height = rectangle.height;
    const auto width = static_cast<std::size_t>(rectangle.width);
    const std::vector<Passage> found = passages(
        image.pixels(),
        [&](std::size_t i) {
            return toSun(media, rectangle.point(static_cast<int>(i % width), static_cast<int>(i / width)), directionTo);
        },
        check);
    constexpr const char* names[3] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<float>& layer = image.layer(names[channel]);
        for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = static_cast<float>(found[i].transmittance()[channel]);
    }
    return image;
}

}  // namespace lumulus::query
