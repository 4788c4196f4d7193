#include "reference/sky_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/error.h"
#include "base/exr.h"
#include "reference/sun_disc.h"

namespace lumulus::reference {
namespace {

constexpr double pi = glm::pi<double>();
constexpr double spotRadius = glm::radians(5.0), ringRadius = glm::radians(10.0);
constexpr double spotShare = 0.1;       ///< of the peak's luminance, from which on a pixel belongs to the spot
constexpr double leastContrast = 50.0;  ///< of the peak over the ring

double luminanceOf(const glm::dvec3& rgb) {
    return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

[[noreturn]] void refuse(const scene::Sky& sky, const std::string& what, const std::string& mend) {
    throw InputError(fmt::format("{}: {}", sky.map.string(), what), "sky.map", mend);
}

LayeredImage readMap(const scene::Sky& sky) {
    if (sky.map.empty()) throw InputError("the sky has no map", "sky.map", "give an EXR file");
    try {
        return readExr(sky.map);
    } catch (const InputError& error) {
        throw InputError(fmt::format("the map of the sky cannot be read: {}", error.what()), "sky.map",
                         "give the EXR file of a latitude-longitude picture");
    }
}

std::vector<glm::vec3> pixelsOf(const LayeredImage& image, const scene::Sky& sky) {
    for (const char* name : {"R", "G", "B"}) {
        if (!image.layers.contains(name)) {
            refuse(sky, fmt::format("the map has no channel {}", name), "give an EXR file with R, G and B");
        }
    }
    if (image.width != 2 * image.height) {
        refuse(sky, fmt::format("the map has {} × {} pixels", image.width, image.height),
               "give a latitude-longitude picture, twice as wide as high");
    }
    const auto &red = image.layers.at("R"), &green = image.layers.at("G"), &blue = image.layers.at("B");
    std::vector<glm::vec3> pixels(image.pixels());
    const auto scale = static_cast<float>(sky.mapScale);
    bool lit = false;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = scale * glm::vec3(red[i], green[i], blue[i]);
        for (int c = 0; c < 3; ++c) {
            if (std::isfinite(pixels[i][c]) && pixels[i][c] >= 0.0F) continue;
            refuse(sky,
                   fmt::format("the map holds {} at pixel ({}, {})", pixels[i][c],
                               i % static_cast<std::size_t>(image.width), i / static_cast<std::size_t>(image.width)),
                   "give finite radiances of 0 or more");
        }
        lit = lit || pixels[i] != glm::vec3(0.0F);
    }
    if (!lit) refuse(sky, "the map is black", "give a map with light, or sky.model = \"constant\"");
    return pixels;
}

}  // namespace

SkyMap::SkyMap(const scene::Sky& sky) : rotation_(glm::radians(sky.mapRotation)) {
    const LayeredImage image = readMap(sky);
    pixels_ = pixelsOf(image, sky);
    width_ = image.width;
    height_ = image.height;
    if (sky.mapSun) takeOutSun();
    weigh();
}

glm::dvec2 SkyMap::placeOf(const glm::dvec3& direction) const {
    const double azimuth = std::atan2(direction.x, -direction.z) - rotation_;
    const double turns = 0.5 + azimuth / (2.0 * pi);
    const double down = std::acos(std::clamp(direction.y, -1.0, 1.0)) / pi;
    return {(turns - std::floor(turns)) * width_, down * height_};
}

glm::dvec3 SkyMap::directionOf(const glm::dvec2& place) const {
    const double azimuth = (place.x / width_ - 0.5) * 2.0 * pi + rotation_, down = place.y / height_ * pi;
    return {std::sin(down) * std::sin(azimuth), std::cos(down), -std::sin(down) * std::cos(azimuth)};
}

/// Of a pixel in the row y.
double SkyMap::solidAngle(int y) const {
    return 2.0 * pi / width_ * (std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_));
}

void SkyMap::takeOutSun() {
    const auto brightest = std::ranges::max_element(pixels_, {}, [](const glm::vec3& p) { return luminanceOf(p); });
    const auto peakIndex = static_cast<int>(brightest - pixels_.begin());
    const double peak = luminanceOf(*brightest);
    const glm::dvec3 middle = directionOf(glm::dvec2(peakIndex % width_, peakIndex / width_) + 0.5);
    glm::dvec3 ring(0.0);
    double ringAngle = 0.0;
    std::vector<glm::ivec2> spot;
    const double rows = ringRadius / pi * height_ + 1.0;
    const int first = std::max(0, static_cast<int>(peakIndex / width_ - rows));
    const int end = std::min(height_, static_cast<int>(peakIndex / width_ + rows) + 1);
    for (int y = first; y < end; ++y)
        for (int x = 0; x < width_; ++x) {
            const double cosine = glm::dot(directionOf(glm::dvec2(x, y) + 0.5), middle);
            const glm::dvec3 value = pixels_[indexOf(x, y)];
            if (cosine < std::cos(ringRadius)) continue;
            if (cosine < std::cos(spotRadius)) {
                ring += solidAngle(y) * value;
                ringAngle += solidAngle(y);
            } else if (luminanceOf(value) >= spotShare * peak) {
                spot.emplace_back(x, y);
            }
        }
    if (!(ringAngle > 0.0) || luminanceOf(ring) * leastContrast > peak * ringAngle) return;
    ring /= ringAngle;
    glm::dvec3 fluence(0.0), direction(0.0);
    double angle = 0.0;
    for (const glm::ivec2& p : spot) {
        const glm::dvec3 excess = glm::max(glm::dvec3(pixels_[indexOf(p.x, p.y)]) - ring, 0.0) * solidAngle(p.y);
        fluence += excess;
        direction += luminanceOf(excess) * directionOf(glm::dvec2(p) + 0.5);
        angle += solidAngle(p.y);
        pixels_[indexOf(p.x, p.y)] = ring;
    }
    scene::Sun sun;
    sun.directionTo = glm::normalize(direction);
    sun.angularDiameter = glm::degrees(2.0 * std::acos(1.0 - angle / (2.0 * pi)));
    sun.irradiance = fluence / SunDisc(sun).fluence();
    sun_ = sun;
}

/// A pixel weighs as much as the brightest of those that it is interpolated from.
void SkyMap::weigh() {
    cumulative_.reserve(pixels_.size());
    double sum = 0.0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            double weight = 0.0;
            for (int row = std::max(0, y - 1); row <= std::min(height_ - 1, y + 1); ++row)
                for (int step = -1; step <= 1; ++step) {
                    const glm::vec3& p = pixels_[indexOf((x + step + width_) % width_, row)];
                    weight = std::max(weight, static_cast<double>(p.x + p.y + p.z));
                }
            sum += weight * solidAngle(y);
            cumulative_.push_back(sum);
        }
}

glm::dvec3 SkyMap::radiance(const glm::dvec3& direction) const {
    const glm::dvec2 place = placeOf(direction) - 0.5;
    const double left = std::floor(place.x), top = std::floor(place.y);
    const glm::dvec2 share(place.x - left, place.y - top);
    const int x0 = (static_cast<int>(left) + width_) % width_, x1 = (x0 + 1) % width_;
    const int y0 = std::clamp(static_cast<int>(top), 0, height_ - 1);
    const int y1 = std::clamp(static_cast<int>(top) + 1, 0, height_ - 1);
    const auto at = [&](int x, int y) { return glm::dvec3(pixels_[indexOf(x, y)]); };
    return glm::mix(glm::mix(at(x0, y0), at(x1, y0), share.x), glm::mix(at(x0, y1), at(x1, y1), share.x), share.y);
}

SkyMapSample SkyMap::sample(Random& random) const {
    const auto found = std::ranges::upper_bound(cumulative_, random.uniform() * cumulative_.back());
    const auto index = static_cast<int>(std::min(found, cumulative_.end() - 1) - cumulative_.begin());
    const int x = index % width_, y = index / width_;
    // all points of the pixel equally likely by solid angle
    const double high = std::cos(pi * y / height_), low = std::cos(pi * (y + 1) / height_);
    const double cosine = std::clamp(high + (low - high) * random.uniform(), -1.0, 1.0);
    const glm::dvec3 direction = directionOf({x + random.uniform(), std::acos(cosine) / pi * height_});
    return {direction, density(direction)};
}

double SkyMap::density(const glm::dvec3& direction) const {
    const glm::dvec2 place = placeOf(direction);
    const int x = std::min(static_cast<int>(place.x), width_ - 1), y = std::min(static_cast<int>(place.y), height_ - 1);
    const std::size_t index = indexOf(x, y);
    const double weight = cumulative_[index] - (index > 0 ? cumulative_[index - 1] : 0.0);
    return weight / (cumulative_.back() * solidAngle(y));
}

}  // namespace lumulus::reference
