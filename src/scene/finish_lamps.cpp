#include "scene/finish_lamps.h"

#include <fmt/format.h>

#include "base/error.h"
#include "scene/black_body.h"
#include "scene/entry.h"
#include "scene/entry_name.h"

namespace lumulus::scene {
namespace {

constexpr double lumensPerWatt = 683.0;

void finishDirection(Lamp& lamp, const glm::dvec3* target, const Entry& entry) {
    const bool aimed = lamp.kind != LampKind::point;
    for (const char* key : {"direction", "target", "angle", "softness"})
        entry.checkRead(key, aimed, "\"spot\" or \"pyramid\"");
    const bool directed = entry.settings.find(entry.path + "direction") != nullptr;
    if (!aimed) {
        lamp.direction = Lamp().direction;
        return;
    }
    if (target == nullptr && !directed)
        throw InputError("the lamp has neither target nor direction", entry.whereOf("kind"),
                         "give a direction, as [0, -1, 0], or a target in metres");
    if (target != nullptr) {
        lamp.direction = *target - lamp.position;
        if (!(glm::length(lamp.direction) > 1e-9))
            throw InputError("target and position of the lamp are the same point", entry.whereOf("target"),
                             "move one of them");
    }
    lamp.direction = entry.unitVector(target != nullptr ? "target" : "direction", lamp.direction);
}

void finishPower(Lamp& lamp, const double* lumens, const double* temperature, const Entry& entry) {
    if (temperature != nullptr && lumens == nullptr)
        throw InputError("temperature needs lumens", entry.whereOf("temperature"),
                         "give lumens, or the colour by power = [r, g, b]");
    if (lumens == nullptr && entry.settings.find(entry.path + "power") == nullptr)
        throw InputError("the lamp has neither power nor lumens", entry.path + "power",
                         "give power in W per channel, or lumens");
    if (lumens == nullptr) return;
    const glm::dvec3 colour = temperature == nullptr ? glm::dvec3(1.0) : blackBodyColour(*temperature);
    lamp.power = *lumens / lumensPerWatt * colour;
}

template <typename Value>
const Value* valueOf(const std::map<std::size_t, Value>& values, std::size_t index) {
    const auto found = values.find(index);
    return found == values.end() ? nullptr : &found->second;
}

}  // namespace

void finishLamps(Draft& draft, const Settings& settings) {
    std::vector<Lamp>& lamps = draft.scene.lamps;
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        const Entry entry{fmt::format("lamp.{}.", i), "lamp", settings};
        checkEntryName(lamps, i, entry, "a lamp", "every lamp");
        finishDirection(lamps[i], valueOf(draft.lampTargets, i), entry);
        finishPower(lamps[i], valueOf(draft.lampLumens, i), valueOf(draft.lampTemperatures, i), entry);
    }
    if (draft.scene.camera.position) requireEyeOutsideLamps(draft.scene, *draft.scene.camera.position);
}

void requireEyeOutsideLamps(const Scene& scene, const glm::dvec3& eye) {
    for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
        const Lamp& lamp = scene.lamps[i];
        if (glm::distance(lamp.position, eye) > lamp.radius) continue;
        throw InputError(fmt::format("the camera's eye is within lamp.{}, whose radius is {:g} m", i, lamp.radius),
                         fmt::format("lamp.{}.position", i),
                         "move the lamp or camera.position, or give a smaller radius");
    }
}

}  // namespace lumulus::scene
