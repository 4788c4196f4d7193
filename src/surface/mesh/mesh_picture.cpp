#include "surface/mesh/mesh_picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "surface/ground_picture.h"

namespace lumulus::surface {
namespace {

constexpr int few = 2, many = shared::MESH_EDGE_RAYS;  // rays along each side of a pixel
constexpr int bandPixels = 1 << 16;

/// Rays of some pixels, as many of each, and what they meet.
struct Rays {
    std::vector<shared::MeshRay> rays;
    std::vector<double> skipped;  ///< metres before each ray begins
    std::vector<glm::dvec3> directions;
    std::vector<shared::MeshHit> hits;

    /// Metres from the eye; FAR_DEPTH where nothing is met.
    float distance(std::size_t ray) const {
        if (hits[ray].instance < 0) return shared::FAR_DEPTH;
        return static_cast<float>(skipped[ray] + static_cast<double>(hits[ray].distance));
    }
};

class Painting {
  public:
    Painting(const Camera& camera, std::optional<double> ground, const MeshScene& scene, RayTracer& tracer,
             MeshShading& shading, std::uint32_t directions, const RunGpu& run, const Check& check)
        : camera_(camera),
          ground_(ground),
          scene_(scene),
          tracer_(tracer),
          shading_(shading),
          directions_(directions),
          run_(run),
          check_(check) {}

    void drawBand(const Tile& band, MeshPixels& to) {
        // with the pixels around it, so that edges are found as in the whole picture
        const glm::ivec2 first = glm::max(glm::ivec2(band.x, band.y) - 1, glm::ivec2(0));
        const glm::ivec2 end = glm::min(glm::ivec2(band.x + band.width, band.y + band.height) + 1,
                                        glm::ivec2(camera_.width, camera_.height));
        const Tile around{first.x, first.y, end.x - first.x, end.y - first.y};
        const auto isOf = [&](const glm::ivec2& pixel) {
            return pixel.x >= band.x && pixel.y >= band.y && pixel.x < band.x + band.width &&
                   pixel.y < band.y + band.height;
        };
        std::vector<glm::ivec2> pixels;
        for (int y = 0; y < around.height; ++y)
            for (int x = 0; x < around.width; ++x) pixels.emplace_back(around.x + x, around.y + y);
        const Rays rays = follow(pixels, few);
        std::vector<glm::ivec2> edges;
        std::vector<bool> isEdge(pixels.size());
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            isEdge[i] = isOf(pixels[i]) && differ(rays, i, around);
            if (isEdge[i]) edges.push_back(pixels[i]);
        }
        const Rays edgeRays = follow(edges, many);
        std::size_t edge = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            if (isEdge[i])
                addPixel(edgeRays, edge++, many, pixels[i], to);
            else if (isOf(pixels[i]))
                addPixel(rays, i, few, pixels[i], to);
        }
        shade(to);
    }

  private:
    Rays follow(const std::vector<glm::ivec2>& pixels, int across) {
        const auto each = static_cast<std::size_t>(across * across);
        Rays rays;
        rays.rays.resize(each * pixels.size());
        rays.skipped.resize(rays.rays.size());
        rays.directions.resize(rays.rays.size());
        tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
            for (std::size_t k = 0; k < each; ++k) {
                const int part = static_cast<int>(k);
                const Ray ray = camera_.ray(pixels[i].x + (part % across + 0.5) / across,
                                            pixels[i].y + (static_cast<double>(part / across) + 0.5) / across);
                begin(ray, rays, i * each + k);
            }
        });
        rays.hits = tracer_.nearest(rays.rays, run_, check_);
        return rays;
    }

    /// A ray from where it enters the sphere around all meshes: floats have few digits far away.
    void begin(const Ray& ray, Rays& rays, std::size_t place) const {
        const glm::dvec3 from = ray.origin - scene_.world.middle;
        const double reach = 1.001 * static_cast<double>(scene_.world.reach());
        const double along = -glm::dot(from, ray.direction), away = glm::length(glm::cross(from, ray.direction));
        const double skipped = std::max(0.0, along - reach);
        double most = along + reach;
        if (ground_) most = std::min(most, distanceToGround(ray, *ground_).value_or(most));
        if (away > reach || most <= skipped) most = skipped - 1.0;
        rays.rays[place] = {glm::vec3(from + skipped * ray.direction), 0.0F, glm::vec3(ray.direction),
                            static_cast<float>(most - skipped),        -1,   -1};
        rays.skipped[place] = skipped;
        rays.directions[place] = ray.direction;
    }

    /// Whether the rays of a pixel and those of the pixels beside it meet different things.
    static bool differ(const Rays& rays, std::size_t pixel, const Tile& band) {
        constexpr std::size_t each = few * few;
        constexpr float step = 0.05F;  // of the distance
        const auto width = static_cast<std::size_t>(band.width);
        const std::size_t x = pixel % width, y = pixel / width;
        const shared::MeshHit& first = rays.hits[pixel * each];
        const float distance = rays.distance(pixel * each);
        const auto other = [&](std::size_t from) {
            for (std::size_t i = from * each; i < (from + 1) * each; ++i)
                if (rays.hits[i].instance != first.instance || std::abs(rays.distance(i) - distance) > step * distance)
                    return true;
            return false;
        };
        return other(pixel) || (x > 0 && other(pixel - 1)) || (x + 1 < width && other(pixel + 1)) ||
               (y > 0 && other(pixel - width)) ||
               (y + 1 < static_cast<std::size_t>(band.height) && other(pixel + width));
    }

    void addPixel(const Rays& rays, std::size_t pixel, int across, const glm::ivec2& at, MeshPixels& to) {
        const std::size_t place = to.index(at.x, at.y);
        const auto number = static_cast<std::uint32_t>(at.y * camera_.width + at.x);
        const auto each = static_cast<std::size_t>(across * across);
        std::vector<std::size_t> met;
        double distance = 0.0;
        for (std::size_t i = pixel * each; i < (pixel + 1) * each; ++i)
            if (rays.hits[i].instance >= 0) {
                met.push_back(i);
                distance += static_cast<double>(rays.distance(i));
            }
        if (met.empty()) return;
        shared::MeshPixel& seen = to.pixels[place];
        to.instance[place] = rays.hits[met[met.size() / 2]].instance;
        seen.distance = static_cast<float>(distance / static_cast<double>(met.size()));
        if (across == many) {
            seen.edge = static_cast<int>(to.edges.size() / each);
            for (std::size_t i = pixel * each; i < (pixel + 1) * each; ++i) to.edges.push_back(rays.distance(i));
        }
        for (std::size_t i = 0; i < met.size(); ++i) {
            const glm::dvec3& direction = rays.directions[met[i]];
            samples_.push_back({scene_.at(rays.hits[met[i]], direction), -direction, number,
                                static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(met.size()), directions_});
            places_.push_back(place);
        }
    }

    void shade(MeshPixels& to) {
        const std::vector<glm::dvec3> radiance = shading_.shade(samples_, run_, check_);
        std::size_t i = 0;
        while (i < places_.size()) {
            const std::size_t place = places_[i];
            glm::dvec3 sum(0.0);
            std::size_t count = 0;
            for (; i < places_.size() && places_[i] == place; ++i, ++count) sum += radiance[i];
            to.pixels[place].radiance = glm::vec3(sum / static_cast<double>(count));
        }
        samples_.clear();
        places_.clear();
    }

    const Camera& camera_;
    std::optional<double> ground_;
    const MeshScene& scene_;
    RayTracer& tracer_;
    MeshShading& shading_;
    std::uint32_t directions_;
    const RunGpu& run_;
    const Check& check_;
    std::vector<MeshSample> samples_;
    std::vector<std::size_t> places_;  ///< of the samples' pixels
};

Tile shownPart(const MeshPixels& meshes) {
    glm::ivec2 lower(std::numeric_limits<int>::max()), upper(std::numeric_limits<int>::lowest());
    for (int y = meshes.tile.y; y < meshes.tile.y + meshes.tile.height; ++y)
        for (int x = meshes.tile.x; x < meshes.tile.x + meshes.tile.width; ++x) {
            if (meshes.instance[meshes.index(x, y)] < 0) continue;
            lower = glm::min(lower, glm::ivec2(x, y));
            upper = glm::max(upper, glm::ivec2(x, y));
        }
    if (lower.x > upper.x) return {meshes.tile.x, meshes.tile.y, 0, 0};
    return {lower.x, lower.y, upper.x - lower.x + 1, upper.y - lower.y + 1};
}

/// A pixel with this share of rays that meet a mesh.
shared::Pixel pixelOf(const shared::MeshPixel& seen, float share, float front, const glm::vec3& sky) {
    shared::Pixel pixel{};
    pixel.cloud = share * seen.radiance;
    pixel.transmittance = 1.0F - share;
    pixel.alpha = share;
    pixel.depth = share > 0.0F ? seen.distance : shared::FAR_DEPTH;
    pixel.front = front;
    pixel.radiance = pixel.cloud + (1.0F - share) * sky;
    return pixel;
}

}  // namespace

MeshPixels MeshPixels::part(const Tile& wanted) const {
    constexpr std::size_t each = many * many;
    MeshPixels result;
    result.tile = wanted;
    for (int y = wanted.y; y < wanted.y + wanted.height; ++y)
        for (int x = wanted.x; x < wanted.x + wanted.width; ++x) {
            result.pixels.push_back(pixels[index(x, y)]);
            int& edge = result.pixels.back().edge;
            if (edge < 0) continue;
            const auto first = edges.begin() + static_cast<std::ptrdiff_t>(each) * edge;
            edge = static_cast<int>(result.edges.size() / each);
            result.edges.insert(result.edges.end(), first, first + each);
        }
    return result;
}

MeshPixels drawMeshes(const Camera& camera, const Tile& tile, std::optional<double> ground, const MeshScene& scene,
                      RayTracer& tracer, MeshShading& shading, std::uint32_t directions, const RunGpu& run,
                      const Check& check) {
    const std::size_t count = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
    MeshPixels result;
    result.tile = tile;
    result.instance.assign(count, -1);
    result.pixels.assign(count, {glm::vec3(0.0F), shared::FAR_DEPTH, -1});
    Painting painting(camera, ground, scene, tracer, shading, directions, run, check);
    const int rows = std::max(1, bandPixels / tile.width);
    for (int y = 0; y < tile.height; y += rows) {
        check();
        painting.drawBand({tile.x, tile.y + y, tile.width, std::min(rows, tile.height - y)}, result);
    }
    result.shown = shownPart(result);
    for (const shared::MeshPixel& pixel : result.pixels) {
        if (pixel.distance >= shared::FAR_DEPTH) continue;
        result.nearest = std::min(result.nearest, pixel.distance);
        result.farthest = std::max(result.farthest, pixel.distance);
    }
    return result;
}

std::vector<shared::Pixel> pixelsOf(const MeshPixels& meshes, const Tile& part, const glm::vec3& sky) {
    constexpr std::size_t each = many * many;
    std::vector<shared::Pixel> pixels;
    for (int y = part.y; y < part.y + part.height; ++y)
        for (int x = part.x; x < part.x + part.width; ++x) {
            const shared::MeshPixel& seen = meshes.pixels[meshes.index(x, y)];
            float share = seen.distance < shared::FAR_DEPTH ? 1.0F : 0.0F, front = seen.distance;
            if (seen.edge >= 0) {
                const auto first = meshes.edges.begin() + static_cast<std::ptrdiff_t>(each) * seen.edge;
                const auto met = std::count_if(first, first + each, [](float d) { return d < shared::FAR_DEPTH; });
                share = static_cast<float>(met) / static_cast<float>(each);
                front = *std::min_element(first, first + each);
            }
            pixels.push_back(pixelOf(seen, share, front, sky));
        }
    return pixels;
}

void addMeshIds(LayeredImage& image, const MeshPixels& meshes, const Tile& part) {
    std::vector<float>& ids = image.layers["mesh.id"];
    ids.clear();
    for (int y = part.y; y < part.y + part.height; ++y)
        for (int x = part.x; x < part.x + part.width; ++x)
            ids.push_back(static_cast<float>(meshes.instance[meshes.index(x, y)] + 1));
}

}  // namespace lumulus::surface
