#include "scene/check_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/text.h"

namespace lumulus::scene {
namespace {

/// A field of the scene with the places of its keys.
struct Checked {
    const Field& field;
    std::string path;  ///< "field.0."
    const Settings& settings;

    /// Where the first of two keys is given.
    std::string where(const char* key, const char* other) const {
        for (const char* each : {key, other})
            if (const Setting* setting = settings.find(path + each)) return setting->where;
        return path + key;
    }

    void checkSizes() const {
        constexpr double widest = 2e7;
        if (!(std::min(field.area.x, field.area.z) > 0.0) || std::max(field.area.x, field.area.z) > widest)
            throw InputError(
                fmt::format("the area of a field must be above 0 and at most {:g} m along x and z, got {:g} × {:g}",
                            widest, field.area.x, field.area.z),
                where("area", "center"), "give [x, 0, z] in metres");
        if (field.smallest > field.largest)
            throw InputError(fmt::format("the smallest diameter, {:g} m, is above the largest, {:g} m", field.smallest,
                                         field.largest),
                             where("smallest", "largest"), "swap them");
    }

    /// Refuses the exponent of a deck, unless --set has replaced the file's kind.
    void checkExponent() const {
        const Setting* kind = settings.find(path + "kind");
        const Setting* given = settings.find(path + "exponent");
        if (given == nullptr || field.kind != FieldKind::stratocumulus) return;
        if (given->fromFile && kind != nullptr && !kind->fromFile) return;
        throw InputError("exponent has no effect: the cells of a deck are of one size", given->where,
                         "leave it out, or write kind = \"cumulus\" or \"cirrus\"");
    }
};

bool isName(const std::string& name) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto allowed = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_'; };
    return !name.empty() && name.size() <= 64 && letter(name[0]) && std::ranges::all_of(name, allowed);
}

}  // namespace

void checkField(const Scene& scene, std::size_t index, const Settings& settings) {
    const Checked checked{scene.fields[index], fmt::format("field.{}.", index), settings};
    checked.checkSizes();
    checked.checkExponent();
    const Setting* given = settings.find(checked.path + "name");
    if (given == nullptr) return;
    const std::string& name = checked.field.name;
    if (!isName(name))
        throw InputError(fmt::format("\"{}\" cannot be the name of a field", shortened(oneLine(name), 80)),
                         given->where, "give letters, digits, - and _, a letter first");
    const bool cloud = std::ranges::find(scene.clouds, name, &Cloud::name) != scene.clouds.end();
    if (cloud || std::ranges::count(scene.fields, name, &Field::name) > 1)
        throw InputError(fmt::format("another {} has the name \"{}\" too", cloud ? "cloud" : "field", name),
                         given->where, "give every cloud and field a name of its own");
}

}  // namespace lumulus::scene
