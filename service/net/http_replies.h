#pragma once

#include <string>
#include <string_view>

#include "service/net/config.h"
#include "service/telemetry/metrics.h"

namespace lumulus::service {

/// The answer to a GET.
struct HttpReply {
    int status = 200;
    std::string_view type;  ///< content type
    std::string body;
};

struct HttpQuestion {
    std::string_view target;         ///< "/metrics"
    std::string_view host;           ///< the Host field
    std::string_view origin;         ///< the Origin field; empty: none
    std::string_view authorization;  ///< "Bearer …"
};

/// Answers with the page's files, /health or /metrics. The latter asks for the token, where there is one, as
/// `Authorization: Bearer`.
HttpReply httpReply(const HttpQuestion& question, const Config& config, const Metrics& metrics);

/// Whether a browser may speak to this server: its Host is a number, localhost or one of the configured names (or a
/// page elsewhere could point a name of its own here), and its Origin, where it has one, is this server.
bool hostAllowed(const HttpQuestion& question, const Config& config);

}  // namespace lumulus::service
