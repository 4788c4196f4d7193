#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "job/next_volumes.h"
#include "light/map_file/map_file.h"
#include "render/frame_light.h"
#include "render/kept_clouds.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace lumulus::job {

/// Renders the frames of a sequence one after the other on one device, and keeps from one frame to the next what does
/// not change: all photons where only the camera moves, the clouds where only lights change, and what depends on
/// densities alone where clouds move. Each frame has the bits
/// that a process of its own would give it, unless scenes ask for `photon_map.transfer`: then a frame goes on with the
/// light of those before it.
class FrameRenderer {
  public:
    /// `options.progressive` and `options.keepRing` are not for sequences.
    explicit FrameRenderer(const RendererOptions& options);

    /// A renderer of the scene with all photons that it asks for; for the next picture only. `number`: place of the
    /// frame in the sequence, by which frames that go on with light have photons of their own. The densities of
    /// `next` are read meanwhile, if it is not null. Errors: those of Renderer, after which the next scene begins anew.
    Renderer& of(const scene::Scene& scene, std::int64_t number, const scene::Scene* next);
    /// Keeps nothing for the next frame: after a picture of the renderer has failed.
    void forget();

    /// The map of the last frame, for resume(); none where it has no photons.
    std::optional<map_file::MapFile> map();
    /// The number of the frame that a map of map() is of. Errors: InputError where it is of another sequence.
    static std::int64_t numberOf(const map_file::MapFile& map, const scene::Scene& scene);
    /// Takes up a sequence behind frame `number`, whose map was kept. Errors: InputError where the map is not of this
    /// scene.
    void resume(const scene::Scene& scene, std::int64_t number, const map_file::MapFile& map);

  private:
    void makeRenderer(const scene::Scene& scene, std::int64_t number);
    void make(const scene::Scene& scene, std::int64_t number, const scene::Scene* next);
    void carry(const scene::Scene& before, const scene::Scene& now);

    RendererOptions options_;
    NextVolumes next_;
    KeptClouds kept_;                     ///< of the last frame whose clouds were made
    const scene::Scene* made_ = nullptr;  ///< scene of the renderer that is being made
    std::optional<scene::Scene> shown_;   ///< of `renderer_`
    std::unique_ptr<Renderer> renderer_;
    std::optional<FrameLight> light_;  ///< of the last frame, where the next one goes on with it
};

/// Whether a scene has the light of another one: they differ in what only pictures see.
bool haveSameLight(const scene::Scene& a, const scene::Scene& b);
/// Whether a scene has the clouds of another one, as they are prepared: they differ in lights, air, fog and views.
bool haveSameClouds(const scene::Scene& a, const scene::Scene& b);

}  // namespace lumulus::job
