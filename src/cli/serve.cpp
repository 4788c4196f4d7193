#include "cli/serve.h"

#include "service/net/config.h"
#include "service/net/server.h"

namespace lumulus::cli {

void runServe(const ServeOptions& options) {
    service::serve(service::loadConfig(options.config));
}

}  // namespace lumulus::cli
