#include "cli/cloud.h"

#include "base/atomic_file.h"
#include "cli/output.h"
#include "vdb/procedural.h"
#include "vdb/write.h"

namespace lumulus::cli {

void runCloud(const CloudOptions& options) {
    requireSuffix(options.output, {".vdb"});
    checkWritable(options.output);
    vdb::write(vdb::makeCloud({options.kind, options.resolution, options.seed}), options.output);
}

}  // namespace lumulus::cli
