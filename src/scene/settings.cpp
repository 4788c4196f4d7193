#include "scene/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "base/error.h"
#include "scene/alternatives.h"
#include "scene/read_value.h"
#include "scene/suggest.h"
#include "scene/toml_guard.h"

namespace lumulus::scene {

/// The document that nodes come from, for messages.
struct Settings::Origin {
    std::string source;  ///< file name; empty for an override
    std::string where(const toml::node& node, const std::string& path) const {
        if (source.empty()) return "--set " + path;
        const auto line = node.source().begin.line;
        return line == 0 ? fmt::format("{}, {}", source, path) : fmt::format("{}:{}, {}", source, line, path);
    }
};

namespace {

toml::table parseToml(std::string_view text, const std::string& source) {
    checkKeyDepth(text, source);
    try {
        return toml::parse(text, source);
    } catch (const toml::parse_error& e) {
        throw InputError(fmt::format("not valid TOML: {}", e.description()),
                         fmt::format("{}:{}", source, e.source().begin.line), "mend that line");
    }
}

/// Parses `name = text`. Returns nothing if the text is no TOML value.
std::optional<toml::table> parseOverrideValue(std::string_view text, const std::string& where) {
    const std::string document = "value = " + std::string(text);
    checkKeyDepth(document, where);
    try {
        toml::table table = toml::parse(document);
        if (table.size() == 1) return table;
    } catch (const toml::parse_error&) {
        // a bare string: --set draw.mode=march
    }
    return std::nullopt;
}

/// Throws for a `name` that is no key and no section. The message names its first part that is neither.
[[noreturn]] void unknownKey(const std::string& name, const std::string& where) {
    std::size_t start = 0;
    for (std::size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.', start)) {
        const std::string section = name.substr(0, dot);
        if (findKey(section) != nullptr) {
            throw InputError(fmt::format("{} is a key and has none of its own", section), where,
                             fmt::format("write {} alone", section));
        }
        if (!isSection(section)) {
            throw UnknownKey(fmt::format("unknown section \"{}\"", section.substr(start)), where, suggestKey(section));
        }
        start = dot + 1;
    }
    throw UnknownKey(fmt::format("unknown key \"{}\"", name.substr(start)), where, suggestKey(name));
}

/// Refuses an entry's key that does not exist: nobody is told to write it another way.
void requireKey(const std::string& name, const std::string& where) {
    if (findKey(name) == nullptr && !isSection(name)) unknownKey(name, where);
}

/// The index of an entry in a path of --set. A path without an index is refused with the right way to write it.
std::size_t entryIndex(const ArraySection& array, const std::string& path) {
    const std::string index(indexIn(array, path));
    const std::string name(array.name), rest = path.substr(std::min(path.size(), name.size() + 1));
    const std::string where = "--set " + path;
    if (findKey(name + "." + index) != nullptr || isSection(name + "." + index)) {
        requireKey(fmt::format("{}.{}", name, rest), where);
        throw InputError(fmt::format("which {} is meant?", array.entry), where,
                         fmt::format("write {}.0.{}", name, rest));
    }
    const bool digits = !index.empty() && std::ranges::all_of(index, [](char c) { return c >= '0' && c <= '9'; });
    if (!digits || (index.size() > 1 && index[0] == '0')) {
        const std::string key = rest.substr(index.size());
        requireKey(name + key, where);
        const bool named = findKey(name + ".name") != nullptr;
        throw InputError(fmt::format("the index of a {} must be a plain number{}, got \"{}\"", array.entry,
                                     named ? " or the name of one" : "", index),
                         where, fmt::format("write {}.0{}", name, key.empty() ? ".key=value" : key));
    }
    const std::size_t entry = index.size() > 9 ? array.most : std::stoul(index);
    if (entry >= array.most) {
        throw InputError(
            fmt::format("there is no {}.{}: a scene has at most {} {}", name, index, array.most, array.plural), where,
            fmt::format("give an index below {}", array.most));
    }
    return entry;
}

}  // namespace

void Settings::addFile(std::string_view text, const std::string& source) {
    documents_.push_back(parseToml(text, source));
    const Origin origin{source};
    for (const auto& [name, node] : documents_.back())
        if (name != "animate") collect(node, std::string(name), std::string(name), origin);
}

void Settings::addOverride(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0) {
        throw InputError(fmt::format("cannot read the override \"{}\"", text), "--set", "write section.key=value");
    }
    std::string path(text.substr(0, equals));
    std::erase(path, ' ');
    const ArraySection* array = arrayOf(path);
    if (array != nullptr) path = byIndex(*array, path);
    const std::string where = "--set " + path;
    if (auto table = parseOverrideValue(text.substr(equals + 1), where)) {
        documents_.push_back(std::move(*table));
    } else {
        documents_.push_back(toml::table{{"value", std::string(text.substr(equals + 1))}});
    }
    const toml::node& node = *documents_.back().get("value");
    if (array != nullptr && path == array->name) {
        std::erase_if(settings_, [&](const auto& entry) { return entry.first.starts_with(path + "."); });
        collectEntries(*array, node, Origin{});
        return;
    }
    collect(node, path, array == nullptr ? path : overriddenName(*array, path), Origin{});
}

void Settings::addAnimation(const Animation& animation, double frame) {
    for (const AnimatedKey& key : animation.keys()) {
        if (key.path.starts_with("field.") && key.path.ends_with(".wind"))
            throw InputError("wind cannot change from frame to frame: it has carried clouds since frame 0", key.where,
                             "give it in [[field]], as a velocity or by height");
        try {
            addOverride(key.path + "=" + key.valueAt(frame));
        } catch (const UnknownKey& e) {
            throw InputError(e.what_, key.where, suggestKey(key.path));
        } catch (const InputError& e) {
            throw InputError(fmt::format("frame {}: {}", frame, e.what()), key.where, "");
        }
        if (const auto found = settings_.find(key.path); found != settings_.end())
            found->second.where = fmt::format("{} at frame {}", key.where, frame);
    }
}

/// The path with the index of an entry in the place of its name: "cloud.veil.albedo" → "cloud.1.albedo".
std::string Settings::byIndex(const ArraySection& array, const std::string& path) const {
    const std::string_view given = indexIn(array, path);
    for (std::size_t i = 0; i < entries(array.name); ++i) {
        const Setting* name = find(fmt::format("{}.{}.name", array.name, i));
        if (name == nullptr || given.empty() || name->node->value_or(std::string_view()) != given) continue;
        return fmt::format("{}.{}{}", array.name, i, path.substr(array.name.size() + 1 + given.size()));
    }
    return path;
}

/// The schema's name for the path of an override in an array: "cloud.0.phase.g" → "cloud.phase.g". An index one beyond
/// the last entry adds an entry.
std::string Settings::overriddenName(const ArraySection& array, const std::string& path) {
    const std::size_t entry = entryIndex(array, path);
    std::size_t& count = entries_.try_emplace(std::string(array.name), array.implied).first->second;
    if (entry > count) {
        throw InputError(fmt::format("there is no {}.{}", array.name, count), "--set " + path,
                         fmt::format("the next one is {}.{}", array.name, count));
    }
    count = std::max(count, entry + 1);
    return std::string(array.name) + path.substr(array.name.size() + 1 + indexIn(array, path).size());
}

std::size_t Settings::entries(std::string_view array) const {
    return entries(array, arrayOf(array)->implied);
}

std::size_t Settings::entries(std::string_view array, std::size_t implied) const {
    const auto it = entries_.find(array);
    return it == entries_.end() ? implied : it->second;
}

const Setting* Settings::find(const std::string& path) const {
    const auto it = settings_.find(path);
    return it == settings_.end() ? nullptr : &it->second;
}

void Settings::collect(const toml::node& node, const std::string& path, const std::string& name, const Origin& origin) {
    if (const Key* key = findKey(name)) {
        const ArraySection* array = arrayOf(path);
        const std::size_t entry = array == nullptr ? 0 : std::stoul(std::string(indexIn(*array, path)));
        put(path, {key, &node, origin.where(node, path), !origin.source.empty(), entry});
        return;
    }
    if (!isSection(name)) unknownKey(name, origin.where(node, path));
    if (const ArraySection* array = arrayOf(path); array != nullptr && path == array->name) {
        collectEntries(*array, node, origin);
        return;
    }
    const toml::table* table = node.as_table();
    if (table == nullptr) {
        throw InputError(fmt::format("{} must be a table, got {}", path, nodeTypeText(node)), origin.where(node, path),
                         fmt::format("write [{}] and its keys below", name));
    }
    for (const auto& [key, child] : *table) {
        collect(child, path + "." + std::string(key.str()), name + "." + std::string(key.str()), origin);
    }
}

void Settings::collectEntries(const ArraySection& array, const toml::node& node, const Origin& origin) {
    const std::string name(array.name);
    const toml::array* entries = node.as_array();
    if (entries == nullptr) {
        throw InputError(fmt::format("{} must be an array of tables, got {}", name, nodeTypeText(node)),
                         origin.where(node, name), fmt::format("write [[{}]] with two brackets", name));
    }
    if (entries->size() > array.most) {
        throw InputError(
            fmt::format("a scene has at most {} {}, this one has {}", array.most, array.plural, entries->size()),
            origin.where(*entries->get(array.most), fmt::format("{}.{}", name, array.most)), "leave the others out");
    }
    entries_[name] = entries->size();
    std::size_t index = 0;
    for (const toml::node& entry : *entries) {
        const std::string path = fmt::format("{}.{}", name, index++);
        if (!entry.is_table()) {
            throw InputError(fmt::format("a {} must be a table, got {}", array.entry, nodeTypeText(entry)),
                             origin.where(entry, path), fmt::format("write [[{}]] and its keys below", name));
        }
        for (const auto& [key, child] : *entry.as_table()) {
            collect(child, path + "." + std::string(key.str()), name + "." + std::string(key.str()), origin);
        }
    }
}

void Settings::put(const std::string& path, Setting setting) {
    if (!setting.fromFile) {
        for (const std::string& other : alternativesOf(path, setting.key->name)) {
            const Setting* replaced = find(other);
            if (replaced != nullptr && replaced->fromFile) settings_.erase(other);
        }
    }
    settings_.insert_or_assign(path, std::move(setting));
}

}  // namespace lumulus::scene
