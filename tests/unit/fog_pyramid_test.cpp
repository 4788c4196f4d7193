// Where the levels of a pyramid lie, and how many a spread needs.
#include <gtest/gtest.h>

#include "fog/screen/pyramid.h"

namespace lumulus::fog {
namespace {

TEST(FogPyramid, LevelsLieSideBySideInTheImage) {
    for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(1, 2), glm::ivec2(5, 3), glm::ivec2(8191, 3),
                                   glm::ivec2(3, 8191), glm::ivec2(1280, 720), glm::ivec2(16384, 2048)}) {
        const Pyramid pyramid = makePyramid(size);
        ASSERT_GE(pyramid.levels.size(), 2U);
        for (std::size_t i = 0; i < pyramid.levels.size(); ++i) {
            const Pyramid::Level& a = pyramid.levels[i];
            EXPECT_EQ(a.size, i == 0 ? size : (pyramid.levels[i - 1].size + 1) / 2);
            EXPECT_TRUE(glm::all(glm::lessThanEqual(a.offset + a.size, pyramid.image)));
            for (std::size_t j = 0; j < i; ++j) {
                const Pyramid::Level& b = pyramid.levels[j];
                const glm::bvec2 apart(a.offset.x >= b.offset.x + b.size.x || b.offset.x >= a.offset.x + a.size.x,
                                       a.offset.y >= b.offset.y + b.size.y || b.offset.y >= a.offset.y + a.size.y);
                EXPECT_TRUE(glm::any(apart)) << i << ' ' << j;
            }
        }
        EXPECT_EQ(pyramid.levels[static_cast<std::size_t>(pyramid.last())].size, glm::ivec2(1));
        EXPECT_LE(pyramid.image.x, 16384);
        EXPECT_LE(pyramid.image.y, 16384);
    }
}

TEST(FogPyramid, LevelsFollowTheSpread) {
    const PyramidStep step = pyramidStep(4, scene::FogFetch::linearBicubic);
    EXPECT_EQ(levelsFor(0.0, step, 9), 0);
    EXPECT_EQ(levelsFor(1.0, step, 9), 1);
    EXPECT_EQ(levelsFor(1e9, step, 9), 9);
    for (int level = 1; level < 9; ++level) {
        // a level spreads by √(2.1 (4^k − 1) / 3): that much needs it, a little more the next
        const double spread = std::sqrt(2.1 / 3.0 * (std::pow(4.0, level) - 1.0));
        EXPECT_EQ(levelsFor(spread * 0.999, step, 9), level);
        EXPECT_EQ(levelsFor(spread * 1.001, step, 9), level + 1);
    }
    // the papers' constant for 4×4, .8 to .86
    EXPECT_NEAR(step.scale(), 0.83, 0.03);
}

}  // namespace
}  // namespace lumulus::fog
