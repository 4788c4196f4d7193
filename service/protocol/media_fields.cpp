#include "service/protocol/media_fields.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace lumulus::service {

using nlohmann::json;

namespace {

constexpr std::uint32_t mostMedia = 256;  // of a scene

/// Keys of [[fog.media]] that can change.
constexpr std::array<std::string_view, 15> mediumKeys{
    "visibility", "scattering", "absorption", "albedo", "aerosol", "g",      "emission", "falloff",
    "direction",  "offset",     "bottom",     "top",    "center",  "radius", "half_size"};

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
    throw RequestError("bad_request", where + " " + what, where);
}

/// A value as TOML has it: a number, three of them, or a name.
std::string tomlOf(const json& value, const std::string& where) {
    constexpr std::size_t longestName = 60;
    const bool numbers = value.is_array() && value.size() == 3 &&
                         std::ranges::all_of(value, [](const json& one) { return one.is_number(); });
    const bool name = value.is_string() && value.get_ref<const std::string&>().size() <= longestName;
    if (!value.is_number() && !numbers && !name) refuse(where, "must be a number, three numbers or a name");
    return value.dump(-1, ' ', true);
}

MediumEdit readEdit(const json& object, const std::string& place) {
    JsonFields fields(object, place);
    MediumEdit edit;
    const auto medium = fields.integer("medium", 0, mostMedia - 1);
    if (!medium) refuse(fields.place("medium"), "is missing: give the index of a medium");
    edit.medium = static_cast<std::uint32_t>(*medium);
    edit.original = fields.flag("original").value_or(false);
    for (const auto& [key, value] : object.items()) {
        if (key == "medium" || key == "original" || value.is_null()) continue;
        const std::string where = fields.place(shortened(oneLine(key), 60));
        if (key == "kind") refuse(where, "cannot change: load the scene with another one");
        if (std::ranges::find(mediumKeys, key) == mediumKeys.end())
            refuse(where, "is not known here: docs/protocol.md lists the fields");
        edit.keys.emplace(key, tomlOf(value, where));
    }
    if (edit.keys.empty() && !edit.original) refuse(place, "changes nothing");
    return edit;
}

}  // namespace

std::vector<MediumEdit> readMedia(JsonFields& fields) {
    std::vector<MediumEdit> edits;
    const json* list = fields.array("media", mostMedia);
    if (list == nullptr) return edits;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const std::string place = fields.place("media") + "[" + std::to_string(i) + "]";
        MediumEdit edit = readEdit((*list)[i], place);
        if (std::ranges::find(edits, edit.medium, &MediumEdit::medium) != edits.end())
            refuse(place + ".medium", "is in the list twice");
        edits.push_back(std::move(edit));
    }
    if (edits.empty()) throw RequestError("bad_request", "media lists no change", fields.place("media"));
    return edits;
}

}  // namespace lumulus::service
