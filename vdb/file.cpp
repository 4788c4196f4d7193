#include "vdb/file.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/text.h"
#include "vdb/chunks.h"
#include "vdb/grid_archive.h"
#include "vdb/nano.h"
#include "vdb/tree_field.h"

namespace lumulus::vdb {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& what, const std::string& mend) {
    throw InputError(what, path.string(), mend);
}

[[noreturn]] void refuseForeign(const fs::path& path, std::string_view start) {
    if (const auto foreign = foreignFile(start))
        refuse(path, "this is not an OpenVDB file but " + std::string(foreign->name), std::string(foreign->mend));
    refuse(path, "this is not an OpenVDB file", "give the path of a .vdb file");
}

/// Refuses what is no file with something in it, and returns its first bytes.
std::string checkedStart(const fs::path& path) {
    std::error_code ec;
    const fs::file_status status = fs::status(path, ec);
    if (status.type() == fs::file_type::not_found) refuse(path, "there is no such file", "check the path of the cloud");
    if (ec) refuse(path, "the file cannot be reached: " + ec.message(), "check its permissions");
    if (fs::is_directory(status)) refuse(path, "this is a folder, not a file", "give the path of a .vdb file");
    if (!fs::is_regular_file(status)) refuse(path, "this is not a regular file", "give the path of a .vdb file");
    const std::uintmax_t bytes = fs::file_size(path, ec);
    if (ec) refuse(path, "the file cannot be reached: " + ec.message(), "check its permissions");
    if (bytes == 0) refuse(path, "the file is empty", "write it again");

    std::ifstream in(path, std::ios::binary);
    if (!in) refuse(path, std::string("the file cannot be opened: ") + std::strerror(errno), "check its permissions");
    return fileStart(path);
}

/// Refuses an OpenVDB file that is too new or too old.
void checkFormat(const fs::path& path, std::string_view start) {
    constexpr std::size_t versionAt = 8;
    std::uint32_t version = 0;
    if (start.size() < versionAt + sizeof(version))
        refuse(path, "the file is truncated: it ends in its first bytes", "copy or write it again");
    std::memcpy(&version, &start[versionAt], sizeof(version));
    if (version > openvdb::OPENVDB_FILE_VERSION) {
        refuse(path, "the file is of a newer OpenVDB (format " + std::to_string(version) + ")",
               "save it as format " + std::to_string(openvdb::OPENVDB_FILE_VERSION) + " or older");
    }
    if (version < openvdb::OPENVDB_FILE_VERSION_GRID_INSTANCING) {
        refuse(path, "the file is of an OpenVDB of 2012 (format " + std::to_string(version) + ")",
               "open and save it with a newer program");
    }
}

/// Says what is wrong with a file, after an exception of OpenVDB or of the stream. The flags of the stream tell why it
/// threw; an archive that could not be made has none.
[[noreturn]] void refuseDamaged(const fs::path& path, bool ended) {
    try {
        throw;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        if (!ended)
            refuse(path, "the file asks for more memory than there is", "it is damaged, or too large for this machine");
    } catch (const std::exception& error) {
        if (!ended)
            refuse(path, "the file is damaged or of an unknown kind: " + oneLine(error.what()), "write it again");
    } catch (...) {
        refuse(path, "the file is damaged", "write it again");
    }
    refuse(path, "the file is truncated: it ends in the middle of a grid", "copy or write it again");
}

/// Runs a step of reading.
template <typename Step>
void readStep(const fs::path& path, GridArchive& archive, const Step& step) {
    try {
        step();
    } catch (...) {
        archive.rethrow();
        refuseDamaged(path, archive.ended());
    }
}

}  // namespace

GridFile::GridFile(const fs::path& path, const ReadLimits& limits) : path_(path) {
    openvdb::initialize();
    guardChunks();
    const std::string start = checkedStart(path);
    if (isNanoVdb(start)) {
        grids_ = readNanoGrids(path, limits);
        return;
    }
    if (!isOpenVdb(start)) {
        // a file that ends within the first eight bytes may have been one
        if (std::string_view(" BDV\0\0\0\0", 8).starts_with(start))
            refuse(path, "the file is truncated: it ends in its first bytes", "copy or write it again");
        refuseForeign(path, start);
    }
    checkFormat(path, start);
    archive_ = std::make_unique<GridArchive>(path, limits);
    readStep(path, *archive_, [&] { archive_->readHeads(); });
    grids_ = archive_->grids();
    if (grids_.empty()) refuse(path, "the file holds no grids", "write it with a float grid \"density\"");
}

GridFile::~GridFile() = default;

openvdb::GridBase::Ptr GridFile::read(std::size_t index) {
    if (archive_) readStep(path_, *archive_, [&] { archive_->read(index); });
    return grids_[index];
}

bool GridFile::hasStream(std::size_t index) {
    return archive_ && archive_->hasStream(index);
}

openvdb::FloatGrid::Ptr GridFile::readStructure(std::size_t index) {
    openvdb::FloatGrid::Ptr grid;
    readStep(path_, *archive_, [&] { grid = archive_->readStructure(index); });
    return grid;
}

void GridFile::streamLeaves(openvdb::FloatGrid& grid, const GridArchive::LeafVisit& visit) {
    readStep(path_, *archive_, [&] { archive_->streamLeaves(grid, visit); });
}

std::vector<GridLabel> GridFile::labels() {
    std::vector<GridLabel> labels;
    for (std::size_t i = 0; i < grids_.size(); ++i) {
        const openvdb::GridBase& grid = *grids_[i];
        GridLabel label{grid.getName(), valueType(grid), isScalar(grid),
                        grid.getGridClass() == openvdb::GRID_LEVEL_SET};
        if (label.isScalar) label.hasContent = [this, i] { return hasContent(*read(i)); };
        labels.push_back(std::move(label));
    }
    return labels;
}

std::string valueType(const openvdb::GridBase& grid) {
    if (const auto type = grid.getMetadata<openvdb::StringMetadata>(nanoTypeName)) return type->value();
    const std::string type = grid.valueType();
    return type == "float" && grid.saveFloatAsHalf() ? "half" : type;
}

}  // namespace lumulus::vdb
