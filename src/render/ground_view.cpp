#include "render/ground_view.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <limits>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "render/world_fog.h"
#include "render/world_media.h"

namespace lumulus {

namespace {

constexpr int shadeSteps = 6;  ///< of the air before the ground

using Corners = std::pair<glm::dvec2, glm::dvec2>;

/// The rectangle in which light between clouds and ground is told apart: it moves with the wind.
Corners rectangleOf(const World& world) {
    constexpr double reach = 2.0;  // around the clouds, in their heights above the ground
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const glm::dvec3& corner : world.bounds.corners()) {
        lower = glm::min(lower, corner);
        upper = glm::max(upper, corner);
    }
    const double around = reach * std::max(0.0, upper.y - world.shadedGround()->height);
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

/// Sun or moon as it falls on the ground below the clouds, and the radiance of a sky that is the same everywhere and
/// sends as much onto it.
std::pair<scene::Sun, glm::dvec3> lightOnGround(const World& world) {
    scene::Sun sun = world.lights.direct();
    if (world.fogLight) {
        const double height = world.lights.planet ? world.lights.planet->height : world.lights.ground->height;
        sun.irradiance *= fogSurroundings(world).sunShare(height);
        return {sun, world.fogLight->irradianceBelow() / std::numbers::pi};
    }
    const sky::Atmosphere* air = world.lights.environment.atmosphere();
    if (air == nullptr) return {sun, world.lights.constantSky()};
    const glm::dvec3 foot(world.bounds.centre.x, air->groundHeight(), world.bounds.centre.z);
    const double up = glm::dot(sun.directionTo, air->upAt(foot));
    const glm::dvec3 scale = sun.irradiance / air->sunAbove();
    sun.irradiance = air->sunIrradiance(foot, sun.directionTo) * scale;
    const glm::dvec3 sky = air->air().rgb(air->multipleScattering().groundIrradiance(up)) * scale;
    return {sun, glm::max(sky, glm::dvec3(1e-30)) / std::numbers::pi};
}

}  // namespace

const surface::GroundLight& GroundView::light(gpu::Context& context, World& world, bool coarse) {
    update(context, world, coarse);
    if (world.photons && world.photons->generationsInRing() > 0) light_->setClouds(cloudLight(world));
    return *light_;
}

photon::Ground GroundView::forPhotons(gpu::Context& context, World& world) {
    constexpr int cells = 96;
    update(context, world, false);
    const auto [lower, upper] = rectangleOf(world);
    photon::Ground ground{light_->ground().albedo, light_->height(),           lower, upper, glm::ivec2(cells), {},
                          light_->openRadiance(),  world.lights.constantSky(), {}};
    // photons from below have weights of the ground without clouds under an atmosphere, and keep the share that is lit
    const bool shares = !world.lights.ground;
    const glm::dvec3 open = glm::max(ground.open, glm::dvec3(1e-30));
    if (shares) ground.open = ground.sky = glm::dvec3(1.0);
    for (int z = 0; z < cells; ++z)
        for (int x = 0; x < cells; ++x) {
            const glm::dvec2 middle = (glm::dvec2(x, z) + 0.5) / static_cast<double>(cells);
            const glm::dvec3 radiance = light_->directRadiance(glm::mix(lower, upper, middle));
            ground.radiance.emplace_back(shares ? radiance / open : radiance);
        }
    return ground;
}

void GroundView::update(gpu::Context& context, World& world, bool coarse) {
    constexpr double coarseShare = 0.25;
    const auto [sun, sky] = lightOnGround(world);
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
    if (moved || !(sun_ == sun) || fogVersion_ != world.fogVersion || (sunIsCoarse_ && !coarse)) {
        query::Media media = straightMediaOf(context, world, stopIfInterrupted);
        if (world.fogLight) media.fog.media.clear();  // what reaches the ground through it is known
        if (moved) {
            light_.emplace(*world.shadedGround(), media, sky, stopIfInterrupted);
            first_ = first;
        } else {
            media.clouds = media.clouds.movedBy(first_ - first);
        }
        light_->setSun(media, sun, coarse ? coarseShare * sunNodes_ : sunNodes_, stopIfInterrupted);
        light_->setSky(sky);
        if (meshes_) light_->setMeshes(meshes_(light_->ground(), sun, sky));
        clouds_ = std::move(clouds);
        sun_ = sun;
        fogVersion_ = world.fogVersion;
        sunIsCoarse_ = coarse;
    }
    light_->setDrift({first.x - first_.x, first.z - first_.z});
}

std::vector<shared::SunPixel> groundShade(const surface::GroundLight& light, const sky::Atmosphere& air,
                                          const Camera& camera, const Tile& tile) {
    constexpr int rays = 2;  // along each side of a pixel
    const auto [lower, upper] = light.shaded();
    const glm::dvec3 open = light.openRadiance();
    std::vector<std::vector<shared::SunPixel>> rows(static_cast<std::size_t>(tile.height));
    tbb::parallel_for(0, tile.height, [&](int y) {
        for (int x = 0; x < tile.width; ++x) {
            glm::dvec3 sum(0.0);
            for (int i = 0; i < rays * rays; ++i) {
                const Ray ray = camera.ray(tile.x + x + (i % rays + 0.5) / rays,
                                           tile.y + y + (static_cast<double>(i / rays) + 0.5) / rays);
                const std::optional<double> metres = surface::distanceToGround(ray, light.height());
                if (!metres) continue;
                const glm::dvec3 hit = ray.origin + *metres * ray.direction;
                const glm::dvec2 place(hit.x, hit.z);
                if (!glm::all(glm::greaterThan(place, lower)) || !glm::all(glm::lessThan(place, upper))) continue;
                const sky::AirPath path =
                    sky::makeAirPath(air.air(), std::max(0.0, air.heightAt(ray.origin)),
                                     glm::dot(ray.direction, air.upAt(ray.origin)), *metres, shadeSteps);
                sum += (light.radiance(place) - open) * (air.air().rgb(path.transmittance) / air.sunAbove());
            }
            if (sum != glm::dvec3(0.0))
                rows[static_cast<std::size_t>(y)].push_back({{x, y}, glm::vec3(sum / double(rays * rays))});
        }
    });
    std::vector<shared::SunPixel> pixels;
    for (const auto& row : rows) pixels.insert(pixels.end(), row.begin(), row.end());
    return pixels;
}

surface::GroundLight openGround(const World& world, const Check& check) {
    const auto [sun, sky] = lightOnGround(world);
    surface::GroundLight light(*world.lights.planet, {}, sky, check);
    light.setSun({}, sun, 1.0, check);
    return light;
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
