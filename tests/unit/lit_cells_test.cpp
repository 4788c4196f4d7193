#include "light/lit_cells.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lumulus::light {
namespace {

using glm::ivec3;

/// Mass in cells, and the list by its definition.
struct Masses {
    ivec3 cells;
    std::vector<float> values;

    explicit Masses(const ivec3& size) : cells(size), values(static_cast<std::size_t>(size.x * size.y * size.z)) {}
    float& at(const ivec3& cell) {
        return values[static_cast<std::size_t>((cell.z * cells.y + cell.y) * cells.x + cell.x)];
    }
    bool touches(const ivec3& cell) {
        const ivec3 lower = glm::max(cell - 1, ivec3(0)), upper = glm::min(cell + 1, cells - 1);
        for (int z = lower.z; z <= upper.z; ++z)
            for (int y = lower.y; y <= upper.y; ++y)
                for (int x = lower.x; x <= upper.x; ++x)
                    if (at({x, y, z}) > 0.0F) return true;
        return false;
    }
    std::vector<std::uint32_t> numbers(bool occupied) {
        std::vector<std::uint32_t> found;
        std::uint32_t number = 0;
        for (int z = 0; z < cells.z; ++z)
            for (int y = 0; y < cells.y; ++y)
                for (int x = 0; x < cells.x; ++x, ++number)
                    if ((at({x, y, z}) > 0.0F) == occupied && touches({x, y, z})) found.push_back(number);
        return found;
    }
};

void expectList(Masses masses) {
    const LitCells lit = litCells(masses.cells, masses.values);
    std::vector<std::uint32_t> expected = masses.numbers(true);
    EXPECT_EQ(lit.occupied, expected.size());
    std::ranges::copy(masses.numbers(false), std::back_inserter(expected));
    EXPECT_EQ(lit.numbers, expected);
}

/// A shell round a hole, which is dark in its middle.
TEST(LitCells, ShellAndItsTwoSides) {
    Masses masses({17, 15, 16});
    for (int z = 0; z < 16; ++z)
        for (int y = 0; y < 15; ++y)
            for (int x = 0; x < 17; ++x) {
                const float distance = glm::distance(glm::vec3(x, y, z), glm::vec3(8.0F, 7.0F, 8.0F));
                masses.at({x, y, z}) = distance > 4.0F && distance < 5.5F ? distance : 0.0F;
            }
    ASSERT_FALSE(masses.touches({8, 7, 8}));
    expectList(masses);
}

/// What lies at the end of a row is not beside the start of the next.
TEST(LitCells, CornersOfTheGrid) {
    for (const ivec3& corner : {ivec3(0, 0, 0), ivec3(4, 0, 0), ivec3(4, 3, 0), ivec3(0, 3, 2), ivec3(4, 3, 2)}) {
        Masses masses({5, 4, 3});
        masses.at(corner) = 1e-20F;
        EXPECT_EQ(litCells(masses.cells, masses.values).numbers.size(), 8U);
        expectList(masses);
    }
}

TEST(LitCells, GridsThatAreThinOrEmpty) {
    for (const ivec3& cells : {ivec3(1, 1, 1), ivec3(9, 1, 1), ivec3(1, 9, 1), ivec3(1, 1, 9)}) {
        expectList(Masses(cells));
        Masses masses(cells);
        masses.at(cells / 2) = 1.0F;
        expectList(masses);
    }
}

}  // namespace
}  // namespace lumulus::light
