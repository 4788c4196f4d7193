#pragma once

#include <future>
#include <optional>

#include "base/interrupt.h"
#include "scene/scene.h"
#include "volume/load.h"

namespace lumulus::job {

/// Reads the densities of the next frame on a thread of its own, while a frame is rendered. Holds those of one frame at
/// most.
class NextVolumes {
  public:
    explicit NextVolumes(Check check) : check_(std::move(check)) {}
    ~NextVolumes();

    /// Begins to read those of a scene, once what was read before is taken or no longer wanted.
    void begin(const scene::Scene& scene);
    /// Gives away what was read for this scene. Returns false where it was not, or where that failed: who then reads it
    /// meets the error.
    bool take(const scene::Scene& scene, CloudVolumes& volumes);

  private:
    void drop();

    Check check_;
    std::optional<scene::Scene> scene_;
    std::future<CloudVolumes> volumes_;
};

}  // namespace lumulus::job
