#include "vdb/leaf_reader.h"

#include <cmath>

#include "base/error.h"
#include "base/text.h"

namespace lumulus::vdb {

void leafValues(const openvdb::FloatTree::LeafNodeType& leaf, LeafTable::Values values) {
    const float* from = leaf.buffer().data();
    constexpr unsigned edge = LeafTable::edge;
    for (unsigned x = 0; x < edge; ++x)
        for (unsigned y = 0; y < edge; ++y)
            for (unsigned z = 0; z < edge; ++z) {
                const unsigned place = (x * edge + y) * edge + z;
                const float value = from[place];
                const bool counts = leaf.isValueOn(place) && std::isfinite(value) && value > 0.0F;
                values[(z * edge + y) * edge + x] = counts ? value : 0.0F;
            }
}

LeafReader::LeafReader(std::filesystem::path path, const openvdb::io::StreamMetadata& storage, float background,
                       bool asHalf)
    : path_(std::move(path)), storage_(storage), background_(background), half_(asHalf), streams_([this] {
          return open();
      }) {}

LeafReader::Stream LeafReader::open() const {
    Stream stream;
    stream.in.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    stream.in.open(path_, std::ios::binary);
    stream.storage = std::make_shared<openvdb::io::StreamMetadata>(storage_);
    return stream;
}

void LeafReader::read(std::uint64_t place, LeafTable::Values values) {
    try {
        Stream& stream = streams_.local();
        constexpr bool transfer = true;  // versions and compression too
        openvdb::io::setStreamMetadataPtr(stream.in, stream.storage, transfer);
        openvdb::io::setGridBackgroundValuePtr(stream.in, &background_);
        stream.in.seekg(static_cast<std::streamoff>(place));
        openvdb::FloatTree::LeafNodeType leaf(openvdb::PartialCreate(), openvdb::Coord(0, 0, 0));
        leaf.readBuffers(stream.in, half_);
        leafValues(leaf, values);
    } catch (const std::exception& error) {
        throw InputError("the file cannot be read again: " + oneLine(error.what()), path_.string(),
                         "leave the file as it is while the scene loads");
    }
}

}  // namespace lumulus::vdb
