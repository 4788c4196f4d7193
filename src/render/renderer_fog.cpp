#include <utility>

#include "render/picture.h"
#include "render/renderer.h"
#include "render/renderer_state.h"
#include "render/world_fog.h"

namespace lumulus {

LayeredImage Renderer::throughFog(const View& view, LayeredImage picture, std::vector<float> depth) {
    State& s = *state_;
    if (!s.fog) return picture;
    return seenThroughFog(*s.fog, s.world->fog, makeCamera(view, s.world->bounds), std::move(picture),
                          std::move(depth));
}

FogMaker Renderer::fogMaker() const {
    return lumulus::fogMaker(*state_->world);
}

bool Renderer::setFog(const NewFog& fog) {
    State& s = *state_;
    if (!lumulus::setFog(*s.world, fog)) return false;
    if (s.fog) s.fog->setMedia(s.world->fog.media);
    s.otherFog = true;
    s.lightChanged();
    return true;
}

bool Renderer::hasFog(const NewFog& fog) const {
    return fog.media == state_->world->fog.media;
}

const std::vector<scene::FogMedium>& Renderer::fogMedia() const {
    return state_->world->fog.media;
}

}  // namespace lumulus
