#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "volume/field_places.h"

namespace lumulus {

/// Instances that the memory budget of a scene's light has room for: each has 30 collectors at least.
std::size_t mostInstances(const scene::Scene& scene);

/// Where the clouds of fields are, for the scenes of a sequence: a field that two scenes have is placed once. Keeps
/// those of the last two scenes.
class KnownPlaces {
  public:
    void beginScene() { ++scene_; }
    /// As placesOf(). Valid until the next call.
    const std::vector<FieldPlace>& of(const scene::Field& field, const std::string& name, std::size_t most);

  private:
    struct Known {
        scene::Field field;
        std::size_t most = 0;
        std::uint64_t scene = 0;  ///< the last one that had it
        std::vector<FieldPlace> places;
    };
    std::vector<Known> known_;
    std::uint64_t scene_ = 0;
};

/// The scene with a cloud for each row of `instances` and each cloud of a field, in their order: NAME[0], NAME[1] and
/// so on, with places of their own. Clouds of one source still share one asset. A scene without such stays as it is,
/// and a scene that was placed stays so. Renderer and reference both need placed scenes. Errors: InputError for a bad
/// file of places and for more instances than there is room for. `known`: places that are known, and then have those of
/// this scene.
scene::Scene placeClouds(scene::Scene scene, KnownPlaces* known = nullptr);

}  // namespace lumulus
