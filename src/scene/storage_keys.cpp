#include <array>

#include "scene/key_rows.h"

namespace lumulus::scene {

namespace {

constexpr std::array storages{DensityStorage::automatic, DensityStorage::dense, DensityStorage::sparse};

}  // namespace

std::vector<Key> storageKeys() {
    return {
        choice(
            "preparation.storage", {"auto", "dense", "sparse"}, "\"auto\"",
            "How densities are stored: all voxels of the box (`dense`), or bricks of 8³ voxels where there is density "
            "(`sparse`). `auto` takes bricks where grids do not fit `memory_budget` or "
            "an image of the device otherwise.",
            [](Draft& d, const Value& v) { d.scene.preparation.storage = storages.at(v.choice); }),
    };
}

}  // namespace lumulus::scene
