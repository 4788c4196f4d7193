// Writes a procedural field of many puffs as an OpenVDB file: make_field FILE.vdb EDGE VOXELS [METRES [APART]], with
// about so many active voxels in a box of EDGE³ voxels of so many metres (default 1). With APART the puffs lie in two
// boxes, which are so many voxels apart along x. Values are halves, packed by blosc.
#include <oneapi/tbb/parallel_for.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/glm.hpp>
#include <memory>
#include <random>
#include <vector>

namespace {

struct Puff {
    glm::vec3 centre{0.0F};
    float radius = 0.0F;
};

using Leaf = openvdb::FloatTree::LeafNodeType;

/// Puffs that fill so many voxels, by a size distribution of a cumulus field: few large ones, many small ones.
std::vector<Puff> makePuffs(int edge, double voxels, int apart) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    std::vector<Puff> puffs;
    for (double filled = 0.0; filled < voxels;) {
        Puff puff;
        const auto largest = static_cast<float>(0.4 * std::cbrt(voxels / 10.0));
        puff.radius = std::max(largest * std::pow(0.1F, uniform(random)), 6.0F);
        const float room = static_cast<float>(edge) - 2.0F * puff.radius - 4.0F;
        puff.centre = puff.radius + 2.0F + room * glm::vec3(uniform(random), uniform(random), uniform(random));
        if (apart > 0 && uniform(random) < 0.5F) puff.centre.x += static_cast<float>(apart);
        filled += 4.18879 * std::pow(static_cast<double>(puff.radius), 3);
        puffs.push_back(puff);
    }
    return puffs;
}

/// Grain that repeats after 64 voxels.
float grainAt(int x, int y, int z) {
    const auto wave = [](int a, int b, int c) { return std::sin(0.0981748F * static_cast<float>(a + 2 * b + 3 * c)); };
    return 0.6F + 0.2F * wave(5 * x, 3 * y, z) + 0.2F * wave(2 * z, 7 * x, 4 * y);
}

std::unique_ptr<Leaf> makeLeaf(const openvdb::Coord& origin, const std::vector<Puff>& puffs) {
    auto leaf = std::make_unique<Leaf>(origin, 0.0F, false);
    bool any = false;
    for (const Puff& puff : puffs) {
        const glm::vec3 middle(origin.x() + 4, origin.y() + 4, origin.z() + 4);
        if (glm::distance(middle, puff.centre) > puff.radius + 7.0F) continue;
        for (unsigned i = 0; i < Leaf::SIZE; ++i) {
            const openvdb::Coord at = leaf->offsetToGlobalCoord(i);
            const float away = glm::distance(glm::vec3(at.x(), at.y(), at.z()), puff.centre) / puff.radius;
            if (away >= 1.0F) continue;
            const float value = (1.0F - away * away) * grainAt(at.x(), at.y(), at.z());
            leaf->setValueOn(i, std::min(leaf->getValue(i) + value, 1.0F));
            any = true;
        }
    }
    return any ? std::move(leaf) : nullptr;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 4) {
        std::fprintf(stderr, "make_field FILE.vdb EDGE VOXELS [METRES [APART]]\n");
        return 2;
    }
    const int edge = std::atoi(arguments[2]), apart = count > 5 ? std::atoi(arguments[5]) : 0;
    const std::vector<Puff> puffs = makePuffs(edge, std::atof(arguments[3]), apart);
    openvdb::initialize();
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create();
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setSaveFloatAsHalf(true);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(count > 4 ? std::atof(arguments[4]) : 1.0));
    constexpr int block = 64;
    std::vector<openvdb::Coord> blocks;
    for (const int first : apart > 0 ? std::vector<int>{0, apart / block * block} : std::vector<int>{0})
        for (int x = first; x < first + edge + block; x += block)
            for (int y = 0; y < edge; y += block)
                for (int z = 0; z < edge; z += block) blocks.emplace_back(x, y, z);
    std::vector<std::vector<std::unique_ptr<Leaf>>> made(blocks.size());
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
        std::vector<Puff> near;
        for (const Puff& puff : puffs) {
            const glm::vec3 middle = glm::vec3(blocks[i].x(), blocks[i].y(), blocks[i].z()) + 32.0F;
            if (glm::distance(middle, puff.centre) < puff.radius + 60.0F) near.push_back(puff);
        }
        for (int k = 0; k < 512 && !near.empty(); ++k)
            if (auto leaf = makeLeaf(blocks[i] + openvdb::Coord(k / 64 * 8, k / 8 % 8 * 8, k % 8 * 8), near))
                made[i].push_back(std::move(leaf));
    });
    for (auto& leaves : made)
        for (auto& leaf : leaves) grid->tree().addLeaf(leaf.release());
    made.clear();
    openvdb::io::File out(arguments[1]);
    out.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC);
    out.write({grid});
    out.close();
    std::printf("%llu active voxels in %u leaves\n", static_cast<unsigned long long>(grid->activeVoxelCount()),
                grid->tree().leafCount());
}
