#pragma once

#include <optional>
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
    std::size_t hosts = 0;           ///< number of Host fields
    bool oldVersion = false;         ///< HTTP/1.0, which may have none
    std::string_view host;           ///< the Host field
    std::string_view origin;         ///< the Origin field; empty: none
    std::string_view authorization;  ///< "Bearer …"
};

/// The path of a question without what follows a `?`.
std::string_view pathOf(const HttpQuestion& question);

/// Whether the question is for those who watch the service, and not for browsers: /health, /ready.
bool isProbe(const HttpQuestion& question);

/// What is wrong with the question as HTTP, as a reply; none where nothing is: one Host field, or none where the
/// version or a probe may do without.
std::optional<HttpReply> malformed(const HttpQuestion& question);

/// Answers with the page's files, /health, /ready or /metrics. `notReady` is why the service is not.
HttpReply httpReply(const HttpQuestion& question, const std::optional<std::string>& notReady, const Metrics& metrics);

/// Whether a question for /metrics has the token, where there is one, as `Authorization: Bearer`.
bool tokenGiven(const HttpQuestion& question, const Config& config);
HttpReply tokenWanted();

/// Whether a browser may speak to this server: its Host is a number, localhost or one of the configured names (or a
/// page elsewhere could point a name of its own here), and its Origin, where it has one, is this server.
bool hostAllowed(const HttpQuestion& question, const Config& config);

}  // namespace lumulus::service
