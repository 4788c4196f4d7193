#include "cli/cloud.h"

#include "base/atomic_file.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "cli/output.h"
#include "vdb/procedural.h"
#include "vdb/write.h"

namespace lumulus::cli {

void runCloud(const CloudOptions& options) {
    requireSuffix(options.output, {".vdb"});
    checkWritable(options.output);
    Steps steps(options.quiet);
    const vdb::Volume volume = vdb::makeCloud({options.kind, options.resolution, options.seed}, steps.reporter());
    stopIfInterrupted();
    steps.report("writing", 0, 1);
    vdb::write(volume, options.output);
    steps.report("writing", 1, 1);
}

}  // namespace lumulus::cli
