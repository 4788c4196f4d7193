#include "vdb/load.h"

#include <fmt/format.h>

#include <iterator>
#include <new>

#include "base/error.h"
#include "vdb/convert.h"
#include "vdb/file.h"

namespace lumulus::vdb {

LoadResult load(const std::filesystem::path& path, const LoadOptions& options) {
    GridFile file(path, options.limits);
    GridChoice choice = chooseGrid(file.labels(), options.grid, path.string(), options.keys + ".grid");
    const openvdb::GridBase::Ptr grid = file.read(choice.index);
    try {
        LoadResult result = convert(grid, options, path.string());
        result.warnings.insert(result.warnings.begin(), std::make_move_iterator(choice.warnings.begin()),
                               std::make_move_iterator(choice.warnings.end()));
        return result;
    } catch (const std::bad_alloc&) {
        throw Error(fmt::format("grid \"{}\" does not fit the memory of this machine", grid->getName()), path.string(),
                    "lower the memory budget");
    }
}

}  // namespace lumulus::vdb
