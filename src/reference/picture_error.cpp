#include "reference/picture_error.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "reference/any_tracer.h"
#include "reference/metrics.h"
#include "view/camera.h"
#include "view/ground.h"

namespace lumulus::reference {
namespace {

using Clock = std::chrono::steady_clock;

/// Added to the seed, so that no path is one of Renderer's.
constexpr std::uint64_t ownSeed = 0x6572726F72ULL;
/// Pixels that paths are traced through, paths that each of them has before there are more pixels, and the fewest
/// pixels of a block. Many pixels are good for the mean, many paths in each for the relMSE.
constexpr double mostPixels = 8192.0, fewestPixels = 1024.0, pathsOfPixel = 64.0;
constexpr std::size_t fewestOfBlock = 8;
constexpr std::uint64_t pathsOfRound = 2;

double meanOf(const glm::dvec3& rgb) {
    return (rgb.x + rgb.y + rgb.z) / 3.0;
}

/// R, G and B of a picture.
class Colours {
  public:
    explicit Colours(const LayeredImage& image)
        : layers_{&image.layers.at("R"), &image.layers.at("G"), &image.layers.at("B")} {}
    glm::dvec3 operator[](std::size_t pixel) const {
        return {(*layers_[0])[pixel], (*layers_[1])[pixel], (*layers_[2])[pixel]};
    }

  private:
    std::array<const std::vector<float>*, 3> layers_;
};

/// A pixel that paths are traced through.
struct Probe {
    std::size_t pixel = 0;
    double weight = 1.0;  ///< of its value in the mean of its block
    glm::dvec3 sum{0.0}, square{0.0};
    int lost = 0;
};

/// Counted pixels of a block, and those that are drawn of them.
struct Cell {
    ErrorBlock block;
    std::vector<std::size_t> pixels;
    double importance = 0.0;           ///< sum over its pixels
    std::size_t first = 0, count = 0;  ///< of its probes
};

/// The expected noise of paths is in proportion to the picture's light; half of the probes are spread evenly, so that
/// no weight is above two.
double importanceOf(const glm::dvec3& colour, double mean) {
    return 0.5 + (mean > 0.0 ? 0.5 * std::max(0.0, meanOf(colour)) / mean : 0.5);
}

class Meter {
  public:
    Meter(const LayeredImage& picture, const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes,
          std::uint64_t seed, std::vector<std::size_t> pixels)
        : colours_(picture),
          camera_(makeCamera(scene.camera, scene.image, boundsOf(volumes))),
          tracer_(groundedScene(scene, boundsOf(volumes)), volumes, Majorant::local),
          skyUnit_(scene.image.background ? tracer_.skyUnit() : glm::dvec3(0.0)),
          width_(static_cast<std::size_t>(picture.width)),
          seed_(seed + ownSeed),
          pixels_(std::move(pixels)) {
        divide(picture);
    }

    /// Seconds that a path takes on all threads, by a trial.
    double secondsOfPath() const;
    /// Draws the pixels for about so many paths.
    void draw(double paths);

    std::size_t pathsOfARound() const { return probes_.size() * pathsOfRound; }

    /// Traces some paths through each probe.
    void round(const std::function<void(double)>& progress) {
        const std::size_t some = tracer_.hazy() ? 1024 : 8192;
        for (std::size_t begin = 0; begin < probes_.size(); begin += some) {
            const std::size_t end = std::min(begin + some, probes_.size());
            tbb::parallel_for(begin, end, [this](std::size_t probe) { trace(probe); });
            progress(static_cast<double>(end) / static_cast<double>(probes_.size()));
        }
        paths_ += pathsOfRound;
    }

    PictureError result() const;

  private:
    void divide(const LayeredImage& picture);
    glm::dvec3 traced(std::size_t pixel, Random& random, int& lost) const;
    void trace(std::size_t number);

    /// What a probe says of the mean difference, and of the relMSE.
    glm::dvec3 differenceOf(const Probe& probe) const {
        return colours_[probe.pixel] - probe.sum / static_cast<double>(paths_);
    }
    double relMseOf(const Probe& probe) const;

    Colours colours_;
    Camera camera_;
    AnyTracer tracer_;
    glm::dvec3 skyUnit_;  ///< AnyTracer's; black where the background is left out
    std::size_t width_;
    std::uint64_t seed_;
    std::vector<std::size_t> pixels_;  ///< counted ones
    int edge_ = 1;
    double mean_ = 0.0;
    std::vector<Cell> cells_;
    std::vector<Probe> probes_;
    std::uint64_t paths_ = 0;  ///< of each probe
};

void Meter::divide(const LayeredImage& picture) {
    edge_ = std::max(1, (picture.height + 7) / 8);
    const int columns = (picture.width + edge_ - 1) / edge_, rows = (picture.height + edge_ - 1) / edge_;
    cells_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int i = 0; i < columns * rows; ++i) {
        ErrorBlock& block = cells_[static_cast<std::size_t>(i)].block;
        block.x = i % columns * edge_;
        block.y = i / columns * edge_;
        block.width = std::min(edge_, picture.width - block.x);
        block.height = std::min(edge_, picture.height - block.y);
    }
    for (const std::size_t pixel : pixels_) {
        const std::size_t x = pixel % width_, y = pixel / width_, edge = static_cast<std::size_t>(edge_);
        Cell& cell = cells_[y / edge * static_cast<std::size_t>(columns) + x / edge];
        cell.pixels.push_back(pixel);
        cell.block.mean += colours_[pixel];
        mean_ += meanOf(colours_[pixel]) / static_cast<double>(pixels_.size());
    }
    std::erase_if(cells_, [](const Cell& cell) { return cell.pixels.empty(); });
    for (Cell& cell : cells_) {
        cell.block.pixels = cell.pixels.size();
        cell.block.mean /= static_cast<double>(cell.pixels.size());
        for (const std::size_t pixel : cell.pixels) cell.importance += importanceOf(colours_[pixel], mean_);
    }
}

double Meter::secondsOfPath() const {
    constexpr std::size_t trials = 512;
    const Clock::time_point start = Clock::now();
    tbb::parallel_for(std::size_t{0}, trials, [this](std::size_t i) {
        Random random(seed_ + 1, i, 0);
        int lost = 0;
        traced(pixels_[i * pixels_.size() / trials], random, lost);
    });
    return std::chrono::duration<double>(Clock::now() - start).count() / static_cast<double>(trials);
}

/// Of each block, one pixel in each of equal parts of the importance.
void Meter::draw(double paths) {
    const auto counted = static_cast<double>(pixels_.size());
    const double wanted = std::min(std::clamp(paths / pathsOfPixel, fewestPixels, mostPixels), counted);
    for (Cell& cell : cells_) {
        const double share = cell.importance / counted;  // importance has a mean of 1
        cell.first = probes_.size();
        cell.count = std::max(fewestOfBlock, static_cast<std::size_t>(std::lround(wanted * share)));
        const double step = cell.importance / static_cast<double>(cell.count);
        Random random(seed_, 0, cell.pixels.front());
        std::size_t at = 0;
        double behind = importanceOf(colours_[cell.pixels.front()], mean_);
        for (std::size_t k = 0; k < cell.count; ++k) {
            const double place = (static_cast<double>(k) + random.uniform()) * step;
            while (behind < place && at + 1 < cell.pixels.size())
                behind += importanceOf(colours_[cell.pixels[++at]], mean_);
            const double chance = importanceOf(colours_[cell.pixels[at]], mean_) / cell.importance;
            probes_.push_back({cell.pixels[at], 1.0 / (chance * static_cast<double>(cell.pixels.size()))});
        }
    }
}

/// A path through a random point of a pixel.
glm::dvec3 Meter::traced(std::size_t pixel, Random& random, int& lost) const {
    const double px = static_cast<double>(pixel % width_) + random.uniform();
    const double py = static_cast<double>(pixel / width_) + random.uniform();
    const PathSample path = tracer_.trace(camera_.ray(px, py), random);
    lost += path.lost ? 1 : 0;
    return path.radiance + path.passed * skyUnit_;
}

void Meter::trace(std::size_t number) {
    Probe& probe = probes_[number];
    for (std::uint64_t i = 0; i < pathsOfRound; ++i) {
        Random random(seed_, number + 1, paths_ + i);
        const glm::dvec3 radiance = traced(probe.pixel, random, probe.lost);
        probe.sum += radiance;
        probe.square += radiance * radiance;
    }
}

double Meter::relMseOf(const Probe& probe) const {
    constexpr double floor = 0.01;
    const auto m = static_cast<double>(paths_);
    const glm::dvec3 seen = probe.sum / m, shown = colours_[probe.pixel];
    if (!(mean_ > 0.0)) return 0.0;
    const glm::dvec3 noise = glm::max(probe.square / m - seen * seen, glm::dvec3(0.0)) / (m - 1.0);
    return meanOf(((shown - seen) * (shown - seen) - noise) / (shown * shown + floor * mean_ * mean_));
}

/// A mean of weighted values, and the variance of that mean by their scatter.
struct Scatter {
    double count = 0.0, sum = 0.0, square = 0.0;

    void add(double value) {
        count += 1.0;
        sum += value;
        square += value * value;
    }
    double mean() const { return sum / count; }
    double variance() const {
        const double m = mean();
        return std::max(0.0, square / count - m * m) / (count - 1.0);
    }
};

PictureError Meter::result() const {
    PictureError error;
    error.mean = mean_;
    error.edge = edge_;
    error.paths = probes_.size() * paths_;
    for (const Cell& cell : cells_) error.pixels += cell.pixels.size();
    double bias = 0.0, biasVariance = 0.0, relMseVariance = 0.0;
    for (const Cell& cell : cells_) {
        const double share = static_cast<double>(cell.pixels.size()) / static_cast<double>(error.pixels);
        Scatter difference, relMse;
        ErrorBlock& block = error.blocks.emplace_back(cell.block);
        for (std::size_t i = cell.first; i < cell.first + cell.count; ++i) {
            const Probe& probe = probes_[i];
            const glm::dvec3 off = probe.weight * differenceOf(probe);
            block.difference += off / static_cast<double>(cell.count);
            difference.add(meanOf(off));
            relMse.add(probe.weight * relMseOf(probe));
            error.lost += static_cast<std::uint64_t>(probe.lost);
        }
        // where all paths saw the same, as in a block of one thin pixel, one path more could still move it by so much
        const double onePath = meanOf(block.mean) / (static_cast<double>(cell.count) * static_cast<double>(paths_));
        block.sigma = std::max(std::sqrt(difference.variance()), onePath);
        bias += share * difference.mean();
        biasVariance += share * share * difference.variance();
        error.relMse += share * relMse.mean();
        relMseVariance += share * share * relMse.variance();
    }
    if (mean_ > 0.0) {
        error.bias = bias / mean_;
        error.biasSigma = std::sqrt(biasVariance) / mean_;
    }
    error.relMseSigma = std::sqrt(relMseVariance);
    return error;
}

}  // namespace

double ErrorBlock::bias() const {
    return meanOf(mean) > 0.0 ? meanOf(difference) / meanOf(mean) : 0.0;
}

double ErrorBlock::biasSigma() const {
    return meanOf(mean) > 0.0 ? sigma / meanOf(mean) : 0.0;
}

glm::dvec3 PictureError::difference() const {
    glm::dvec3 sum(0.0);
    for (const ErrorBlock& block : blocks) sum += static_cast<double>(block.pixels) * block.difference;
    return pixels > 0 ? sum / static_cast<double>(pixels) : sum;
}

std::optional<PictureError> measureError(const LayeredImage& picture, const scene::Scene& scene,
                                         const std::vector<vdb::PlacedVolume>& volumes, const ErrorOrder& order,
                                         const ErrorProgress& progress) {
    const Clock::time_point start = Clock::now();
    const auto seconds = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    std::vector<std::size_t> pixels = cloudPixels(picture, picture);
    if (pixels.empty()) return std::nullopt;
    Meter meter(picture, scene, volumes, order.seed, std::move(pixels));
    meter.draw(order.paths > 0 ? static_cast<double>(order.paths) : order.seconds / meter.secondsOfPath());
    const double each = static_cast<double>(meter.pathsOfARound());
    const double rounds = std::max(1.0, std::ceil(static_cast<double>(order.paths) / each));
    double took = 0.0;  // of the round before
    for (double done = 0.0; order.paths > 0 ? done < rounds : done == 0.0 || seconds() + took < order.seconds; ++done) {
        const double before = seconds();
        meter.round([&](double part) {
            progress(order.paths > 0 ? (done + part) / rounds : std::min(1.0, seconds() / order.seconds));
        });
        took = seconds() - before;
    }
    PictureError error = meter.result();
    error.seconds = seconds();
    return error;
}

}  // namespace lumulus::reference
