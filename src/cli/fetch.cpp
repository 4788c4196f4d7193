#include "cli/fetch.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>

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

/// `uploaded` becomes the hash of the file that is sent.
void loadScene(Client& client, const FetchOptions& options, std::string& uploaded) {
    std::map<std::string, std::string> fields;
    if (!options.overrides.empty()) fields["set"] = json(options.overrides).dump();
    if (!options.quality.empty()) fields["quality"] = json(options.quality).dump();
    if (!options.vdb.empty()) {
        uploaded = client.upload(options.vdb.string());
        fields["vdb"] = json(uploaded).dump();
    }
    const bool wanted = !options.scene.empty() || !fields.empty();
    if (!wanted) return;
    const std::string name = options.scene.empty() ? json::parse(client.welcome()).value("scene", "") : options.scene;
    std::error_code ec;
    if (name.ends_with(".toml") && std::filesystem::is_regular_file(name, ec))
        client.loadSceneText(scene::readSceneText(name), fields);
    else
        client.loadScene(name, fields);
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

/// Throws InputError for requests that the server refuses as wrong, Error for other failures.
[[noreturn]] void rethrow(const ClientError& error, const FetchOptions& options, const std::string& uploaded) {
    // the server knows the file by its hash, its owner by its name
    std::string text = error.what();
    const std::string name = "upload " + uploaded;
    const std::size_t at = uploaded.empty() ? std::string::npos : text.find(name);
    if (at != std::string::npos) text.replace(at, name.size(), options.vdb.string());
    const bool usage = error.code == "bad_request" || error.code == "not_found" || error.code == "too_large" ||
                       error.code == "unauthorized" || error.code == "no_scene";
    if (usage) throw InputError(text, options.address, "change the request (" + error.code + ")");
    throw Error(text, options.address,
                error.code == "connection" ? "is lumulus serve running there?" : "try again (" + error.code + ")");
}

}  // namespace

void runFetch(const FetchOptions& options) {
    requireSuffix(options.output, {".exr", ".png", ".jpg", ".jpeg"});
    checkWritable(options.output);
    std::string uploaded;
    try {
        Client client(options.address, readToken(options.tokenFile), options.timeout);
        loadScene(client, options, uploaded);
        const Frame frame = client.frame(queryOf(options));
        const FrameView& view = frame.views.at(0);
        writeFile(options.output, std::span(frame.payload).subspan(view.offset, view.bytes));
        if (options.stats == "-")
            printOut(json::parse(frame.json).dump(2) + "\n");
        else if (!options.stats.empty())
            writeFile(options.stats, std::as_bytes(std::span(frame.json)));
    } catch (const ClientError& e) {
        rethrow(e, options, uploaded);
    }
}

}  // namespace lumulus::cli
