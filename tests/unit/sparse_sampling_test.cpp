// Which sampling points a tile needs.
#include "draw/sparse_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lumulus::draw {
namespace {

Camera picture(int width, int height) {
    Camera camera;
    camera.width = width;
    camera.height = height;
    return camera;
}

TEST(SamplingSpacing, IsLessThanTwoVoxels) {
    EXPECT_EQ(samplingSpacing(0.99), 1);
    EXPECT_EQ(samplingSpacing(1.0), 2);
    EXPECT_EQ(samplingSpacing(1.5), 4);
    EXPECT_EQ(samplingSpacing(1e9), 4);
}

/// Along one axis the blocks of pixels first … last, with refined one block more, look at points block − 1 … block + 2,
/// those beyond the picture being the last one.
void expectCovered(int first, int last, int spacing, int pixels, int point, int points) {
    const int end = (pixels - 1 + spacing - 1) / spacing;
    for (int pixel = first; pixel <= last; ++pixel)
        for (int i = -1; i <= (hasRefinement(spacing) ? 3 : 2); ++i) {
            const int needed = std::clamp(pixel / spacing + i, 0, end);
            ASSERT_EQ(std::clamp(pixel / spacing + i, point, point + points - 1), needed) << pixel << " " << i;
        }
    EXPECT_LE(points, (last - first) / spacing + (hasRefinement(spacing) ? 6 : 5));
}

TEST(SamplingGridOf, CoversEveryTile) {
    for (const int spacing : {2, 4})
        for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(17, 9), glm::ivec2(32, 31), glm::ivec2(33, 64)})
            for (int x = 0; x < size.x; x += 3)
                for (int y = 0; y < size.y; y += 5) {
                    const Tile tile{x, y, std::min(11, size.x - x), std::min(13, size.y - y)};
                    const shared::SamplingGrid sampling =
                        samplingGridOf(picture(size.x, size.y), tile, spacing, 0.2, 1.0);
                    expectCovered(x, x + tile.width - 1, spacing, size.x, sampling.first.x, sampling.size.x);
                    expectCovered(y, y + tile.height - 1, spacing, size.y, sampling.first.y, sampling.size.y);
                }
}

TEST(SamplingRows, CoverEveryBand) {
    const Tile tile{0, 7, 8, 100};
    const shared::SamplingGrid sampling = samplingGridOf(picture(8, 120), tile, 4, 0.2, 1.0);
    for (const Band& band : {Band{0, 16}, Band{16, 16}, Band{96, 4}}) {
        const Band rows = samplingRows(sampling, tile, band);
        const int first = tile.y + band.first;
        expectCovered(first, first + band.rows - 1, 4, 120, sampling.first.y + rows.first, rows.rows);
        EXPECT_LE(rows.first + rows.rows, sampling.size.y);
    }
}

}  // namespace
}  // namespace lumulus::draw
