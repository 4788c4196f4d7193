// The layers of a measured error.
#include <vector>

#include "reference/picture_error.h"

namespace lumulus::reference {
namespace {

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

}  // namespace

void addErrorLayers(LayeredImage& picture, const PictureError& error) {
    const BlockGrid grid(picture, error.edge);
    std::vector<const ErrorBlock*> blocks(grid.size());
    for (const ErrorBlock& block : error.blocks) blocks[grid.indexOf(block.x, block.y)] = &block;
    std::vector<float>&bias = picture.layer("error.bias"), &sigma = picture.layer("error.sigma");
    for (const std::size_t pixel : error.counted) {
        const auto at = static_cast<int>(pixel);
        const ErrorBlock* block = blocks[grid.indexOf(at % picture.width, at / picture.width)];
        bias[pixel] = static_cast<float>(meanOf(block->difference));
        sigma[pixel] = static_cast<float>(block->sigma);
    }
}

}  // namespace lumulus::reference
