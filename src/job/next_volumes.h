#pragma once

#include <future>
#include <optional>

#include "base/interrupt.h"
#include "scene/scene.h"
#include "volume/known_fields.h"
#include "volume/load.h"

namespace lumulus::job {

/// Reads the densities of frames, those of the next one on a thread of its own, while a frame is rendered. Dense fields
/// that the next frame shows too are kept for it; besides these it holds those of one frame at most.
class NextVolumes {
  public:
    explicit NextVolumes(Check check) : check_(std::move(check)) {}
    ~NextVolumes();

    /// Begins to read those of a scene, once what was read before is taken or no longer wanted.
    void begin(const scene::Scene& scene);
    /// Drops all: the next frame has no use for what was read.
    void drop();
    /// Those of a scene, which were read before or are now. Errors: those of loadClouds().
    CloudVolumes take(const scene::Scene& scene);

  private:
    void wait();
    CloudVolumes read(const scene::Scene& scene);

    Check check_;
    std::optional<scene::Scene> scene_;
    std::future<CloudVolumes> volumes_;
    KnownFields known_;  ///< of the scene that was read last; that of the thread while it reads
};

}  // namespace lumulus::job
