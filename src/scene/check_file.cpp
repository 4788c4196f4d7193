#include "scene/check_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace lumulus::scene {

bool isAllowed(const std::filesystem::path& file, std::span<const std::filesystem::path> folders) {
    if (folders.empty()) return true;
    std::error_code ec;
    const std::filesystem::path real = std::filesystem::weakly_canonical(file, ec);
    return !ec && std::ranges::any_of(folders, [&](const std::filesystem::path& folder) {
        const std::filesystem::path base = std::filesystem::weakly_canonical(folder, ec);
        return !ec && std::ranges::mismatch(base, real).in1 == base.end();
    });
}

void checkFile(const std::filesystem::path& file, const std::string& path, const char* kind,
               std::span<const std::filesystem::path> allowed, const Settings& settings) {
    if (file.empty()) return;
    std::error_code ec;
    const Setting* given = settings.find(path);
    const bool exists = isAllowed(file, allowed) && std::filesystem::exists(file, ec);
    if (!exists || std::filesystem::is_directory(file, ec)) {
        throw InputError(fmt::format("{} {}", file.string(), exists ? "is a folder" : "does not exist"),
                         given == nullptr ? path : given->where,
                         fmt::format("give {}, its path relative to the scene file", kind));
    }
}

}  // namespace lumulus::scene
