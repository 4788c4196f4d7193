// What changes while a renderer lives: light, extinction and place of the cloud.
#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "fog/media.h"
#include "renderer_state.h"

namespace lumulus {

Generations Renderer::generations() const {
    Generations result;
    if (!state_->photons) return result;
    result.first = state_->photons->firstInRing();
    result.count = state_->photons->generationsInRing();
    result.current = std::min(result.count, state_->sinceChange);
    result.photonsEach = state_->photons->photonsInRing() / static_cast<std::uint64_t>(std::max(1, result.count));
    return result;
}

const scene::Sun& Renderer::sun() const {
    return state_->scene.sun;
}

double Renderer::extinction() const {
    return state_->scene.clouds.empty() ? 0.0 : state_->scene.clouds[0].extinction;
}

void Renderer::State::dimSun() {
    sunlight = scene.sun;
    if (fog) sunlight.irradiance *= fog::sunTransmittance(scene.fog, bounds.centre, scene.sun.directionTo);
}

void Renderer::State::lightChanged() {
    assert(keepRing);
    dimSun();
    sinceChange = 0;
}

/// Of what was recorded before.
void Renderer::State::showSunDepth(int reduction) {
    sunDrawn = reduction;
    sharpening = false;
}

void Renderer::allowSunReduction(int reduction) {
    state_->sunAllowed = reduction;
}

int Renderer::sunReduction() const {
    return state_->sunDepth ? state_->sunDrawn : 1;
}

bool Renderer::sharpenSun(double share) {
    State& s = *state_;
    if (!s.sunDepth || s.sunDrawn <= 1) return true;
    if (!s.sharpening) s.sunDepth->begin(-s.sunlight.directionTo, s.medium.extinction);
    s.sharpening = true;
    s.commands.begin();
    if (s.sunDepth->recordPart(s.commands, share)) s.showSunDepth(1);
    s.commands.submit();
    s.commands.wait();
    return s.sunDrawn == 1;
}

bool Renderer::setSun(const glm::dvec3& directionTo, const glm::dvec3& irradiance) {
    State& s = *state_;
    if (directionTo == s.scene.sun.directionTo && irradiance == s.scene.sun.irradiance) return false;
    if (!s.hasSun() && !s.sunDepth)
        throw InputError("the scene was made without a sun", "sun.irradiance", "load a scene with one");
    if (directionTo != s.scene.sun.directionTo) s.sunDrawn = 0;
    s.scene.sun.directionTo = directionTo;
    s.scene.sun.irradiance = irradiance;
    s.lightChanged();
    return true;
}

bool Renderer::setExtinction(double extinction) {
    State& s = *state_;
    if (!s.cloud || !(extinction > 0.0))
        throw InputError("an extinction of 0 cannot be changed or reached", "extinction", "load another scene");
    double& now = s.scene.clouds[0].extinction;
    if (extinction == now) return false;
    s.medium.extinction *= extinction / now;
    now = extinction;
    if (s.photons) s.photons->setExtinction(s.medium.extinction);
    s.forgetLight();
    s.sunDrawn = 0;
    s.lightChanged();
    return true;
}

void Renderer::setOffset(const glm::dvec3& offset) {
    State& s = *state_;
    if (offset == s.offset) return;
    if (s.cloud) s.cloud->toWorld.translation += offset - s.offset;
    s.offset = offset;
}

bool Renderer::setWind(const glm::dvec3& velocity) {
    if (velocity == state_->wind) return false;
    state_->wind = velocity;
    return true;
}

void Renderer::setTime(double seconds) {
    setOffset(seconds * state_->wind);
}

}  // namespace lumulus
