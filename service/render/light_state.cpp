#include "service/render/light_state.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "service/values/request_error.h"

namespace lumulus::service {

bool changesLight(const scene::Scene& scene, const LightChange& change, std::optional<std::size_t> cloud) {
    constexpr double close = 1e-9;  // clients compute directions
    const auto differs = [](const std::optional<glm::dvec3>& wanted, const glm::dvec3& has) {
        return wanted && glm::length(*wanted - has) > close * std::max(1.0, glm::length(has));
    };
    if (differs(change.sunDirection, scene.sun.directionTo) || differs(change.sunIrradiance, scene.sun.irradiance) ||
        differs(change.wind, glm::dvec3(0.0)) || differs(change.move, glm::dvec3(0.0)))
        return true;
    for (std::size_t i = 0; change.extinction && i < scene.clouds.size(); ++i)
        if (cloud.value_or(i) == i && *change.extinction != scene.clouds[i].extinction) return true;
    return false;
}

SceneLight LightState::now() const {
    const scene::Sun& sun = renderer_.sun();
    return {sun.directionTo, sun.irradiance,
            scene_.clouds.empty() ? std::nullopt : std::optional(renderer_.extinction()), renderer_.fogMedia()};
}

LightState::Light LightState::all() const {
    Light light{renderer_.sun(), {}};
    for (std::size_t i = 0; i < scene_.clouds.size(); ++i) light.extinctions.push_back(renderer_.extinction(i));
    return light;
}

bool LightState::apply(const LightChange& change, std::optional<std::size_t> cloud) {
    const bool drifts = change.wind && renderer_.setWind(*change.wind);
    const bool moved = change.move && cloud && renderer_.moveCloud(*change.move, *cloud);
    Light before = all();
    bool changed = false;
    try {
        if (change.sunDirection || change.sunIrradiance) {
            const scene::Sun now = renderer_.sun();
            changed = renderer_.setSun(change.sunDirection.value_or(now.directionTo),
                                       change.sunIrradiance.value_or(now.irradiance));
        }
        if (change.extinction && renderer_.setExtinction(*change.extinction, cloud)) changed = otherExtinction_ = true;
    } catch (const InputError& e) {
        throw RequestError("bad_request", e.what());
    }
    if (changed && !before_) before_ = std::move(before);
    return changed || moved || drifts;
}

bool LightState::revert() {
    if (!before_) return false;
    const Light before = *std::exchange(before_, std::nullopt);
    otherExtinction_ = false;
    if (before.sun.irradiance != renderer_.sun().irradiance || before.sun.directionTo != renderer_.sun().directionTo)
        renderer_.setSun(before.sun.directionTo, before.sun.irradiance);
    for (std::size_t i = 0; i < before.extinctions.size(); ++i)
        if (before.extinctions[i] != renderer_.extinction(i)) renderer_.setExtinction(before.extinctions[i], i);
    return true;
}

}  // namespace lumulus::service
