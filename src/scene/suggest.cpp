#include "scene/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "scene/arrays.h"
#include "scene/schema.h"

namespace lumulus::scene {
namespace {

std::string_view parentOf(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string_view::npos ? std::string_view{} : name.substr(0, dot);
}

/// The names of keys and sections directly within a section ("" is the file).
std::set<std::string> childrenOf(std::string_view section) {
    const std::string prefix = section.empty() ? "" : std::string(section) + ".";
    std::set<std::string> children;
    for (const Key& key : schema()) {
        if (!key.name.starts_with(prefix)) continue;
        const std::string_view rest = key.name.substr(prefix.size());
        children.emplace(rest.substr(0, rest.find('.')));
    }
    return children;
}

/// The path for --set of a key: in an array with an index, that of `given` where it has one.
std::string overridePath(const Key& key, std::string_view given) {
    const ArraySection* array = arrayOf(key.name);
    if (array == nullptr) return std::string(key.name);
    std::string index = "0";
    if (const ArraySection* other = arrayOf(given); other == array) {
        const std::string_view said = indexIn(*array, given);
        if (!said.empty() && said.find_first_not_of("0123456789") == std::string_view::npos) index = said;
    }
    return fmt::format("{}.{}{}", array->name, index, key.name.substr(array->name.size()));
}

/// How far a path is from a key: from its name, its path, or their last words (the right key without its section).
std::size_t distanceTo(std::string_view path, const Key& key, std::string_view whole) {
    std::size_t best = std::min(editDistance(path, whole), editDistance(path, key.name));
    for (std::size_t dot = key.name.find('.'); dot != std::string_view::npos; dot = key.name.find('.', dot + 1))
        best = std::min(best, editDistance(path, key.name.substr(dot + 1)));
    return best;
}

}  // namespace

std::vector<LikelyPath> pathsLike(std::string_view path) {
    constexpr std::size_t longest = 64, most = 6;  // a longer path is no spelling mistake
    if (path.size() > longest) return {};
    const std::size_t last = path.size() - (path.rfind('.') + 1);  // npos + 1 is 0
    std::vector<LikelyPath> found;
    for (const Key& key : schema()) {
        std::string whole = overridePath(key, path);
        const std::size_t distance = distanceTo(path, key, whole);
        if (distance <= 1 + last / 3 && distance < path.size()) found.push_back({std::move(whole), distance});
    }
    std::ranges::stable_sort(found, {}, &LikelyPath::distance);
    if (found.size() > most) found.resize(most);
    return found;
}

std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substitution = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, substitution});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
            }
        }
    }
    return d[a.size()][b.size()];
}

std::string suggestKey(std::string_view name) {
    const std::string_view section = parentOf(name);
    // a longer name is no spelling mistake, and would cost time and memory
    const std::string_view last = name.substr(section.empty() ? 0 : section.size() + 1).substr(0, 64);
    const std::set<std::string> children = childrenOf(section);
    std::size_t best = 1 + last.size() / 3;
    std::string nearest;
    for (const std::string& child : children) {
        const std::size_t distance = editDistance(last, child);
        if (distance <= best && (nearest.empty() || distance < best)) {
            best = distance;
            nearest = child;
        }
    }
    if (!nearest.empty()) return fmt::format("did you mean \"{}\"?", nearest);
    for (const Key& key : schema()) {  // the right name in the wrong section
        if (key.name.substr(key.name.rfind('.') + 1) != last) continue;
        const ArraySection* array = arrayOf(key.name);
        if (array == nullptr || arrayOf(name) == array) return fmt::format("did you mean {}?", key.name);
        return fmt::format("did you mean {} in [[{}]]?", key.name.substr(array->name.size() + 1), array->name);
    }
    if (section.empty()) return fmt::format("the sections are {}", fmt::join(children, ", "));
    return fmt::format("the keys of {} are {}", section, fmt::join(children, ", "));
}

}  // namespace lumulus::scene
