#include "reference/picture_correction.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "reference/difference_filter.h"

namespace lumulus::reference {
namespace {

using Clock = std::chrono::steady_clock;

/// Added to the seed, so that no path is one of Renderer's or of those that measure the error.
constexpr std::uint64_t ownSeed = 0x636F7272656374ULL;
constexpr std::uint64_t pathsOfRound = 2;
constexpr std::array<const char*, 3> channels{"R", "G", "B"};

/// Three layers with this prefix.
class Colours {
  public:
    Colours(LayeredImage& image, const std::string& prefix) {
        for (std::size_t c = 0; c < 3; ++c) layers_[c] = &image.layers.at(prefix + channels[c]);
    }
    glm::vec3 operator[](std::size_t pixel) const {
        return {(*layers_[0])[pixel], (*layers_[1])[pixel], (*layers_[2])[pixel]};
    }
    void add(std::size_t pixel, const glm::vec3& more) {
        for (int c = 0; c < 3; ++c) (*layers_[static_cast<std::size_t>(c)])[pixel] += more[c];
    }

  private:
    std::array<std::vector<float>*, 3> layers_{};
};

/// Light of the cloud in a pixel, with fog all of its light. Where there is little, a share of the mean of all pixels
/// is added as far as the pixel is opaque: what the picture has of it may be wrong by any factor.
std::vector<glm::vec3> lightOf(LayeredImage& picture, const std::vector<std::size_t>& pixels,
                               const std::vector<float>& opacity, bool foggy) {
    constexpr float least = 0.3F;
    const Colours cloud(picture, !foggy && picture.layers.contains("cloud.R") ? "cloud." : "");
    glm::dvec3 sum(0.0);
    for (const std::size_t pixel : pixels) sum += glm::dvec3(glm::max(cloud[pixel], glm::vec3(0.0F)));
    const glm::vec3 mean = sum / static_cast<double>(std::max<std::size_t>(1, pixels.size()));
    std::vector<glm::vec3> light(picture.pixels(), glm::vec3(0.0F));
    for (const std::size_t pixel : pixels)
        light[pixel] = glm::max(cloud[pixel], glm::vec3(0.0F)) + least * opacity[pixel] * mean;
    return light;
}

/// The paths of all pixels.
class Film {
  public:
    Film(const PixelPaths& paths, std::vector<std::size_t> pixels, std::uint64_t seed)
        : paths_(paths), pixels_(std::move(pixels)), seed_(seed + ownSeed), sums_(pixels_.size()) {}

    std::uint64_t pathsOfARound() const { return pathsOfRound * pixels_.size(); }
    std::uint64_t events() const { return events_; }
    const std::vector<std::size_t>& pixels() const { return pixels_; }

    void round(const PathProgress& progress) {
        const std::size_t some = paths_.hazy() ? 1024 : 8192;
        for (std::size_t begin = 0; begin < pixels_.size(); begin += some) {
            const std::size_t end = std::min(begin + some, pixels_.size());
            tbb::parallel_for(begin, end, [this](std::size_t i) { trace(i); });
            progress(static_cast<double>(end) / static_cast<double>(pixels_.size()));
        }
        each_ += pathsOfRound;
    }

    DifferenceMap mapOf(LayeredImage& picture, const std::vector<float>& opacity) const {
        DifferenceMap map;
        map.width = picture.width;
        map.height = picture.height;
        map.counted.assign(picture.pixels(), 0.0F);
        map.variance = map.counted;
        map.difference.assign(picture.pixels(), glm::vec3(0.0F));
        map.light = lightOf(picture, pixels_, opacity, paths_.foggy());
        const Colours shown(picture, "");
        const auto m = static_cast<double>(each_);
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            const std::size_t pixel = pixels_[i];
            const glm::dvec3 seen = sums_[i].radiance / m;
            const double mean = (seen.x + seen.y + seen.z) / 3.0;
            map.counted[pixel] = 1.0F;
            map.difference[pixel] = glm::vec3(seen - glm::dvec3(shown[pixel]));
            map.variance[pixel] = static_cast<float>(std::max(0.0, sums_[i].square / m - mean * mean) / (m - 1.0));
        }
        return map;
    }

    Correction told() const {
        Correction told;
        told.pixels = pixels_.size();
        told.paths = each_ * pixels_.size();
        told.events = events_;
        double light = 0.0, square = 0.0;
        for (const Sums& sums : sums_) {
            told.lost += static_cast<std::uint64_t>(sums.lost);
            light += (sums.radiance.x + sums.radiance.y + sums.radiance.z) / 3.0;
            square += sums.square;
        }
        if (square > 0.0) told.evenness = light * light / square / static_cast<double>(told.paths);
        return told;
    }

  private:
    struct Sums {
        glm::dvec3 radiance{0.0};
        double square = 0.0;  ///< of the mean of the channels
        int lost = 0;
    };

    void trace(std::size_t i) {
        std::uint64_t events = 0;
        for (std::uint64_t k = 0; k < pathsOfRound; ++k) {
            Random random(seed_, pixels_[i] + 1, each_ + k);
            const PixelSample sample = paths_.trace(pixels_[i], random);
            const double mean = (sample.radiance.x + sample.radiance.y + sample.radiance.z) / 3.0;
            sums_[i].radiance += sample.radiance;
            sums_[i].square += mean * mean;
            sums_[i].lost += sample.lost ? 1 : 0;
            events += static_cast<std::uint64_t>(sample.events);
        }
        events_ += events;
    }

    const PixelPaths& paths_;
    std::vector<std::size_t> pixels_;
    std::uint64_t seed_;
    std::vector<Sums> sums_;
    std::uint64_t each_ = 0;  ///< paths of each pixel
    std::atomic<std::uint64_t> events_ = 0;
};

/// Traces as many paths as were asked for.
void trace(Film& film, const CorrectionOrder& order, const std::function<double()>& seconds,
           const PathProgress& progress) {
    if (order.paths == 0) {
        double took = 0.0;  // of the round before
        do {
            const double before = seconds();
            film.round([&](double) { progress(std::min(1.0, seconds() / order.seconds)); });
            took = seconds() - before;
        } while (seconds() + took < order.seconds);
        return;
    }
    const std::uint64_t rounds = (order.paths + film.pathsOfARound() - 1) / film.pathsOfARound();
    for (std::uint64_t done = 0; done < rounds; ++done) {
        film.round([&](double part) { progress((static_cast<double>(done) + part) / static_cast<double>(rounds)); });
        if (order.events > 0 && film.events() >= order.events) break;
    }
}

}  // namespace

std::optional<Correction> correct(LayeredImage& picture, const PixelPaths& paths, const CorrectionOrder& order,
                                  const PathProgress& progress) {
    const Clock::time_point start = Clock::now();
    const auto seconds = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    const std::vector<float> opacity = paths.opacity(picture);
    std::vector<std::size_t> pixels = countedPixels(opacity);
    if (pixels.empty()) return std::nullopt;
    Film film(paths, std::move(pixels), order.seed);
    trace(film, order, seconds, progress);
    Correction told = film.told();
    told.made = told.evenness >= order.leastEvenness;
    const std::vector<glm::vec3> more = told.made ? filterDifference(film.mapOf(picture, opacity))
                                                  : std::vector<glm::vec3>(picture.pixels(), glm::vec3(0.0F));
    for (const std::string prefix : {"", "cloud."}) {
        if (!picture.layers.contains(prefix + "R")) continue;
        Colours colours(picture, prefix);
        for (const std::size_t pixel : film.pixels()) colours.add(pixel, more[pixel]);
    }
    told.seconds = seconds();
    return told;
}

}  // namespace lumulus::reference
