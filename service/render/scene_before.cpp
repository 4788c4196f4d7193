#include "service/render/scene_before.h"

namespace lumulus::service {

namespace {

/// As if both were files of one sequence, of which a second has so many.
void putInOneSequence(scene::Cloud& before, scene::Cloud& now, double seconds) {
    before.moment = scene::SequenceMoment{{}, 0.0, 1.0 / seconds, {}};
    now.moment = scene::SequenceMoment{{}, 1.0, 1.0 / seconds, {}};
    now.sequence.extend = scene::Extend::hold;
}

}  // namespace

bool goOn(Renderer& renderer, const scene::Scene& now, const SceneBefore& before, double seconds, const Check& check) {
    if (!before.light || before.scene.clouds.size() != now.clouds.size()) return false;
    scene::Scene then = before.scene, later = now;
    for (std::size_t i = 0; seconds > 0.0 && i < now.clouds.size(); ++i)
        if (then.clouds[i].vdb != later.clouds[i].vdb) putInOneSequence(then.clouds[i], later.clouds[i], seconds);
    const FrameMotion motion = motionOf(*before.light, then, later, vdb::ReadLimits{check});
    return motion.goesOn && renderer.goOnFrom(now, *before.light, motion.ways);
}

}  // namespace lumulus::service
