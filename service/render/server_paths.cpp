#include "service/render/server_paths.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>

namespace lumulus::service {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view uploadMark = "upload sha256:", suffix = ".vdb";
constexpr std::size_t hashDigits = 64;

bool isOfPath(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-' || c == '/';
}

/// Replaces what paths begin with.
void replaceAll(std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos;) {
        const bool begins = at == 0 || !isOfPath(text[at - 1]);
        if (begins) text.replace(at, from.size(), to);
        at = text.find(from, at + (begins ? to.size() : 1));
    }
}

}  // namespace

ServerPaths::ServerPaths(const RenderConfig& config) {
    const auto add = [this](const fs::path& folder, const std::string& name) {
        if (folder.empty()) return;
        std::error_code ec;
        for (const fs::path& one : {folder, fs::absolute(folder, ec), fs::weakly_canonical(folder, ec)}) {
            if (one.empty() || one == one.root_path()) continue;
            const std::string text = one.lexically_normal().string();
            replacements_.emplace_back(text + (text.ends_with('/') ? "" : "/"), name);
        }
    };
    add(config.uploads, std::string(uploadMark));
    add(config.scenes, "");
    // and what a scene means by ../ and ../../
    std::string name = "../";
    for (fs::path above = fs::absolute(config.scenes).lexically_normal().parent_path();
         !config.scenes.empty() && above != above.root_path(); above = above.parent_path(), name += "../")
        add(above, name);
    std::ranges::stable_sort(replacements_, std::greater{}, [](const auto& entry) { return entry.first.size(); });
}

std::string ServerPaths::hidden(std::string text) const {
    for (const auto& [path, name] : replacements_) replaceAll(text, path, name);
    // an upload's file is its hash with a suffix
    for (std::size_t at = text.find(uploadMark); at != std::string::npos; at = text.find(uploadMark, at + 1)) {
        const std::size_t end = at + uploadMark.size() + hashDigits;
        if (text.compare(std::min(end, text.size()), suffix.size(), suffix) == 0) text.erase(end, suffix.size());
    }
    return text;
}

void ServerPaths::hide(Reply& reply) const {
    if (auto* failure = std::get_if<Failure>(&reply)) {
        failure->text = hidden(std::move(failure->text));
        failure->where = hidden(std::move(failure->where));
    } else if (auto* scene = std::get_if<SceneDescription>(&reply)) {
        for (std::string& warning : scene->warnings) warning = hidden(std::move(warning));
    } else if (auto* density = std::get_if<DensityChanged>(&reply)) {
        for (std::string& warning : density->scene.warnings) warning = hidden(std::move(warning));
    }
}

}  // namespace lumulus::service
