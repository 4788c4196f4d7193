#include "cli/fetch.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/output.h"
#include "scene/load.h"
#include "service/client/lumulus_client.h"

namespace lumulus::cli {
namespace {

using nlohmann::json;

std::string readToken(const std::filesystem::path& path) {
    std::string token;
    if (path.empty()) return token;
    std::ifstream file(path);
    if (!std::getline(file, token))
        throw InputError("cannot read the token", path.string(), "give the file that the server reads its token from");
    while (!token.empty() && (token.back() == '\r' || token.back() == ' ')) token.pop_back();
    return token;
}

/// Whether the server found the request itself to be wrong.
bool isUsage(const ClientError& error) {
    static const std::set<std::string> usage{"bad_request", "not_found", "too_large", "unauthorized", "no_scene"};
    return usage.contains(error.code);
}

/// Throws InputError for requests that the server refuses as wrong, Error for other failures. `where` is what the user
/// gave that was refused.
[[noreturn]] void rethrow(const ClientError& error, const std::string& what, const std::string& where,
                          const std::string& mend, const FetchOptions& options) {
    if (isUsage(error)) throw InputError(what, where, mend + " (" + error.code + ")");
    throw Error(error.what(), options.address,
                error.code == "connection" ? "is lumulus serve running there?" : "try again (" + error.code + ")");
}

std::string upload(Client& client, const FetchOptions& options) {
    std::error_code ec;
    if (!std::filesystem::is_regular_file(options.vdb, ec))
        throw InputError("cannot read the file", options.vdb.string(), "give an OpenVDB file");
    try {
        return client.upload(options.vdb.string());
    } catch (const ClientError& e) {
        rethrow(e, e.what(), options.vdb.string(), "give another file", options);
    }
}

/// The server calls a text that it was sent "inline", perhaps in a folder of its own. People know it by its file.
std::string named(std::string text, const std::string& file) {
    const std::string_view sent = "inline";
    for (std::size_t at = text.find(sent); at != std::string::npos; at = text.find(sent, at)) {
        const std::size_t end = at + sent.size();
        const std::size_t begin = text.find_last_of(" (\"", at) + 1;  // of its folder; npos + 1 is 0
        const bool whole = begin == at || text[at - 1] == '/';
        const bool place = end < text.size() && std::string_view(":,)").find(text[end]) != std::string_view::npos;
        if (whole && place) text.replace(begin, end - begin, file);
        at = whole && place ? begin + file.size() : end;
    }
    return text;
}

/// The server knows an uploaded file by its hash, its owner by its name.
std::string withFileName(std::string text, const std::string& uploaded, const FetchOptions& options) {
    const std::string name = "upload " + uploaded;
    const std::size_t at = uploaded.empty() ? std::string::npos : text.find(name);
    if (at != std::string::npos) text.replace(at, name.size(), options.vdb.string());
    return text;
}

/// A local scene that the server refused. Its message names the place in the text; otherwise the file is named.
[[noreturn]] void rethrowScene(const ClientError& error, const std::string& file, const FetchOptions& options) {
    const std::string text = named(error.what(), file);
    if (isUsage(error) && text.find(file) != std::string::npos) throw InputError(text, "", "");
    rethrow(error, text, file, "change the scene", options);
}

void loadScene(Client& client, const FetchOptions& options) {
    std::map<std::string, std::string> fields;
    if (!options.overrides.empty()) fields["set"] = json(options.overrides).dump();
    if (!options.quality.empty()) fields["quality"] = json(options.quality).dump();
    const std::string uploaded = options.vdb.empty() ? std::string() : upload(client, options);
    if (!uploaded.empty()) fields["vdb"] = json(uploaded).dump();
    const bool wanted = !options.scene.empty() || !fields.empty();
    if (!wanted) return;
    const std::string name = options.scene.empty() ? json::parse(client.welcome()).value("scene", "") : options.scene;
    std::error_code ec;
    const bool local =
        name == scene::standardInput || (name.ends_with(".toml") && std::filesystem::is_regular_file(name, ec));
    try {
        if (local)
            client.loadSceneText(scene::readSceneText(name), fields);
        else
            client.loadScene(name, fields);
    } catch (const ClientError& e) {
        const std::string text = withFileName(e.what(), uploaded, options);
        if (text != e.what()) rethrow(e, text, "", "give another file, or other settings", options);
        if (local) rethrowScene(e, name, options);
        rethrow(e, e.what(), name, "give a scene of the server, or a local file that ends with .toml", options);
    }
}

FrameQuery queryOf(const FetchOptions& options) {
    FrameQuery query;
    query.width = options.width;
    query.height = options.height;
    if (!options.position.empty()) query.position = {options.position[0], options.position[1], options.position[2]};
    if (!options.target.empty()) query.target = {options.target[0], options.target[1], options.target[2]};
    query.verticalFov = options.verticalFov;
    if (!options.sun.empty()) query.sun = {options.sun[0], options.sun[1]};
    query.milliseconds = options.milliseconds;
    query.photons = options.photons;
    query.encoding = hasSuffix(options.output, ".exr") ? "exr" : (hasSuffix(options.output, ".png") ? "png" : "jpeg");
    if (query.encoding == "exr") query.products = {"color", "cloud", "transmittance", "depth", "front"};
    if (options.exposure) query.more["exposure"] = json(*options.exposure).dump();
    return query;
}

}  // namespace

void runFetch(const FetchOptions& options) {
    requireSuffix(options.output, {".exr", ".png", ".jpg", ".jpeg"});
    std::vector<std::filesystem::path> places{options.output};
    if (!options.stats.empty() && options.stats != "-") places.emplace_back(options.stats);
    checkPlaces(places);
    try {
        Client client(options.address, readToken(options.tokenFile), options.timeout);
        loadScene(client, options);
        const Frame frame = client.frame(queryOf(options));
        const FrameView& view = frame.views.at(0);
        writeFile(options.output, std::span(frame.payload).subspan(view.offset, view.bytes));
        if (options.stats == "-")
            printOut(json::parse(frame.json).dump(2) + "\n");
        else if (!options.stats.empty())
            writeFile(options.stats, std::as_bytes(std::span(frame.json)));
    } catch (const ClientError& e) {
        rethrow(e, e.what(), options.address, "change the request", options);
    }
}

}  // namespace lumulus::cli
