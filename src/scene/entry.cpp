#include "scene/entry.h"

#include <fmt/format.h>

#include "base/error.h"

namespace lumulus::scene {

void Entry::checkRead(const char* key, bool read, const char* kinds) const {
    const Setting* kind = settings.find(path + "kind");
    const Setting* given = settings.find(path + key);
    if (given == nullptr || read || (given->fromFile && kind != nullptr && !kind->fromFile)) return;
    throw InputError(fmt::format("{} has no effect: the {} is not of the kind {}", key, name, kinds), given->where,
                     fmt::format("leave it out, or write kind = {}", kinds));
}

std::string Entry::whereOf(const char* key) const {
    const Setting* given = settings.find(path + key);
    return given == nullptr ? path + key : given->where;
}

glm::dvec3 Entry::unitVector(const char* key, const glm::dvec3& direction) const {
    const double length = glm::length(direction);
    if (!(length > 1e-12))
        throw InputError(fmt::format("{} must have a length", key), whereOf(key), "give a direction, as [0, 1, 0]");
    return direction / length;
}

}  // namespace lumulus::scene
