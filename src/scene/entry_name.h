#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "scene/entry.h"
#include "scene/schema.h"

namespace lumulus::scene {

/// Whether `--set SECTION.NAME.key` can mean nothing but the entry of that name.
inline bool isEntryName(const std::string& name, const std::string& section) {
    const auto allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    };
    const bool digit = !name.empty() && name[0] >= '0' && name[0] <= '9';
    return !name.empty() && name.size() <= 64 && !digit && std::ranges::all_of(name, allowed) &&
           findKey(section + "." + name) == nullptr;
}

/// Refuses a name that an entry cannot have, or that another one has. `one`: "a lamp", `all`: "every lamp".
template <typename Value>
void checkEntryName(const std::vector<Value>& values, std::size_t index, const Entry& entry, const char* one,
                    const char* all) {
    const std::string& name = values[index].name;
    if (entry.settings.find(entry.path + "name") == nullptr) return;
    if (!isEntryName(name, entry.name))
        throw InputError(fmt::format("\"{}\" cannot be the name of {}", shortened(oneLine(name), 80), one),
                         entry.whereOf("name"),
                         "give letters, digits, - and _, a letter first, and not the name of a key");
    const auto same = std::ranges::find(values, name, &Value::name);
    if (same != values.begin() + static_cast<std::ptrdiff_t>(index))
        throw InputError(fmt::format("{}.{} has the name \"{}\" already", entry.name, same - values.begin(), name),
                         entry.whereOf("name"), fmt::format("give {} a name of its own", all));
}

}  // namespace lumulus::scene
