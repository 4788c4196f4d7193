#include "surface/ground_picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace lumulus::surface {

namespace {

/// Rays along each side of a pixel: more where it shows the horizon.
constexpr int fewRays = 2, manyRays = 8;

GroundPixel seenBy(const Camera& camera, const glm::ivec2& pixel, const GroundLight& light, int rays) {
    glm::dvec3 radiance(0.0);
    double distance = 0.0;
    int hits = 0;
    for (int i = 0; i < rays * rays; ++i) {
        const Ray ray = camera.ray(pixel.x + (i % rays + 0.5) / rays, pixel.y + (i / rays + 0.5) / rays);
        const std::optional<double> metres = distanceToGround(ray, light.height());
        if (!metres) continue;
        ++hits;
        distance += *metres;
        radiance += light.radiance(glm::dvec2(ray.origin.x, ray.origin.z) +
                                   *metres * glm::dvec2(ray.direction.x, ray.direction.z));
    }
    if (hits == 0) return {};
    return {glm::vec3(radiance / double(hits)), static_cast<float>(hits) / static_cast<float>(rays * rays),
            std::min(static_cast<float>(distance / hits), shared::FAR_DEPTH)};
}

std::size_t indexOf(const glm::ivec2& pixel, int width) {
    return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(pixel.x);
}

}  // namespace

std::optional<double> distanceToGround(const Ray& ray, double height) {
    const double above = ray.origin.y - height;
    if (!(above >= 0.0 && ray.direction.y < 0.0)) return std::nullopt;
    return above / -ray.direction.y;
}

std::vector<GroundPixel> seenGround(const Camera& camera, const Tile& tile, const GroundLight& light) {
    std::vector<GroundPixel> pixels(static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height));
    tbb::parallel_for(0, tile.height, [&](int y) {
        for (int x = 0; x < tile.width; ++x) {
            const glm::ivec2 pixel(tile.x + x, tile.y + y);
            GroundPixel& seen = pixels[indexOf({x, y}, tile.width)];
            seen = seenBy(camera, pixel, light, fewRays);
            const auto meets = [&](int right, int below) {
                return distanceToGround(camera.ray(pixel.x + right, pixel.y + below), light.height()).has_value();
            };
            const int corners = meets(0, 0) + meets(1, 0) + meets(0, 1) + meets(1, 1);
            if (corners % 4 != 0 || (corners == 4) != (seen.share == 1.0F))
                seen = seenBy(camera, pixel, light, manyRays);
        }
    });
    return pixels;
}

void hideSun(std::vector<shared::SunPixel>& sun, const std::vector<GroundPixel>& ground, int width) {
    for (shared::SunPixel& pixel : sun) pixel.radiance *= 1.0F - ground[indexOf(pixel.pixel, width)].share;
}

void addGround(LayeredImage& image, const std::vector<GroundPixel>& ground, const glm::dvec3& sky) {
    const std::array<float*, 3> colours{image.layer("R").data(), image.layer("G").data(), image.layer("B").data()};
    const float* covered = image.layer("cloud.A").data();  // less than is hidden: a forward peak is seen through
    const glm::vec3 behind(sky);
    for (std::size_t i = 0; i < ground.size(); ++i) {
        const GroundPixel& seen = ground[i];
        if (!(seen.share > 0.0F)) continue;
        for (int c = 0; c < 3; ++c)
            colours[static_cast<std::size_t>(c)][i] +=
                (1.0F - covered[i]) * seen.share * (seen.radiance[c] - behind[c]);
    }
    addGroundDepth(image, ground);
}

void addGroundDepth(LayeredImage& image, const std::vector<GroundPixel>& ground) {
    const float* passed = image.layer("transmittance.R").data();
    float* depth = image.layer("depth.Z").data();
    float* front = image.layer("depth.front").data();
    for (std::size_t i = 0; i < ground.size(); ++i) {
        const GroundPixel& seen = ground[i];
        if (!(seen.share > 0.0F)) continue;
        front[i] = std::min(front[i], seen.distance);
        const float hidden = 1.0F - passed[i], shown = passed[i] * seen.share;
        const float cloud = hidden > 0.0F ? hidden * depth[i] : 0.0F;
        depth[i] = (cloud + shown * seen.distance) / (hidden + shown);
    }
}

}  // namespace lumulus::surface
