#include "render/ground_view.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "base/error.h"
#include "render/world_media.h"

namespace lumulus {

namespace {

using Corners = std::pair<glm::dvec2, glm::dvec2>;

/// The rectangle in which light between clouds and ground is told apart: it moves with the wind.
Corners rectangleOf(const World& world) {
    constexpr double reach = 2.0;  // around the clouds, in their heights above the ground
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const glm::dvec3& corner : world.bounds.corners()) {
        lower = glm::min(lower, corner);
        upper = glm::max(upper, corner);
    }
    const double around = reach * std::max(0.0, upper.y - world.lights.ground->height);
    const std::vector<std::size_t> visible = world.visible();
    const glm::dvec3 drift = visible.empty() ? glm::dvec3(0.0) : world.instances[visible.front()].offset;
    const glm::dvec2 moved(drift.x, drift.z);
    return {glm::dvec2(lower.x, lower.z) + moved - around, glm::dvec2(upper.x, upper.z) + moved + around};
}

/// Irradiance by the light that clouds send down.
surface::GroundGrid cloudLight(World& world) {
    const auto [lower, upper] = rectangleOf(world);
    const glm::dvec2 cell = (upper - lower) / static_cast<double>(shared::GROUND_COUNTS);
    surface::GroundGrid grid;
    grid.lower = lower + 0.5 * cell;
    grid.upper = upper - 0.5 * cell;
    grid.nodes = glm::ivec2(shared::GROUND_COUNTS);
    grid.outside = glm::vec3(0.0F);
    grid.values = world.photons->groundLight();
    for (glm::vec3& value : grid.values) value /= static_cast<float>(cell.x * cell.y);
    grid.smooth();
    return grid;
}

}  // namespace

const surface::GroundLight& GroundView::light(gpu::Context& context, World& world, const Check& check) {
    update(context, world, check);
    if (world.photons && world.photons->generationsInRing() > 0) light_->setClouds(cloudLight(world));
    return *light_;
}

photon::Ground GroundView::forPhotons(gpu::Context& context, World& world, const Check& check) {
    constexpr int cells = 96;
    update(context, world, check);
    const auto [lower, upper] = rectangleOf(world);
    photon::Ground ground{light_->ground().albedo, light_->height(),           lower, upper, glm::ivec2(cells), {},
                          light_->openRadiance(),  world.lights.constantSky(), {}};
    for (int z = 0; z < cells; ++z)
        for (int x = 0; x < cells; ++x) {
            const glm::dvec2 middle = (glm::dvec2(x, z) + 0.5) / static_cast<double>(cells);
            ground.radiance.emplace_back(light_->directRadiance(glm::mix(lower, upper, middle)));
        }
    return ground;
}

void GroundView::update(gpu::Context& context, World& world, const Check& check) {
    const scene::Sun& sun = world.lights.sun;
    const std::vector<std::size_t> visible = world.visible();
    Clouds clouds;
    glm::dvec3 first(0.0);
    for (const std::size_t i : visible) {
        const glm::dvec3 place = world.instances[i].origin + world.instances[i].offset;
        if (clouds.places.empty()) first = place;
        clouds.places.push_back(place - first);
        clouds.extinctions.push_back(world.instances[i].medium.extinction);
    }
    clouds.height = first.y;
    const bool moved = !light_ || !(clouds == clouds_);
    if (moved || !(sun_ == sun)) {
        query::Media media = straightMediaOf(context, world, check);
        if (moved) {
            light_.emplace(*world.lights.ground, media, world.lights.constantSky(), check);
            first_ = first;
        } else {
            media.clouds = media.clouds.movedBy(first_ - first);
        }
        light_->setSun(media, sun, sunNodes_, check);
        clouds_ = std::move(clouds);
        sun_ = sun;
    }
    light_->setDrift({first.x - first_.x, first.z - first_.z});
}

void requireAbove(const scene::Ground& ground, const Camera& camera) {
    if (camera.position.y < ground.height)
        throw InputError(
            fmt::format("the camera at y = {} m is below the ground at {} m", camera.position.y, ground.height),
            "camera.position", "raise the camera or lower ground.height");
}

std::vector<glm::vec4> groundThroughFog(fog::Fog& fog, const Camera& camera,
                                        const std::vector<surface::GroundPixel>& ground, const glm::dvec3& sky,
                                        const std::vector<shared::SunPixel>& sun) {
    fog::Layer layer;
    layer.radiance.reserve(ground.size());
    layer.distances.reserve(ground.size());
    for (const surface::GroundPixel& seen : ground) {
        layer.radiance.emplace_back(glm::mix(glm::vec3(sky), seen.radiance, seen.share), 1.0F);
        layer.distances.push_back(seen.share >= 0.5F ? seen.distance : shared::FAR_DEPTH);
    }
    for (const shared::SunPixel& pixel : sun)
        layer.radiance[static_cast<std::size_t>(pixel.pixel.y) * static_cast<std::size_t>(camera.width) +
                       static_cast<std::size_t>(pixel.pixel.x)] += glm::vec4(pixel.radiance, 0.0F);
    return fog.apply(layer, camera);
}

void layBehind(LayeredImage& image, const std::vector<glm::vec4>& behind, const Tile& part, int width) {
    constexpr const char* names[3] = {"R", "G", "B"};
    const std::vector<float>& covered = image.layer("cloud.A");
    for (int c = 0; c < 3; ++c) {
        const std::vector<float>& cloud = image.layer(std::string("cloud.") + names[c]);
        std::vector<float>& seen = image.layer(names[c]);
        for (int y = 0; y < part.height; ++y)
            for (int x = 0; x < part.width; ++x) {
                const auto to =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width) + static_cast<std::size_t>(x);
                const auto from = static_cast<std::size_t>(part.y + y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(part.x + x);
                seen[to] = cloud[to] + (1.0F - covered[to]) * behind[from][c];
            }
    }
}

}  // namespace lumulus
