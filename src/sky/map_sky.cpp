#include "sky/map_sky.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/exr.h"

namespace lumulus::sky {

using std::numbers::pi;

namespace {

double luminanceOf(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

[[noreturn]] void refuse(const scene::Sky& sky, const std::string& what, const char* mend) {
    throw InputError(fmt::format("{}: {}", sky.map.string(), what), "sky.map", mend);
}

/// The picture of a file, with the factor of the scene.
LatLong readMap(const scene::Sky& sky) {
    if (sky.map.empty()) throw InputError("the sky has no map", "sky.map", "give an EXR file");
    LayeredImage image;
    try {
        image = readExr(sky.map);
    } catch (const InputError& error) {
        throw InputError(fmt::format("the map of the sky cannot be read: {}", error.what()), "sky.map",
                         "give the EXR file of a latitude-longitude picture");
    }
    if (image.width != 2 * image.height)
        refuse(sky, fmt::format("the map has {} × {} pixels", image.width, image.height),
               "give a latitude-longitude picture, twice as wide as high");
    LatLong map{image.width, image.height, std::vector<glm::vec3>(image.pixels())};
    float most = 0.0F;
    for (int channel = 0; channel < 3; ++channel) {
        const std::string name(1, "RGB"[channel]);
        const auto layer = image.layers.find(name);
        if (layer == image.layers.end())
            refuse(sky, "the map has no channel " + name, "give an EXR file with R, G and B");
        for (std::size_t i = 0; i < map.pixels.size(); ++i) {
            const float value = static_cast<float>(sky.mapScale) * layer->second[i];
            if (!std::isfinite(value) || value < 0.0F)
                refuse(sky,
                       fmt::format("the map holds {} at pixel ({}, {})", value, i % static_cast<std::size_t>(map.width),
                                   i / static_cast<std::size_t>(map.width)),
                       "give finite radiances of 0 or more");
            map.pixels[i][channel] = value;
            most = std::max(most, value);
        }
    }
    if (!(most > 0.0F)) refuse(sky, "the map is black", "give a map with light, or sky.model = \"constant\"");
    return map;
}

/// How much of each pixel of a row or column falls into pixel `i` of `count`, of what `measure` counts.
template <class Measure>
void overlaps(int i, int count, int source, const Measure& measure, const auto& add) {
    const double first = static_cast<double>(i) * source / count, end = static_cast<double>(i + 1) * source / count;
    for (int at = static_cast<int>(first); at < source && at < end; ++at)
        add(at, measure(std::max<double>(at, first), std::min<double>(at + 1, end)));
}

}  // namespace

double LatLong::solidAngle(int y) const {
    return 2.0 * pi / width * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
}

LatLong reduced(const LatLong& map, int width) {
    LatLong less{width, width / 2, std::vector<glm::vec3>(static_cast<std::size_t>(width) * (width / 2))};
    tbb::parallel_for(0, less.height, [&](int y) {
        std::vector<glm::dvec3> row(static_cast<std::size_t>(map.width), glm::dvec3(0.0));
        const auto solid = [&](double from, double to) {
            return std::cos(pi * from / map.height) - std::cos(pi * to / map.height);
        };
        double whole = 0.0;
        overlaps(y, less.height, map.height, solid, [&](int at, double share) {
            for (int x = 0; x < map.width; ++x) row[static_cast<std::size_t>(x)] += share * glm::dvec3(map.at(x, at));
            whole += share;
        });
        const auto length = [](double from, double to) { return to - from; };
        for (int x = 0; x < width; ++x) {
            glm::dvec3 sum(0.0);
            overlaps(x, width, map.width, length,
                     [&](int at, double share) { sum += share * row[static_cast<std::size_t>(at)]; });
            less.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
                glm::vec3(sum / whole * (static_cast<double>(width) / map.width));
        }
    });
    return less;
}

MapSky::MapSky(const scene::Sky& sky) : pixels_(readMap(sky)), rotation_(glm::radians(sky.mapRotation)) {
    if (sky.mapSun) takeOutSun();
    for (int y = 0; y < pixels_.height; ++y)
        for (int x = 0; x < pixels_.width; ++x)
            mean_ += glm::dvec3(pixels_.at(x, y)) * (pixels_.solidAngle(y) / (4.0 * pi));
}

glm::dvec3 MapSky::directionOf(const glm::dvec2& place) const {
    const double turn = 2.0 * pi * place.x / pixels_.width, down = pi * place.y / pixels_.height;
    return axes() * glm::dvec3(std::sin(down) * std::cos(turn), std::cos(down), std::sin(down) * std::sin(turn));
}

glm::dmat3 MapSky::axes() const {
    const double sine = std::sin(rotation_), cosine = std::cos(rotation_);
    return {glm::dvec3(-sine, 0.0, cosine), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(-cosine, 0.0, -sine)};
}

void MapSky::takeOutSun() {
    const auto brighter = [](const glm::vec3& a, const glm::vec3& b) { return luminanceOf(a) < luminanceOf(b); };
    const auto index = static_cast<int>(std::ranges::max_element(pixels_.pixels, brighter) - pixels_.pixels.begin());
    const glm::ivec2 brightest(index % pixels_.width, index / pixels_.width);
    const double peak = luminanceOf(pixels_.at(brightest.x, brightest.y));
    const glm::dvec3 middle = directionOf(glm::dvec2(brightest) + 0.5);
    const double spotCosine = std::cos(glm::radians(5.0)), ringCosine = std::cos(glm::radians(10.0));
    glm::dvec3 ring(0.0);
    double ringAngle = 0.0;
    std::vector<glm::ivec2> spot;
    const int rows = pixels_.height / 18 + 2;
    for (int y = std::max(0, brightest.y - rows); y < std::min(pixels_.height, brightest.y + rows + 1); ++y)
        for (int x = 0; x < pixels_.width; ++x) {
            const double cosine = glm::dot(directionOf(glm::dvec2(x, y) + 0.5), middle);
            if (cosine < ringCosine) continue;
            if (cosine >= spotCosine) {
                if (luminanceOf(pixels_.at(x, y)) >= 0.1 * peak) spot.emplace_back(x, y);
                continue;
            }
            ring += glm::dvec3(pixels_.at(x, y)) * pixels_.solidAngle(y);
            ringAngle += pixels_.solidAngle(y);
        }
    if (!(ringAngle > 0.0) || peak < 50.0 * luminanceOf(ring / ringAngle)) return;
    ring /= ringAngle;
    glm::dvec3 flux(0.0), towards(0.0);
    double angle = 0.0;
    for (const glm::ivec2& p : spot) {
        glm::vec3& pixel = pixels_.pixels[static_cast<std::size_t>(p.y) * static_cast<std::size_t>(pixels_.width) +
                                          static_cast<std::size_t>(p.x)];
        const glm::dvec3 more = glm::max(glm::dvec3(pixel) - ring, glm::dvec3(0.0)) * pixels_.solidAngle(p.y);
        flux += more;
        towards += luminanceOf(more) * directionOf(glm::dvec2(p) + 0.5);
        angle += pixels_.solidAngle(p.y);
        pixel = glm::vec3(ring);
    }
    const double radius = std::acos(1.0 - angle / (2.0 * pi));
    sun_.emplace();
    sun_->directionTo = glm::normalize(towards);
    sun_->angularDiameter = glm::degrees(2.0 * radius);
    // a disc of one radiance has flux · π sin² r / Ω on a plane that faces it
    sun_->irradiance = flux * (pi * std::pow(std::sin(radius), 2) / angle);
}

glm::dvec3 MapSky::radiance(const glm::dvec3& direction) const {
    const glm::dvec3 local = glm::transpose(axes()) * direction;
    const double turn = std::atan2(local.z, local.x) / (2.0 * pi);
    const double x = (turn - std::floor(turn)) * pixels_.width - 0.5;
    const double y = std::acos(std::clamp(local.y, -1.0, 1.0)) / pi * pixels_.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto column = [&](int step) { return (static_cast<int>(left) + step + pixels_.width) % pixels_.width; };
    const auto row = [&](int step) { return std::clamp(static_cast<int>(top) + step, 0, pixels_.height - 1); };
    const auto at = [&](int across, int down) { return glm::dvec3(pixels_.at(column(across), row(down))); };
    const double right = x - left, lower = y - top;
    return (1.0 - lower) * ((1.0 - right) * at(0, 0) + right * at(1, 0)) +
           lower * ((1.0 - right) * at(0, 1) + right * at(1, 1));
}

glm::dvec3 MapSky::irradiance(const glm::dvec3& normal) const {
    glm::dvec3 sum(0.0);
    for (int y = 0; y < pixels_.height; ++y)
        for (int x = 0; x < pixels_.width; ++x)
            sum += glm::dvec3(pixels_.at(x, y)) *
                   (pixels_.solidAngle(y) * std::max(0.0, glm::dot(normal, directionOf(glm::dvec2(x, y) + 0.5))));
    return sum;
}

LatLong MapSky::cells(int width) const {
    if (pixels_.width > width) return reduced(pixels_, width);
    const int times = (width + pixels_.width - 1) / pixels_.width;
    LatLong finer{times * pixels_.width, times * pixels_.height, {}};
    finer.pixels.reserve(static_cast<std::size_t>(finer.width) * static_cast<std::size_t>(finer.height));
    for (int y = 0; y < finer.height; ++y)
        for (int x = 0; x < finer.width; ++x)
            finer.pixels.emplace_back(radiance(directionOf((glm::dvec2(x, y) + 0.5) / static_cast<double>(times))));
    return finer;
}

}  // namespace lumulus::sky
