#include "scene/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "scene/alternatives.h"
#include "scene/read_value.h"
#include "scene/suggest.h"
#include "scene/toml_guard.h"

namespace lumulus::scene {

/// Where the nodes of one document come from, for messages.
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

/// `name = text`, or nothing where the text is no TOML value.
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

/// `name` is no key and no section; the first part of it that is neither has the blame.
[[noreturn]] void unknownKey(const std::string& name, const std::string& where) {
    std::size_t start = 0;
    for (std::size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.', start)) {
        const std::string section = name.substr(0, dot);
        if (findKey(section) != nullptr) {
            throw InputError(fmt::format("{} is a key and has none of its own", section), where,
                             fmt::format("write {} alone", section));
        }
        if (!isSection(section)) {
            throw InputError(fmt::format("unknown section \"{}\"", section.substr(start)), where, suggestKey(section));
        }
        start = dot + 1;
    }
    throw InputError(fmt::format("unknown key \"{}\"", name.substr(start)), where, suggestKey(name));
}

/// "cloud.0.phase.g" → "cloud.phase.g"; a path without the index of its cloud is refused with the way to write it.
std::string schemaName(const std::string& path) {
    if (!path.starts_with("cloud.")) return path;
    const std::string rest = path.substr(6);
    const std::size_t dot = rest.find('.');
    const std::string index = rest.substr(0, dot);
    if (findKey("cloud." + index) != nullptr || isSection("cloud." + index)) {
        throw InputError("which cloud is meant?", "--set " + path, "write cloud.0." + rest);
    }
    const bool digits = !index.empty() && std::ranges::all_of(index, [](char c) { return c >= '0' && c <= '9'; });
    if (!digits || (index.size() > 1 && index[0] == '0')) {
        throw InputError(fmt::format("the index of a cloud must be a plain number, got \"{}\"", index), "--set " + path,
                         "write cloud.0" + (dot == std::string::npos ? "" : rest.substr(dot)));
    }
    if (index != "0") {
        throw InputError("this version renders one cloud a scene", "--set " + path, "leave the other clouds out");
    }
    return dot == std::string::npos ? "cloud" : "cloud." + rest.substr(dot + 1);
}

}  // namespace

void Settings::addFile(std::string_view text, const std::string& source) {
    documents_.push_back(parseToml(text, source));
    const Origin origin{source};
    for (const auto& [name, node] : documents_.back()) collect(node, std::string(name), std::string(name), origin);
}

void Settings::addOverride(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0) {
        throw InputError(fmt::format("cannot read the override \"{}\"", text), "--set", "write section.key=value");
    }
    std::string path(text.substr(0, equals));
    std::erase(path, ' ');
    const std::string where = "--set " + path;
    if (auto table = parseOverrideValue(text.substr(equals + 1), where)) {
        documents_.push_back(std::move(*table));
    } else {
        documents_.push_back(toml::table{{"value", std::string(text.substr(equals + 1))}});
    }
    const toml::node& node = *documents_.back().get("value");
    if (path == "cloud") {
        std::erase_if(settings_, [](const auto& entry) { return entry.first.starts_with("cloud."); });
        collectClouds(node, Origin{});
        return;
    }
    const std::string name = schemaName(path);
    if (path.starts_with("cloud.")) clouds_ = std::max<std::size_t>(clouds_.value_or(0), 1);
    collect(node, path, name, Origin{});
}

const Setting* Settings::find(const std::string& path) const {
    const auto it = settings_.find(path);
    return it == settings_.end() ? nullptr : &it->second;
}

void Settings::collect(const toml::node& node, const std::string& path, const std::string& name, const Origin& origin) {
    if (const Key* key = findKey(name)) {
        put(path, {key, &node, origin.where(node, path), !origin.source.empty()});
        return;
    }
    if (!isSection(name)) unknownKey(name, origin.where(node, path));
    if (path == "cloud") {
        collectClouds(node, origin);
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

void Settings::collectClouds(const toml::node& node, const Origin& origin) {
    const toml::array* clouds = node.as_array();
    if (clouds == nullptr) {
        throw InputError(fmt::format("cloud must be an array of tables, got {}", nodeTypeText(node)),
                         origin.where(node, "cloud"), "write [[cloud]] with two brackets");
    }
    if (clouds->size() > 1) {
        throw InputError("this version renders one cloud a scene", origin.where(*clouds->get(1), "cloud.1"),
                         "leave the other clouds out");
    }
    clouds_ = clouds->size();
    for (const toml::node& cloud : *clouds) {
        if (!cloud.is_table()) {
            throw InputError(fmt::format("a cloud must be a table, got {}", nodeTypeText(cloud)),
                             origin.where(cloud, "cloud.0"), "write [[cloud]] and its keys below");
        }
        for (const auto& [key, child] : *cloud.as_table()) {
            collect(child, "cloud.0." + std::string(key.str()), "cloud." + std::string(key.str()), origin);
        }
    }
}

void Settings::put(const std::string& path, Setting setting) {
    if (!setting.fromFile) {
        for (const std::string& other : alternativesOf(path)) {
            const Setting* replaced = find(other);
            if (replaced != nullptr && replaced->fromFile) settings_.erase(other);
        }
    }
    settings_.insert_or_assign(path, std::move(setting));
}

}  // namespace lumulus::scene
