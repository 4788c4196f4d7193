#include "reference/picture_error.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "reference/random.h"

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

}  // namespace

class ErrorProbes::Meter {
  public:
    Meter(const LayeredImage& picture, std::uint64_t seed, std::vector<std::size_t> pixels)
        : width_(static_cast<std::size_t>(picture.width)), seed_(seed + ownSeed), pixels_(std::move(pixels)) {
        divide(picture);
    }

    /// Seconds that a path takes on all threads, by a trial, which is short where paths are long.
    double secondsOfPath(const PixelPaths& paths, const ErrorProgress& progress) const;
    /// Draws the pixels for about so many paths.
    void draw(const LayeredImage& picture, double paths);

    std::size_t pathsOfARound() const { return probes_.size() * pathsOfRound; }

    /// Traces some paths through each probe.
    void round(const PixelPaths& paths, const std::function<void(double)>& progress) {
        const std::size_t some = secondsOfPath_ > 0.0
                                     ? static_cast<std::size_t>(std::clamp(0.1 / secondsOfPath_, 16.0, 8192.0))
                                 : paths.hazy() ? 1024
                                                : 8192;
        for (std::size_t begin = 0; begin < probes_.size(); begin += some) {
            const std::size_t end = std::min(begin + some, probes_.size());
            tbb::parallel_for(begin, end, [&](std::size_t probe) { trace(paths, probe); });
            progress(static_cast<double>(end) / static_cast<double>(probes_.size()));
        }
        paths_ += pathsOfRound;
    }

    void tookSeconds(double seconds) { seconds_ = seconds; }
    void foresee(double secondsOfPath) { secondsOfPath_ = secondsOfPath; }
    PictureError errorOf(const LayeredImage& picture) const;

  private:
    void divide(const LayeredImage& picture);
    void trace(const PixelPaths& paths, std::size_t number);
    /// What a probe says of the relMSE of a picture of this mean that shows this colour there.
    double relMseOf(const Probe& probe, const glm::dvec3& shown, double mean) const;

    std::size_t width_;
    std::uint64_t seed_;
    std::vector<std::size_t> pixels_;  ///< counted ones
    int edge_ = 1;
    double mean_ = 0.0;  ///< of the picture that the probes were drawn for
    std::vector<Cell> cells_;
    std::vector<Probe> probes_;
    std::uint64_t paths_ = 0;  ///< of each probe
    double seconds_ = 0.0;
    double secondsOfPath_ = 0.0;  ///< 0: not known
};

void ErrorProbes::Meter::divide(const LayeredImage& picture) {
    const Colours colours(picture);
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
        mean_ += meanOf(colours[pixel]) / static_cast<double>(pixels_.size());
    }
    std::erase_if(cells_, [](const Cell& cell) { return cell.pixels.empty(); });
    for (Cell& cell : cells_) {
        cell.block.pixels = cell.pixels.size();
        for (const std::size_t pixel : cell.pixels) cell.importance += importanceOf(colours[pixel], mean_);
    }
}

double ErrorProbes::Meter::secondsOfPath(const PixelPaths& paths, const ErrorProgress& progress) const {
    constexpr std::size_t trials = 512, some = 32;
    constexpr double enough = 0.2;
    const Clock::time_point start = Clock::now();
    double seconds = 0.0;
    std::size_t done = 0;
    while (done < trials && seconds < enough) {
        tbb::parallel_for(std::size_t{0}, some, [&](std::size_t i) {
            const std::size_t trial = i * (trials / some) + done / some;  // all over the picture each time
            Random random(seed_ + 1, trial, 0);
            paths.trace(pixels_[trial * pixels_.size() / trials], random);
        });
        done += some;
        seconds = std::chrono::duration<double>(Clock::now() - start).count();
        progress(0.0);
    }
    return seconds / static_cast<double>(done);
}

/// Of each block, one pixel in each of equal parts of the importance.
void ErrorProbes::Meter::draw(const LayeredImage& picture, double paths) {
    const Colours colours(picture);
    const auto counted = static_cast<double>(pixels_.size());
    const double wanted = std::min(std::clamp(paths / pathsOfPixel, fewestPixels, mostPixels), counted);
    for (Cell& cell : cells_) {
        const double share = cell.importance / counted;  // importance has a mean of 1
        cell.first = probes_.size();
        cell.count = std::max(fewestOfBlock, static_cast<std::size_t>(std::lround(wanted * share)));
        const double step = cell.importance / static_cast<double>(cell.count);
        Random random(seed_, 0, cell.pixels.front());
        std::size_t at = 0;
        double behind = importanceOf(colours[cell.pixels.front()], mean_);
        for (std::size_t k = 0; k < cell.count; ++k) {
            const double place = (static_cast<double>(k) + random.uniform()) * step;
            while (behind < place && at + 1 < cell.pixels.size())
                behind += importanceOf(colours[cell.pixels[++at]], mean_);
            const double chance = importanceOf(colours[cell.pixels[at]], mean_) / cell.importance;
            probes_.push_back({cell.pixels[at], 1.0 / (chance * static_cast<double>(cell.pixels.size()))});
        }
    }
}

void ErrorProbes::Meter::trace(const PixelPaths& paths, std::size_t number) {
    Probe& probe = probes_[number];
    for (std::uint64_t i = 0; i < pathsOfRound; ++i) {
        Random random(seed_, number + 1, paths_ + i);
        const PixelSample sample = paths.trace(probe.pixel, random);
        probe.sum += sample.radiance;
        probe.square += sample.radiance * sample.radiance;
        probe.lost += sample.lost ? 1 : 0;
    }
}

double ErrorProbes::Meter::relMseOf(const Probe& probe, const glm::dvec3& shown, double mean) const {
    constexpr double floor = 0.01;
    const auto m = static_cast<double>(paths_);
    const glm::dvec3 seen = probe.sum / m;
    if (!(mean > 0.0)) return 0.0;
    const glm::dvec3 noise = glm::max(probe.square / m - seen * seen, glm::dvec3(0.0)) / (m - 1.0);
    return meanOf(((shown - seen) * (shown - seen) - noise) / (shown * shown + floor * mean * mean));
}

PictureError ErrorProbes::Meter::errorOf(const LayeredImage& picture) const {
    const Colours colours(picture);
    PictureError error;
    error.edge = edge_;
    error.pixels = pixels_.size();
    error.counted = pixels_;
    error.paths = probes_.size() * paths_;
    error.seconds = seconds_;
    for (const std::size_t pixel : pixels_) error.mean += meanOf(colours[pixel]) / static_cast<double>(pixels_.size());
    double bias = 0.0, biasVariance = 0.0, relMseVariance = 0.0;
    for (const Cell& cell : cells_) {
        const double share = static_cast<double>(cell.pixels.size()) / static_cast<double>(error.pixels);
        Scatter difference, relMse;
        ErrorBlock& block = error.blocks.emplace_back(cell.block);
        for (const std::size_t pixel : cell.pixels) block.mean += colours[pixel];
        block.mean /= static_cast<double>(cell.pixels.size());
        for (std::size_t i = cell.first; i < cell.first + cell.count; ++i) {
            const Probe& probe = probes_[i];
            const glm::dvec3 shown = colours[probe.pixel];
            const glm::dvec3 off = probe.weight * (shown - probe.sum / static_cast<double>(paths_));
            block.difference += off / static_cast<double>(cell.count);
            difference.add(meanOf(off));
            relMse.add(probe.weight * relMseOf(probe, shown, error.mean));
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
    if (error.mean > 0.0) {
        error.bias = bias / error.mean;
        error.biasSigma = std::sqrt(biasVariance) / error.mean;
    }
    error.relMseSigma = std::sqrt(relMseVariance);
    return error;
}

double ErrorBlock::bias() const {
    return meanOf(mean) > 0.0 ? meanOf(difference) / meanOf(mean) : 0.0;
}

double ErrorBlock::biasSigma() const {
    return meanOf(mean) > 0.0 ? sigma / meanOf(mean) : 0.0;
}

std::optional<ErrorProbes> ErrorProbes::trace(const LayeredImage& picture, const PixelPaths& paths,
                                              const ErrorOrder& order, const ErrorProgress& progress) {
    const Clock::time_point start = Clock::now();
    const auto seconds = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    std::vector<std::size_t> pixels = countedPixels(paths.opacity(picture));
    if (pixels.empty()) return std::nullopt;
    auto meter = std::make_shared<Meter>(picture, order.seed, std::move(pixels));
    double wanted = static_cast<double>(order.paths);
    if (order.paths == 0) {
        const double secondsOfPath = meter->secondsOfPath(paths, progress);
        meter->foresee(secondsOfPath);
        wanted = order.seconds / secondsOfPath;
    }
    meter->draw(picture, wanted);
    const double each = static_cast<double>(meter->pathsOfARound());
    const double rounds = std::max(1.0, std::ceil(static_cast<double>(order.paths) / each));
    double took = 0.0;  // of the round before
    for (double done = 0.0; order.paths > 0 ? done < rounds : done == 0.0 || seconds() + took < order.seconds; ++done) {
        const double before = seconds();
        meter->round(paths, [&](double part) {
            progress(order.paths > 0 ? (done + part) / rounds : std::min(1.0, seconds() / order.seconds));
        });
        took = seconds() - before;
    }
    meter->tookSeconds(seconds());
    return ErrorProbes(std::move(meter));
}

PictureError ErrorProbes::errorOf(const LayeredImage& picture) const {
    return meter_->errorOf(picture);
}

}  // namespace lumulus::reference
