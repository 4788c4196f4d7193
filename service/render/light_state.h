#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "render/renderer.h"
#include "scene/scene.h"
#include "service/values/requests.h"
#include "service/values/results.h"

namespace lumulus::service {

/// Whether a change makes a light that differs from the one that a scene was loaded with. `cloud`: whose extinction
/// changes; all without it.
bool changesLight(const scene::Scene& scene, const LightChange& change, std::optional<std::size_t> cloud);

/// The light of a renderer that clients change, and the one of before, which comes back where the new one proves to
/// be too much work.
class LightState {
  public:
    /// Both must outlive this.
    LightState(const scene::Scene& scene, Renderer& renderer) : scene_(scene), renderer_(renderer) {}

    SceneLight now() const;
    /// Returns whether anything changed. `cloud`: whose extinction changes; all without it. Errors: RequestError where
    /// the scene cannot have such a light.
    bool apply(const LightChange& change, std::optional<std::size_t> cloud);
    /// The light of now has been traced: it is the one that revert() brings back from now on.
    void prove() {
        before_.reset();
        otherExtinction_ = false;
    }
    /// Whether an extinction has changed since: nobody knows what tracing the light of now takes.
    bool costUnknown() const { return otherExtinction_; }
    /// Brings back the light that was proved last. Returns false where that is the light of now.
    bool revert();

  private:
    struct Light {
        scene::Sun sun;
        std::vector<double> extinctions;  ///< of all clouds
    };
    Light all() const;

    const scene::Scene& scene_;
    Renderer& renderer_;
    std::optional<Light> before_;
    bool otherExtinction_ = false;
};

}  // namespace lumulus::service
