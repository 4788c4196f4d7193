#include "service/protocol/cloud_edit_fields.h"

#include <nlohmann/json.hpp>
#include <string>

namespace lumulus::service {

using nlohmann::json;

namespace {

constexpr std::size_t longestName = 200, mostEdits = 256;
constexpr std::uint32_t mostClouds = 65535;
constexpr double farthest = 1e9;  // metres
constexpr double mostG = 0.99;    // as in scene files
constexpr double smallest = 1e-3, largest = 1e3;

/// What a cloud is to be like; nothing where no field says it.
void readDifferences(JsonFields& fields, CloudEdit& edit) {
    edit.move = fields.vector("move", -farthest, farthest);
    edit.extinction = fields.number("extinction", 1e-9, 1e6);
    edit.albedo = fields.vector("albedo", 0.0, 1.0);
    edit.asymmetry = fields.number("g", -mostG, mostG);
}

CloudEdit readEdit(JsonFields& fields) {
    CloudEdit edit;
    const auto added = fields.text("add", longestName);
    const auto removed = fields.indexOrName("remove", mostClouds, longestName);
    const auto altered = fields.indexOrName("cloud", mostClouds, longestName);
    if ((added ? 1 : 0) + (removed ? 1 : 0) + (altered ? 1 : 0) != 1)
        throw RequestError("bad_request", "give one of add (a name), remove and cloud", fields.place("cloud"));
    if (removed) {
        edit.kind = CloudEdit::Kind::remove;
        edit.cloud = *removed;
        return edit;
    }
    readDifferences(fields, edit);
    if (altered) {
        edit.cloud = *altered;
        if (!edit.move && !edit.extinction && !edit.albedo && !edit.asymmetry)
            throw RequestError("bad_request", "nothing to change: give move, extinction, albedo or g",
                               fields.place("cloud"));
        return edit;
    }
    edit.kind = CloudEdit::Kind::add;
    edit.name = *added;
    const auto like = fields.indexOrName("like", mostClouds, longestName);
    if (!like || edit.name.empty())
        throw RequestError("bad_request", "a cloud that is added has a name, and is like another one",
                           fields.place(edit.name.empty() ? "add" : "like"));
    edit.cloud = *like;
    edit.yaw = fields.number("yaw", -360.0, 360.0).value_or(edit.yaw);
    edit.scale = fields.number("scale", smallest, largest).value_or(edit.scale);
    return edit;
}

}  // namespace

std::vector<CloudEdit> readCloudEdits(JsonFields& fields) {
    std::vector<CloudEdit> edits;
    const json* list = fields.array("clouds", mostEdits);
    if (list == nullptr) return edits;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const std::string place = fields.place("clouds") + "[" + std::to_string(i) + "]";
        if (!(*list)[i].is_object()) throw RequestError("bad_request", place + " must be an object", place);
        JsonFields inner((*list)[i], place);
        edits.push_back(readEdit(inner));
        inner.finish();
    }
    if (edits.empty()) throw RequestError("bad_request", "clouds lists no change", fields.place("clouds"));
    return edits;
}

}  // namespace lumulus::service
