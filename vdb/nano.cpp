#include "vdb/nano.h"

#include <blosc.h>
#include <fmt/format.h>
#include <nanovdb/util/IO.h>
#include <zlib.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include "base/error.h"
#include "vdb/nano_tree.h"

namespace lumulus::vdb {
namespace {

namespace fs = std::filesystem;
using nanovdb::io::Codec;

/// Carries what the check threw past those who look for damage.
struct Stopped {
    std::exception_ptr by;
};

/// Reads a file and knows how much is left of it.
class Bytes {
  public:
    Bytes(const fs::path& path, const ReadLimits& limits)
        : in_(path, std::ios::binary), path_(path), limits_(limits), left_(fs::file_size(path)) {}

    std::uint64_t left() const { return left_; }

    void read(void* to, std::uint64_t bytes) {
        check();
        if (bytes > left_) throw DamagedGrid("it ends in the middle of a grid");
        in_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
        if (!in_) throw DamagedGrid("it cannot be read to its end");
        left_ -= bytes;
    }

    std::vector<char> take(std::uint64_t bytes) {
        if (bytes > left_) throw DamagedGrid("it ends in the middle of a grid");
        std::vector<char> taken(bytes);
        read(taken.data(), bytes);
        return taken;
    }

    void skip(std::uint64_t bytes) {
        if (bytes > left_) throw DamagedGrid("it ends in the middle of a grid");
        in_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
        left_ -= bytes;
    }

    void check() const {
        try {
            limits_.check();
        } catch (...) {
            throw Stopped{std::current_exception()};
        }
    }

    /// Foresees memory of a grid and its tree. Errors: InputError where all of them take more than the limit.
    void foresee(std::uint64_t bytes) {
        constexpr double bytesPerMiB = 1048576.0;
        foreseen_ += static_cast<double>(bytes) / bytesPerMiB;
        if (foreseen_ > limits_.treeMiB)
            throw InputError(fmt::format("the grids take more than {:g} MiB while they are read", limits_.treeMiB),
                             path_.string(),
                             "give them fewer voxels, divide the file, or raise preparation.memory_budget");
    }

  private:
    std::ifstream in_;
    const fs::path& path_;
    const ReadLimits& limits_;
    std::uint64_t left_;
    double foreseen_ = 0.0;  ///< MiB
};

/// What a file says of a grid before its bytes.
struct Entry {
    nanovdb::io::MetaData data;
    std::string name;
};

void unzip(Bytes& file, const NanoBytes& to) {
    std::uint64_t length = 0;
    file.read(&length, sizeof(length));
    const std::vector<char> packed = file.take(length);
    uLongf filled = to.size();
    if (uncompress(reinterpret_cast<Bytef*>(to.data()), &filled, reinterpret_cast<const Bytef*>(packed.data()),
                   static_cast<uLong>(length)) != Z_OK ||
        filled != to.size())
        throw DamagedGrid("a grid cannot be unpacked");
}

void unblosc(Bytes& file, const NanoBytes& to) {
    constexpr std::size_t largestChunk = std::size_t{1} << 30;  // as NanoVDB divides a grid
    for (std::size_t done = 0; done < to.size();) {
        const std::size_t chunk = std::min(largestChunk, to.size() - done);
        std::uint64_t length = 0;
        file.read(&length, sizeof(length));
        const std::vector<char> packed = file.take(length);
        std::size_t unpacked = 0;
        constexpr int threads = 1;
        if (blosc_cbuffer_validate(packed.data(), packed.size(), &unpacked) != 0 || unpacked != chunk ||
            blosc_decompress_ctx(packed.data(), to.data() + done, chunk, threads) != static_cast<int>(chunk))
            throw DamagedGrid("a grid cannot be unpacked");
        done += chunk;
    }
}

/// About what the tree of floats takes: as the grid, where that is not quantised.
std::uint64_t treeBytes(const nanovdb::io::MetaData& grid) {
    constexpr std::uint64_t mostQuantised = 8;  // 4 bits instead of 32
    using Type = nanovdb::GridType;
    const bool full = grid.gridType == Type::Float || grid.gridType == Type::Double;
    return grid.gridSize * (full ? 1 : mostQuantised);
}

NanoBytes readGrid(Bytes& file, const Entry& entry, Codec codec) {
    constexpr std::uint64_t mostPacked = 4096;  // times smaller than the grid; more is no real file
    const std::uint64_t size = entry.data.gridSize;
    if (size / (codec == Codec::NONE ? 1 : mostPacked) > file.left())
        throw DamagedGrid("it ends in the middle of a grid");
    file.foresee(size + treeBytes(entry.data));
    NanoBytes bytes(size);
    if (codec == Codec::NONE)
        file.read(bytes.data(), size);
    else if (codec == Codec::ZIP)
        unzip(file, bytes);
    else
        unblosc(file, bytes);
    return bytes;
}

openvdb::GridClass classOf(nanovdb::GridClass from) {
    switch (from) {
        case nanovdb::GridClass::LevelSet:
            return openvdb::GRID_LEVEL_SET;
        case nanovdb::GridClass::FogVolume:
            return openvdb::GRID_FOG_VOLUME;
        case nanovdb::GridClass::Staggered:
            return openvdb::GRID_STAGGERED;
        default:
            return openvdb::GRID_UNKNOWN;
    }
}

/// The affine transform of a NanoVDB grid. Its matrix acts on columns, OpenVDB's on rows.
openvdb::math::Transform::Ptr transformOf(const nanovdb::Map& map) {
    openvdb::Mat4d rows = openvdb::Mat4d::identity();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) rows(row, column) = map.mMatD[3 * column + row];
        rows(3, row) = map.mVecD[row];
    }
    return openvdb::math::Transform::createLinearTransform(rows);
}

bool isScalarType(nanovdb::GridType type) {
    using Type = nanovdb::GridType;
    for (const Type known : {Type::Float, Type::Double, Type::Fp4, Type::Fp8, Type::Fp16, Type::FpN})
        if (type == known) return true;
    return false;
}

openvdb::GridBase::Ptr toGrid(Bytes& file, const Entry& entry, Codec codec) {
    openvdb::GridBase::Ptr grid;
    if (isScalarType(entry.data.gridType)) {
        const NanoBytes bytes = readGrid(file, entry, codec);
        const nanovdb::GridData& head = nanoHead(bytes);
        if (head.mGridType != entry.data.gridType) throw DamagedGrid("a grid is not of the type that the file says");
        grid = openvdb::FloatGrid::create(nanoTree(bytes, [&] { file.check(); }));
        grid->setTransform(transformOf(head.mMap));
    } else {
        file.skip(entry.data.fileSize);
        grid = openvdb::BoolGrid::create();  // no density: only its name and type are told
    }
    const bool known = entry.data.gridType < nanovdb::GridType::End;
    grid->setName(entry.name);
    grid->setGridClass(classOf(entry.data.gridClass));
    grid->insertMeta(nanoTypeName, openvdb::StringMetadata(known ? nanovdb::toStr(entry.data.gridType) : "unknown"));
    return grid;
}

void checkHead(const nanovdb::io::Header& header, const fs::path& path) {
    const std::string magic(reinterpret_cast<const char*>(&header.magic), sizeof(header.magic));
    if (magic != "NanoVDB0" && magic != "NanoVDB2") {
        if (magic == "NanoVDB1")
            throw InputError("this is a bare NanoVDB grid without the header of a file", path.string(),
                             "save it with nanovdb::io::writeGrid, or as OpenVDB");
        throw DamagedGrid("it has no header where one should be");
    }
    const std::uint32_t version = header.version.getMajor();
    if (version != NANOVDB_MAJOR_VERSION_NUMBER)
        throw InputError("the file is of version " + std::to_string(version) + " of NanoVDB, not " +
                             std::to_string(NANOVDB_MAJOR_VERSION_NUMBER),
                         path.string(), "convert the OpenVDB file again, or give that file");
    if (header.codec >= Codec::END) throw DamagedGrid("it is packed in an unknown way");
}

std::vector<Entry> readEntries(Bytes& file, std::size_t count) {
    std::vector<Entry> entries(count);
    for (Entry& entry : entries) {
        file.read(&entry.data, sizeof(entry.data));
        const std::vector<char> name = file.take(entry.data.nameSize);
        entry.name.assign(name.begin(), std::find(name.begin(), name.end(), '\0'));
    }
    return entries;
}

openvdb::GridPtrVec readAll(const fs::path& path, const ReadLimits& limits) {
    Bytes file(path, limits);
    openvdb::GridPtrVec grids;
    while (file.left() > 0) {
        nanovdb::io::Header header;
        file.read(&header, sizeof(header));
        checkHead(header, path);
        for (const Entry& entry : readEntries(file, header.gridCount)) {
            const std::uint64_t before = file.left();
            if (entry.data.fileSize > before) throw DamagedGrid("it ends in the middle of a grid");
            grids.push_back(toGrid(file, entry, header.codec));
            if (before - file.left() != entry.data.fileSize)
                throw DamagedGrid("a grid does not have the length that the file says");
        }
    }
    return grids;
}

}  // namespace

openvdb::GridPtrVec readNanoGrids(const fs::path& path, const ReadLimits& limits) {
    try {
        openvdb::GridPtrVec grids = readAll(path, limits);
        if (grids.empty()) throw InputError("the file holds no grids", path.string(), "write it with a float grid");
        return grids;
    } catch (const Stopped& stopped) {
        std::rethrow_exception(stopped.by);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw InputError("the NanoVDB file asks for more memory than there is", path.string(),
                         "it is damaged, or too large for this machine");
    } catch (const std::exception& error) {
        throw InputError(std::string("the NanoVDB file is truncated or damaged: ") + error.what(), path.string(),
                         "copy or write it again");
    }
}

}  // namespace lumulus::vdb
