#include "service/render/scene_before.h"
#include "service/render/scene_slot.h"

// How the scene of a slot takes the place of another one.
namespace lumulus::service {

SceneBefore SceneSlot::before() {
    return {scene_, renderer_->changes(), renderer_->frameLight(scene_), noise_, costs_, seen_, seenReduction_, time_};
}

bool SceneSlot::goOnFrom(const SceneBefore& before, double seconds) {
    guard_.begin("taking over the light");
    renderer_->take(before.changes);
    const bool goesOn = goOn(*renderer_, scene_, before, seconds, [this] { guard_.check(); });
    if (goesOn) noise_ = before.noise.withoutPicture();
    costs_ = before.costs;
    costs_.forgetTracing();
    if (wantsGeneration()) traceGeneration();
    renderer_->setTime(time_ = before.time);
    FrameResult picture;
    drawViews(viewer(), before.views, before.reduction, picture);
    viewer().of(before.reduction).viewed.drawn(before.views, renderer_->bounds(), before.time);
    return goesOn;
}

scene::Scene SceneSlot::sceneNow() const {
    scene::Scene scene = scene_;
    scene.sun = renderer_->sun();
    scene.fog.media = renderer_->fogMedia();
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) scene.clouds[i].extinction = renderer_->extinction(i);
    return scene;
}

}  // namespace lumulus::service
