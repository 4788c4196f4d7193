#include "cli/serve.h"

#include "service/config.h"
#include "service/server.h"

namespace lumulus::cli {

void runServe(const ServeOptions& options) {
    service::serve(service::loadConfig(options.config));
}

}  // namespace lumulus::cli
