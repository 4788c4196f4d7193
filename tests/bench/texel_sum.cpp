#include "bench/texel_sum.h"

#include <ImfEnvmap.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sky/environment.h"

namespace lumulus::bench {

namespace {

struct Texel {
    glm::vec3 towards, radiance;
    float solidAngle = 0.0F;
};

}  // namespace

std::vector<glm::vec3> texelSum(const prefilter::Panorama& panorama, double alpha,
                                std::span<const glm::vec3> directions) {
    std::vector<Texel> texels;
    for (int y = 0; y < panorama.height; ++y)
        for (int x = 0; x < panorama.width; ++x)
            texels.push_back({glm::vec3(panorama.direction(x + 0.5, y + 0.5)),
                              panorama.pixels[static_cast<std::size_t>(y * panorama.width + x)],
                              static_cast<float>(panorama.solidAngle(y))});
    std::vector<glm::vec3> values(directions.size());
    const auto a2 = static_cast<float>(alpha * alpha);
    tbb::parallel_for(std::size_t{0}, directions.size(), [&](std::size_t i) {
        const float nx = directions[i].x, ny = directions[i].y, nz = directions[i].z;
        double r = 0.0, g = 0.0, b = 0.0, sum = 0.0;
        for (const Texel& t : texels) {
            const float c = nx * t.towards.x + ny * t.towards.y + nz * t.towards.z;
            if (c <= 0.0F) continue;
            // n·h of the middle between normal and light is √((1 + c) / 2); D is 1 / (1 − (1 − α²) (n·h)²)² but for a
            // factor, and D / 4 the density of the light; 1 − (n·h)² by the chord, for directions that are close
            const float dx = nx - t.towards.x, dy = ny - t.towards.y, dz = nz - t.towards.z;
            const float sine2 = 0.25F * (dx * dx + dy * dy + dz * dz);
            const float rest = sine2 + a2 * (1.0F - sine2);
            const float weight = c * t.solidAngle / (rest * rest);
            r += weight * t.radiance.x;
            g += weight * t.radiance.y;
            b += weight * t.radiance.z;
            sum += weight;
        }
        values[i] = glm::vec3(glm::dvec3(r, g, b) / sum);
    });
    return values;
}

prefilter::Panorama reduced(const prefilter::Panorama& panorama, int times) {
    prefilter::Panorama result{panorama.width / times, panorama.height / times, {}};
    for (int y = 0; y < result.height; ++y)
        for (int x = 0; x < result.width; ++x) {
            glm::dvec3 sum(0.0);
            double angles = 0.0;
            for (int i = 0; i < times * times; ++i) {
                const int row = times * y + i / times;
                const double angle = panorama.solidAngle(row);
                sum +=
                    angle *
                    glm::dvec3(panorama.pixels[static_cast<std::size_t>(row * panorama.width + times * x + i % times)]);
                angles += angle;
            }
            result.pixels.emplace_back(sum / angles);
        }
    return result;
}

double relativeError(std::span<const glm::vec3> values, std::span<const glm::vec3> truth) {
    double errors = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const glm::dvec3 difference = glm::dvec3(values[i]) - glm::dvec3(truth[i]);
        errors += glm::dot(difference, difference);
        squares += glm::dot(glm::dvec3(truth[i]), glm::dvec3(truth[i]));
    }
    return std::sqrt(errors / squares);
}

glm::vec3 readCube(std::span<const glm::vec3> pixels, int size, const glm::vec3& direction) {
    const Imath::Box2i window({0, 0}, {size - 1, 6 * size - 1});
    Imf::CubeMapFace face{};
    Imath::V2f place;
    Imf::CubeMap::faceAndPixelPosition({direction.x, direction.y, direction.z}, window, face, place);
    const auto lower = [size](float p) { return std::clamp(static_cast<int>(p), 0, std::max(0, size - 2)); };
    const int x = lower(place.x), y = lower(place.y);
    const auto at = [&](int i, int j) {
        const Imath::V2f inFace(static_cast<float>(std::min(i, size - 1)), static_cast<float>(std::min(j, size - 1)));
        const Imath::V2f pixel = Imf::CubeMap::pixelPosition(face, window, inFace);
        return pixels[static_cast<std::size_t>(std::lround(pixel.y) * size + std::lround(pixel.x))];
    };
    const float right = place.x - static_cast<float>(x), down = place.y - static_cast<float>(y);
    return glm::mix(glm::mix(at(x, y), at(x + 1, y), right), glm::mix(at(x, y + 1), at(x + 1, y + 1), right), down);
}

std::vector<glm::vec3> evenDirections(int count) {
    std::vector<glm::vec3> directions;
    for (int i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * i + 1.0) / count, s = std::sqrt(1.0 - y * y);
        const double angle = 2.0 * std::numbers::pi * i / std::numbers::phi;
        directions.emplace_back(s * std::cos(angle), y, s * std::sin(angle));
    }
    return directions;
}

prefilter::Panorama clearSky(double elevation, int height) {
    scene::Sky sky;
    sky.model = scene::SkyModel::atmosphere;
    scene::Sun sun;
    sun.directionTo = scene::skyDirection(120.0, elevation);
    const sky::Environment environment(sky, scene::Ground{});
    prefilter::Panorama panorama{2 * height, height, {}};
    panorama.pixels.resize(static_cast<std::size_t>(2 * height * height));
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < 2 * height; ++x)
            panorama.pixels[static_cast<std::size_t>(y * 2 * height + x)] =
                glm::vec3(environment.radiance({0.0, 2.0, 0.0}, panorama.direction(x + 0.5, y + 0.5), sun));
    });
    return panorama;
}

}  // namespace lumulus::bench
