#include "frame/sun_disc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "frame/sun_cover.h"
#include "frame/view_params.h"
#include "sky/sun_reach.h"

namespace lumulus::frame {

namespace {

/// A ray counts as one that the ground ends where it goes below the horizon.
constexpr double aRay = 1e-9;

/// Share of the disc's light that the air lets through in a direction, by channel; 0 where the ground is in front.
glm::dvec3 passed(const sky::Atmosphere& air, const glm::dvec3& eye, const glm::dvec3& direction) {
    const sky::AirPoint ray = air.at(eye, direction, direction);
    const sky::Spectrum through = sky::sunTransmittance(air.air(), air.columns(), ray.height, ray.up, aRay);
    return glm::max(air.air().rgb(through), glm::dvec3(0.0)) / air.sunAbove();
}

/// What the disc's radiance in a pixel is against that of a disc which is the same all over, above the air: the mean
/// over the pixel's part of it.
class Disc {
  public:
    Disc(const Camera& camera, const scene::Sun& sun, const sky::Atmosphere* air, double radius)
        : camera_(camera), sun_(sun), air_(air), radius_(radius) {
        const double pixel = pixelLength(camera, camera.position + sun.directionTo);
        resolved_ = camera.projection != scene::Projection::orthographic && radius > pixel;
    }

    glm::dvec3 factor(const glm::ivec2& pixel) const {
        if (!air_ && !sun_.limbDarkening) return glm::dvec3(1.0);
        // where pixels are larger than the disc, they see all of it
        if (!resolved_) return air_ ? air_->sunColour(camera_.position, sun_.directionTo) : glm::dvec3(1.0);
        constexpr int across = 6;
        glm::dvec3 sum(0.0);
        int inside = 0;
        for (int i = 0; i < across * across; ++i) {
            const glm::dvec3 direction = camera_
                                             .ray(pixel.x + (i % across + 0.5) / across,
                                                  pixel.y + (static_cast<double>(i / across) + 0.5) / across)
                                             .direction;
            const double away = glm::length(glm::cross(direction, sun_.directionTo)) / std::sin(radius_);
            if (away >= 1.0) continue;
            ++inside;
            const double limb = sun_.limbDarkening ? limbDarkening(away) : 1.0;
            sum += limb * (air_ ? passed(*air_, camera_.position, direction) : glm::dvec3(1.0));
        }
        return inside > 0 ? sum / static_cast<double>(inside) : rim();
    }

  private:
    /// Where a pixel has so little of the disc that no ray meets it.
    glm::dvec3 rim() const {
        return (sun_.limbDarkening ? limbDarkening(1.0) : 1.0) *
               (air_ ? passed(*air_, camera_.position, sun_.directionTo) : glm::dvec3(1.0));
    }

    const Camera& camera_;
    const scene::Sun& sun_;
    const sky::Atmosphere* air_;
    double radius_;
    bool resolved_;
};

}  // namespace

double limbDarkening(double place) {
    const double c = std::sqrt(std::max(0.0, 1.0 - place * place));
    return (0.3 + 0.93 * c - 0.23 * c * c) / 0.805;
}

std::vector<shared::SunPixel> sunPixels(const Camera& camera, const Tile& tile, const scene::Sun& sun,
                                        const sky::Atmosphere* air) {
    const double radius = 0.5 * sun.angularDiameter * std::numbers::pi / 180.0;
    const double disc = std::numbers::pi * std::pow(std::sin(radius), 2);
    std::vector<shared::SunPixel> pixels;
    if (!(disc > 0.0) || sun.irradiance == glm::dvec3(0.0)) return pixels;
    const Disc seen(camera, sun, air, radius);
    for (const CoveredPixel& covered : sunCover(camera, tile, sun.directionTo, radius)) {
        const glm::dvec3 radiance = covered.share * sun.irradiance / disc * seen.factor(covered.pixel);
        if (radiance == glm::dvec3(0.0)) continue;
        pixels.push_back({covered.pixel - glm::ivec2(tile.x, tile.y), glm::vec3(radiance)});
    }
    return pixels;
}

}  // namespace lumulus::frame
