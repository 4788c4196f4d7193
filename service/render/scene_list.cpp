#include "service/render/scene_list.h"

#include <algorithm>

#include "base/text.h"
#include "service/render/scene_source.h"

namespace lumulus::service {

namespace fs = std::filesystem;

namespace {

constexpr int mostEntries = 1000;
constexpr std::size_t longestName = 200;  // as in load_scene

}  // namespace

std::vector<std::string> sceneNames(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code ec;
    fs::directory_iterator entry(folder, ec);
    for (int seen = 0; !ec && entry != fs::directory_iterator() && seen < mostEntries; entry.increment(ec), ++seen) {
        std::error_code unreadable;  // of this entry alone
        const fs::path& file = entry->path();
        const std::string name = file.filename().string();
        const bool nameable = !name.starts_with('.') && name.size() <= longestName && oneLine(name) == name;
        const bool inside = !entry->is_symlink(unreadable) || liesIn(file, folder);
        if (nameable && file.extension() == ".toml" && entry->is_regular_file(unreadable) && inside)
            names.push_back(name);
    }
    std::ranges::sort(names);
    return names;
}

}  // namespace lumulus::service
