#include "service/net/http_replies.h"

#include <arpa/inet.h>

#include <array>
#include <sstream>

#include "service/values/sha256.h"
#include "viewer_files.h"

namespace lumulus::service {

namespace {

struct File {
    std::string_view target, type, body;
};

constexpr std::string_view script = "text/javascript; charset=utf-8";

constexpr std::array<File, 17> files{{
    {"/", "text/html; charset=utf-8", viewer::index_html},
    {"/icon.svg", "image/svg+xml", viewer::icon_svg},
    {"/viewer.css", "text/css; charset=utf-8", viewer::viewer_css},
    {"/controls.js", script, viewer::controls_js},
    {"/figures.js", script, viewer::figures_js},
    {"/fog.js", script, viewer::fog_js},
    {"/light.js", script, viewer::light_js},
    {"/link.js", script, viewer::link_js},
    {"/notices.js", script, viewer::notices_js},
    {"/orbit.js", script, viewer::orbit_js},
    {"/panel.js", script, viewer::panel_js},
    {"/picture.js", script, viewer::picture_js},
    {"/protocol.js", script, viewer::protocol_js},
    {"/save.js", script, viewer::save_js},
    {"/upload.js", script, viewer::upload_js},
    {"/viewer.js", script, viewer::viewer_js},
    {"/viewing.js", script, viewer::viewing_js},
}};

constexpr std::string_view plain = "text/plain; charset=utf-8";

/// Without the port; [::1] without its brackets.
std::string hostName(std::string_view host) {
    if (host.starts_with('[')) return std::string(host.substr(1, host.find(']') - 1));
    return std::string(host.substr(0, host.find(':')));
}

bool isNumber(const std::string& host) {
    in6_addr address{};
    return ::inet_pton(AF_INET, host.c_str(), &address) == 1 || ::inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

bool amongNames(const std::string& host, const std::string& names) {
    std::istringstream list(names);
    for (std::string name; list >> name;)
        if (name == host) return true;
    return false;
}

}  // namespace

std::string_view pathOf(const HttpQuestion& question) {
    return question.target.substr(0, question.target.find('?'));
}

bool isProbe(const HttpQuestion& question) {
    return pathOf(question) == "/health" || pathOf(question) == "/ready";
}

std::optional<HttpReply> malformed(const HttpQuestion& question) {
    if (question.hosts > 1) return HttpReply{400, plain, "a request has one Host field\n"};
    if (question.hosts == 0 && !question.oldVersion && !isProbe(question))
        return HttpReply{400, plain, "a request of HTTP/1.1 has a Host field\n"};
    return std::nullopt;
}

bool hostAllowed(const HttpQuestion& question, const Config& config) {
    if (isProbe(question)) return true;  // load balancers ask without a name, or by one of their own
    const std::string host = hostName(question.host);
    if (!isNumber(host) && host != "localhost" && !amongNames(host, config.hostNames)) return false;
    if (question.origin.empty()) return true;
    const std::size_t scheme = question.origin.find("://");
    return scheme != std::string_view::npos && question.origin.substr(scheme + 3) == question.host;
}

bool tokenGiven(const HttpQuestion& question, const Config& config) {
    return config.token.empty() || equalSecrets(question.authorization, "Bearer " + config.token);
}

HttpReply tokenWanted() {
    return {401, plain, "metrics need the token: Authorization: Bearer TOKEN\n"};
}

HttpReply httpReply(const HttpQuestion& question, const std::optional<std::string>& notReady, const Metrics& metrics) {
    const std::string_view target = pathOf(question);
    if (target == "/health") return {200, plain, "ok\n"};
    if (target == "/ready")
        return notReady ? HttpReply{503, plain, *notReady + "\n"} : HttpReply{200, plain, "ready\n"};
    for (const File& file : files)
        if (file.target == target) return {200, file.type, std::string(file.body)};
    if (target != "/metrics") return {404, plain, "not found: see /, /health, /ready and /metrics\n"};
    return {200, "text/plain; version=0.0.4; charset=utf-8", metrics.prometheus()};
}

}  // namespace lumulus::service
