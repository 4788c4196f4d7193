#include "scene/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

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

}  // namespace

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
        if (key.name.substr(key.name.rfind('.') + 1) == last) return fmt::format("did you mean {}?", key.name);
    }
    if (section.empty()) return fmt::format("the sections are {}", fmt::join(children, ", "));
    return fmt::format("the keys of {} are {}", section, fmt::join(children, ", "));
}

}  // namespace lumulus::scene
