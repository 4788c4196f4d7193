#include "vdb/tree_field.h"

#include <oneapi/tbb/parallel_for.h>

#include <vector>

namespace lumulus::vdb {
namespace {

IndexBox toBox(const openvdb::CoordBBox& box) {
    return {{box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()}};
}

template <typename Grid>
bool anyAbove(const openvdb::GridBase& grid) {
    const auto& tree = static_cast<const Grid&>(grid).tree();
    bool any = false;
    forTiles(tree.root(), [&any](const openvdb::CoordBBox&, auto value) { any = any || value > 0; });
    std::vector<const typename Grid::TreeType::LeafNodeType*> leaves;
    if (!any) tree.getNodes(leaves);
    for (const auto* leaf : leaves)
        for (auto value = leaf->cbeginValueOn(); value; ++value)
            if (*value > 0) return true;
    return any;
}

}  // namespace

bool isScalar(const openvdb::GridBase& grid) {
    return grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>();
}

bool hasContent(const openvdb::GridBase& grid) {
    return grid.isType<openvdb::FloatGrid>() ? anyAbove<openvdb::FloatGrid>(grid) : anyAbove<openvdb::DoubleGrid>(grid);
}

openvdb::FloatGrid::Ptr asFloats(const openvdb::GridBase::Ptr& grid) {
    if (auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid)) return floats;
    const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
    const auto floats = openvdb::FloatGrid::create(std::make_shared<openvdb::FloatTree>(doubles->tree()));
    floats->insertMeta(*doubles);
    floats->setTransform(doubles->transformPtr());
    return floats;
}

SparseField listBlocks(openvdb::FloatTree& tree) {
    std::vector<openvdb::FloatTree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    SparseField field;
    field.blocks.resize(leaves.size());
    tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
        auto& leaf = *leaves[i];
        for (auto value = leaf.beginValueOff(); value; ++value) value.setValue(0.0F);
        field.blocks[i] = {toBox(leaf.getNodeBoundingBox()), leaf.buffer().data(), 0.0F};
    });
    forTiles(tree.root(), [&field](const openvdb::CoordBBox& box, float value) {
        field.blocks.push_back({toBox(box), nullptr, value});
    });
    return field;
}

// It is taken from mapped vectors, since the conventions of OpenVDB's matrices differ between maps.
Affine indexToMetres(const openvdb::GridBase& grid) {
    const openvdb::math::MapBase& map = *grid.transform().baseMap();
    const auto toGlm = [](const openvdb::Vec3d& v) { return glm::dvec3(v.x(), v.y(), v.z()); };
    Affine affine;
    affine.linear = glm::dmat3(toGlm(map.applyJacobian({1, 0, 0})), toGlm(map.applyJacobian({0, 1, 0})),
                               toGlm(map.applyJacobian({0, 0, 1})));
    affine.translation = toGlm(map.applyMap({0, 0, 0}));
    return affine;
}

}  // namespace lumulus::vdb
