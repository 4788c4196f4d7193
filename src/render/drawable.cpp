#include "render/drawable.h"

#include <algorithm>

#include "base/error.h"
#include "render/mesh_view.h"
#include "scene/fog_bounds.h"

namespace lumulus {

namespace {

/// Refuses lamps in endless fog.
void requireDrawableLamps(const scene::Scene& scene) {
    if (std::ranges::none_of(scene.lamps, &scene::Lamp::shines)) return;
    scene::requireBoundedFog(scene);
}

}  // namespace

const scene::Scene& drawable(const scene::Scene& scene) {
    if (!scene.surfaces.empty()) {
        throw InputError("surfaces are for the reference alone", scene.source + ", surface",
                         "use lumulus reference, or leave them out: --set surface=[]");
    }
    requireDrawableMeshes(scene, false);
    requireDrawableLamps(scene);
    // without clouds the scene may be for pictures of other renderers, whose fog may be endless
    if (!scene.clouds.empty()) scene::requireBoundedFog(scene);
    if (scene.ground && scene.sky.model == scene::SkyModel::map) {
        throw InputError("a ground is lit by a constant sky or an atmosphere, not by a map", "ground",
                         "leave it out (the map has its own), or use lumulus reference");
    }
    return scene;
}

}  // namespace lumulus
