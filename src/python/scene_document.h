#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/load.h"
#include "scene/quality.h"
#include "scene/scene.h"
#include "scene/voxels.h"

namespace lumulus::python {

/// A scene as a program has it: the text, what has been set since, and densities in memory.
class SceneDocument {
  public:
    /// Errors: those of scene::parseScene.
    SceneDocument(scene::SceneText text, std::optional<scene::Quality> quality, double frame);

    /// Sets keys, each as `section.key=value` (scene::loadScene), all or none of them. Errors: as above.
    void set(std::span<const std::string> overrides);
    /// Puts densities in the place of those of a cloud, by its name or index. Errors: InputError where there is none.
    void setDensity(std::shared_ptr<const scene::Voxels> voxels, const std::string& cloud);

    const scene::Scene& scene() const { return scene_; }
    /// The scene that `lumulus render` makes of the same text: with bounds of its fog and places of its clouds checked.
    /// Errors: InputError.
    scene::Scene placed() const;

  private:
    scene::Scene parse() const;

    scene::SceneText text_;
    std::optional<scene::Quality> quality_;
    double frame_;
    std::vector<std::string> overrides_;
    std::map<std::size_t, std::shared_ptr<const scene::Voxels>> voxels_;  ///< by cloud
    scene::Scene scene_;
};

}  // namespace lumulus::python
