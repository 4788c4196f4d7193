// What a measured error makes of the picture itself: layers, and its correction.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "reference/metrics.h"
#include "reference/picture_error.h"

namespace lumulus::reference {
namespace {

constexpr std::array<const char*, 3> channels{"R", "G", "B"};

double meanOf(const glm::dvec3& rgb) {
    return (rgb.x + rgb.y + rgb.z) / 3.0;
}

/// Where the blocks of a picture lie.
struct BlockGrid {
    BlockGrid(const LayeredImage& picture, int edgeOfBlocks)
        : edge(edgeOfBlocks), columns((picture.width + edge - 1) / edge), rows((picture.height + edge - 1) / edge) {}
    std::size_t indexOf(int x, int y) const {
        return static_cast<std::size_t>(y / edge) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(x / edge);
    }
    std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }

    int edge, columns, rows;
};

/// Light of the cloud in a pixel, which a correction is in proportion to: what the picture has of it is exact only in
/// the background.
std::array<const std::vector<float>*, 3> lightOf(const LayeredImage& picture) {
    const std::string prefix = picture.layers.contains("cloud.R") ? "cloud." : "";
    std::array<const std::vector<float>*, 3> light{};
    for (std::size_t c = 0; c < 3; ++c) light[c] = &picture.layers.at(prefix + channels[c]);
    return light;
}

/// The difference of each block over the light of the cloud there.
class Ratios {
  public:
    Ratios(const LayeredImage& picture, const PictureError& error, const std::vector<std::size_t>& pixels)
        : grid_(picture, error.edge), light_(grid_.size()), ratios_(grid_.size()) {
        const auto light = lightOf(picture);
        for (const std::size_t pixel : pixels)
            for (std::size_t c = 0; c < 3; ++c)
                light_[blockOf(pixel, picture.width)][static_cast<int>(c)] +=
                    std::max(0.0, static_cast<double>((*light[c])[pixel]));
        for (const glm::dvec3& sum : light_) whole_ += sum;
        const glm::dvec3 mean = over(static_cast<double>(pixels.size()) * error.difference(), whole_);
        std::ranges::fill(ratios_, mean);
        shrink(error, mean);
    }

    /// Between the middles of the blocks.
    glm::dvec3 at(int x, int y) const {
        const double u = std::clamp((x + 0.5) / grid_.edge - 0.5, 0.0, grid_.columns - 1.0);
        const double v = std::clamp((y + 0.5) / grid_.edge - 0.5, 0.0, grid_.rows - 1.0);
        const int i = static_cast<int>(u), j = static_cast<int>(v);
        const int right = std::min(i + 1, grid_.columns - 1), below = std::min(j + 1, grid_.rows - 1);
        const auto of = [&](int column, int row) {
            return ratios_[grid_.indexOf(column * grid_.edge, row * grid_.edge)];
        };
        return glm::mix(glm::mix(of(i, j), of(right, j), u - i), glm::mix(of(i, below), of(right, below), u - i),
                        v - j);
    }
    /// Light of the cloud in all counted pixels.
    const glm::dvec3& light() const { return whole_; }

    static glm::dvec3 over(const glm::dvec3& a, const glm::dvec3& b) {
        return glm::mix(glm::dvec3(0.0), a / b, glm::greaterThan(b, glm::dvec3(0.0)));
    }

  private:
    std::size_t blockOf(std::size_t pixel, int width) const {
        const auto at = static_cast<int>(pixel);
        return grid_.indexOf(at % width, at / width);
    }

    /// Each block goes as far from the mean of the picture as its noise lets tell: by the share of the variance between
    /// blocks in what is seen (DerSimonian and Laird 1986).
    void shrink(const PictureError& error, const glm::dvec3& mean) {
        struct Seen {
            std::size_t block;
            glm::dvec3 ratio;
            double variance;
        };
        std::vector<Seen> seen;
        double weights = 0.0, squares = 0.0, sum = 0.0;
        for (const ErrorBlock& block : error.blocks) {
            const std::size_t index = grid_.indexOf(block.x, block.y);
            const auto count = static_cast<double>(block.pixels);
            const double light = meanOf(light_[index]) / count;
            if (!(light > 0.0) || !(block.sigma > 0.0)) continue;
            const double sigma = block.sigma / light;
            seen.push_back({index, over(count * block.difference, light_[index]), sigma * sigma});
            const double weight = 1.0 / seen.back().variance;
            weights += weight;
            squares += weight * weight;
            sum += weight * meanOf(seen.back().ratio);
        }
        if (seen.size() < 2) return;
        double scatter = 0.0;
        for (const Seen& one : seen) {
            const double off = meanOf(one.ratio) - sum / weights;
            scatter += off * off / one.variance;
        }
        const double between =
            std::max(0.0, (scatter - static_cast<double>(seen.size() - 1)) / (weights - squares / weights));
        for (const Seen& one : seen) ratios_[one.block] = glm::mix(mean, one.ratio, between / (between + one.variance));
    }

    BlockGrid grid_;
    std::vector<glm::dvec3> light_;  ///< sum over the counted pixels of each block
    std::vector<glm::dvec3> ratios_;
    glm::dvec3 whole_{0.0};
};

}  // namespace

void addErrorLayers(LayeredImage& picture, const PictureError& error) {
    const BlockGrid grid(picture, error.edge);
    std::vector<const ErrorBlock*> blocks(grid.size());
    for (const ErrorBlock& block : error.blocks) blocks[grid.indexOf(block.x, block.y)] = &block;
    const std::vector<std::size_t> pixels = cloudPixels(picture, picture);
    std::vector<float>&bias = picture.layer("error.bias"), &sigma = picture.layer("error.sigma");
    for (const std::size_t pixel : pixels) {
        const auto at = static_cast<int>(pixel);
        const ErrorBlock* block = blocks[grid.indexOf(at % picture.width, at / picture.width)];
        bias[pixel] = static_cast<float>(meanOf(block->difference));
        sigma[pixel] = static_cast<float>(block->sigma);
    }
}

void correct(LayeredImage& picture, const PictureError& error) {
    const std::vector<std::size_t> pixels = cloudPixels(picture, picture);
    const Ratios ratios(picture, error, pixels);
    const auto light = lightOf(picture);
    std::vector<glm::dvec3> lights, taken;
    glm::dvec3 sum(0.0);
    for (const std::size_t pixel : pixels) {
        const auto at = static_cast<int>(pixel);
        lights.emplace_back((*light[0])[pixel], (*light[1])[pixel], (*light[2])[pixel]);
        lights.back() = glm::max(lights.back(), glm::dvec3(0.0));
        taken.push_back(ratios.at(at % picture.width, at / picture.width) * lights.back());
        sum += taken.back();
    }
    const glm::dvec3 wanted = static_cast<double>(pixels.size()) * error.difference();
    const glm::dvec3 more = Ratios::over(wanted - sum, ratios.light());
    for (const std::string prefix : {"", "cloud."})
        for (std::size_t c = 0; c < 3; ++c) {
            const auto layer = picture.layers.find(prefix + channels[c]);
            if (layer == picture.layers.end()) continue;
            const auto channel = static_cast<int>(c);
            for (std::size_t i = 0; i < pixels.size(); ++i)
                layer->second[pixels[i]] -= static_cast<float>(taken[i][channel] + more[channel] * lights[i][channel]);
        }
}

}  // namespace lumulus::reference
