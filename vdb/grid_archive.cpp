#include "vdb/grid_archive.h"

#include <stdexcept>

#include "vdb/tree_field.h"

namespace lumulus::vdb {
namespace {

/// Whether transforms stand before trees, as in all files since 2013.
bool isRecent(std::istream& in) {
    return openvdb::io::getFormatVersion(in) >= openvdb::OPENVDB_FILE_VERSION_GRID_INSTANCING;
}

/// Memory that a grid of scalars takes besides the nodes of a tree of floats: its parts in a list, and doubles.
std::uint64_t bytesBeside(const openvdb::GridBase& grid) {
    constexpr std::uint64_t bytesOfPart = 128, valuesOfLeaf = 512;
    const openvdb::TreeBase& tree = grid.constBaseTree();
    const std::uint64_t doubles = grid.isType<openvdb::DoubleGrid>() ? tree.leafCount() * valuesOfLeaf * 8 : 0;
    return (tree.leafCount() + tree.activeTileCount()) * bytesOfPart + doubles;
}

}  // namespace

GridArchive::GridArchive(const std::filesystem::path& path, const ReadLimits& limits)
    : file_(path, limits), in_(&file_) {}

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
    openvdb::MetaMap().readMeta(in_);
    const std::int32_t count = readGridCount(in_);
    for (std::int32_t i = 0; i < count; ++i) {
        openvdb::io::GridDescriptor& descriptor = descriptors_.emplace_back();
        grids_.push_back(descriptor.read(in_));
        isRead_.push_back(false);
        descriptor.setGridPos(in_.tellg());  // as all files have it, whatever this one says
        const std::size_t index = grids_.size() - 1;
        // after a single grid nothing has to be found
        if (inputHasGridOffsets() || count == 1) {
            constexpr std::uint64_t bytesOfHead = 4096;
            file_.foresee(bytesOfHead);
            readHead(index);
            if (inputHasGridOffsets()) descriptor.seekToEnd(in_);
        } else {
            readTree(index);
        }
    }
    if (!inputHasGridOffsets() && count > 1)
        for (std::size_t i = 0; i < grids_.size(); ++i) read(i);
}

/// Reads what stands before the tree of a grid.
void GridArchive::readHead(std::size_t index) {
    openvdb::GridBase& grid = *grids_[index];
    descriptors_[index].seekToGrid(in_);
    readGridCompression(in_);
    grid.readMeta(in_);
    if (isRecent(in_)) grid.readTransform(in_);
}

/// Reads a grid from where the stream stands.
void GridArchive::readTree(std::size_t index) {
    const openvdb::GridBase::Ptr& grid = grids_[index];
    isRead_[index] = true;
    if (!isRecent(in_) || !isScalar(*grid)) {
        file_.countMasks(true);  // those of values too, which are the same again
        readGrid(grid, descriptors_[index], in_);
        file_.countMasks(false);
        return;
    }
    readGridCompression(in_);
    grid->readMeta(in_);
    grid->removeMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD);
    grid->readTransform(in_);
    if (descriptors_[index].isInstance()) return;
    file_.countMasks(true);
    grid->readTopology(in_);
    file_.countMasks(false);
    file_.foresee(bytesBeside(*grid));
    grid->readBuffers(in_);
}

bool GridArchive::hasStream(std::size_t index) {
    return !isRead_[index] && !descriptors_[index].isInstance() && grids_[index]->isType<openvdb::FloatGrid>() &&
           openvdb::io::getFormatVersion(in_) >= openvdb::OPENVDB_FILE_VERSION_GRID_INSTANCING;
}

openvdb::FloatGrid::Ptr GridArchive::readStructure(std::size_t index) {
    openvdb::GridBase& grid = *grids_[index];
    descriptors_[index].seekToGrid(in_);
    readGridCompression(in_);
    grid.readMeta(in_);
    grid.removeMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD);
    grid.readTransform(in_);
    file_.countMasks(true, MeteredFile::Leaves::withoutValues);
    grid.readTopology(in_);
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
