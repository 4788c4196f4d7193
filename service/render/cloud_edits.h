#pragma once

#include <span>
#include <vector>

#include "render/cloud_origin.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// Index of a cloud in the scene. Errors: RequestError `not_found` at `where` where the scene has no such cloud.
std::size_t findCloud(const scene::Scene& scene, const CloudReference& cloud, const std::string& where = "cloud");

/// A scene whose clouds have been changed.
struct EditedClouds {
    scene::Scene scene;                            ///< every cloud has a name, which it keeps
    std::vector<CloudOrigin> origins;              ///< of its clouds, among those of the scene before
    std::vector<std::optional<glm::dvec3>> moves;  ///< of clouds that were there before [m]
    bool rebuilds = false;                         ///< whether there is more than extinctions and places that differ
};

/// Changes the clouds of a scene, one edit after the other. Errors: RequestError with the place of the edit, as
/// "clouds[1].like": `not_found` for a cloud that is not there (any more), `bad_request` for a name that another cloud
/// has or a g for a phase function that has none, `too_large` for more clouds than a scene may have.
EditedClouds editClouds(const scene::Scene& before, std::span<const CloudEdit> edits);

/// Gives clouds that were added to `scene`, which comes from `before`, the places that they have in its renderer, so
/// that it can be loaded again.
void placeAdded(scene::Scene& scene, const Renderer& renderer, std::span<const CloudOrigin> origins,
                const scene::Scene& before, const Renderer& rendererBefore);

}  // namespace lumulus::service
