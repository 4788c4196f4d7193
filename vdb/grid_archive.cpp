#include "vdb/grid_archive.h"

#include <stdexcept>

#include "vdb/read_topology.h"
#include "vdb/tree_field.h"

namespace lumulus::vdb {
namespace {

/// Memory that a grid of scalars takes besides the nodes of a tree of floats: its parts in a list, and doubles.
std::uint64_t bytesBeside(const openvdb::GridBase& grid) {
    constexpr std::uint64_t bytesOfPart = 128, valuesOfLeaf = 512;
    const openvdb::TreeBase& tree = grid.constBaseTree();
    const std::uint64_t doubles = grid.isType<openvdb::DoubleGrid>() ? tree.leafCount() * valuesOfLeaf * 8 : 0;
    return (tree.leafCount() + tree.activeTileCount()) * bytesOfPart + doubles;
}

}  // namespace

GridArchive::GridArchive(const std::filesystem::path& path, const ReadLimits& limits)
    : file_(path, limits), in_(&file_), check_(path) {}

void GridArchive::readHeads() {
    // a stream that throws notices the end of a truncated file
    in_.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    readHeader(in_);
    metadata_ = std::make_shared<openvdb::io::StreamMetadata>();
    constexpr bool copied = false;
    openvdb::io::setStreamMetadataPtr(in_, metadata_, copied);
    setFormatVersion(in_);
    setLibraryVersion(in_);
    setDataCompression(in_);
    check_.metadata(in_.tellg());
    openvdb::MetaMap().readMeta(in_);
    const std::int32_t count = readGridCount(in_);
    for (std::int32_t i = 0; i < count; ++i) {
        check_.descriptor(in_.tellg());
        openvdb::io::GridDescriptor& descriptor = descriptors_.emplace_back();
        grids_.push_back(descriptor.read(in_));
        isRead_.push_back(false);
        descriptor.setGridPos(in_.tellg());  // as all files have it, whatever this one says
        const std::size_t index = grids_.size() - 1;
        // after a single grid nothing has to be found
        if (inputHasGridOffsets() || count == 1) {
            constexpr std::uint64_t bytesOfHead = 4096;
            file_.foresee(bytesOfHead);
            descriptor.seekToGrid(in_);
            readHead(*grids_[index]);
            if (inputHasGridOffsets()) descriptor.seekToEnd(in_);
        } else {
            readTree(index);
        }
    }
    if (!inputHasGridOffsets() && count > 1)
        for (std::size_t i = 0; i < grids_.size(); ++i) read(i);
}

/// Reads what stands before the tree of a grid, from where the stream stands.
void GridArchive::readHead(openvdb::GridBase& grid) {
    readGridCompression(in_);
    check_.metadata(in_.tellg());
    grid.readMeta(in_);
    grid.removeMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD);
    check_.text(in_.tellg());  // the type of the transform
    grid.readTransform(in_);
}

/// Reads a grid from where the stream stands.
void GridArchive::readTree(std::size_t index) {
    openvdb::GridBase& grid = *grids_[index];
    isRead_[index] = true;
    readHead(grid);
    if (descriptors_[index].isInstance()) return;
    file_.countMasks(true);
    readTopology(grid, in_);
    file_.countMasks(!isScalar(grid));  // masks of values are the same again: values of vectors are larger
    if (isScalar(grid)) file_.foresee(bytesBeside(grid));
    grid.readBuffers(in_);
    file_.countMasks(false);
}

bool GridArchive::hasStream(std::size_t index) {
    return !isRead_[index] && !descriptors_[index].isInstance() && grids_[index]->isType<openvdb::FloatGrid>();
}

openvdb::FloatGrid::Ptr GridArchive::readStructure(std::size_t index) {
    openvdb::GridBase& grid = *grids_[index];
    descriptors_[index].seekToGrid(in_);
    readHead(grid);
    file_.countMasks(true, MeteredFile::Leaves::withoutValues);
    readTopology(grid, in_);
    file_.countMasks(false);
    isRead_[index] = true;  // as far as it will be
    return openvdb::gridPtrCast<openvdb::FloatGrid>(grids_[index]);
}

void GridArchive::streamLeaves(openvdb::FloatGrid& grid, const LeafVisit& visit) {
    using Leaf = openvdb::FloatTree::LeafNodeType;
    std::vector<Leaf*> leaves;
    grid.tree().getNodes(leaves);
    for (Leaf* leaf : leaves) {
        const auto place = static_cast<std::uint64_t>(in_.tellg());
        leaf->readBuffers(in_, grid.saveFloatAsHalf());
        try {
            visit(*leaf, place);
        } catch (...) {  // says nothing about the file
            file_.noteEnd(std::current_exception());
            throw;
        }
        Leaf::Buffer none(openvdb::PartialCreate(), 0.0F);
        leaf->swap(none);
    }
}

void GridArchive::read(std::size_t index) {
    const openvdb::io::GridDescriptor& descriptor = descriptors_[index];
    if (!isRead_[index]) {
        descriptor.seekToGrid(in_);
        readTree(index);
    }
    if (!descriptor.isInstance()) return;
    for (std::size_t parent = 0; parent < grids_.size(); ++parent) {
        const openvdb::io::GridDescriptor& other = descriptors_[parent];
        if (other.isInstance() || other.uniqueName() != descriptor.instanceParentName()) continue;
        read(parent);
        grids_[index]->setTree(grids_[parent]->baseTreePtr());
        return;
    }
    throw std::runtime_error("a grid shares the tree of a grid that is not there");
}

}  // namespace lumulus::vdb
