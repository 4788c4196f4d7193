#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "renderer.h"
#include "scene/scene.h"
#include "service/net/config.h"
#include "service/render/cost_model.h"
#include "service/render/scheduler.h"

namespace lumulus::service {

/// Thrown where what a client asked for is not wanted any more.
struct Cancelled {};

/// Thrown where a scene takes longer than the limits allow; its renderer is of no more use.
class TooSlow : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A scene that is served: its renderer, its light, and what its work costs. Not for several threads.
class SceneSlot {
  public:
    /// Loads, prepares, and draws a small picture, so that shaders are compiled and costs known. `abandoned` is asked
    /// between the steps; what it throws ends it. Errors: InputError, Error, TooSlow.
    SceneSlot(std::string slotKey, const scene::Scene& scene, const Config& config,
              const std::function<void()>& abandoned);

    const std::string& key() const { return key_; }
    const scene::Scene& scene() const { return scene_; }
    /// {"name", "width", "height", "generations", "photons_each", …}: the reply to load_scene.
    const std::string& description() const { return description_; }
    /// {"generations", "current", …}
    nlohmann::json state() const;

    /// Errors: RequestError where the scene cannot have such a light.
    void apply(const LightChange& light);

    /// Whether the ring lacks generations under the light of now.
    bool wantsGeneration() const { return generationsMissing() > 0; }
    int generationsMissing() const;
    /// Errors: TooSlow.
    void traceGeneration();
    double traceMs() const { return costs_.traceMs(); }
    /// Whether pictures show a coarse sun.
    bool wantsSun() const { return renderer_->sunReduction() > 1; }
    /// Does some of what is missing.
    void sharpenSun();
    double sharpenMs() const { return costs_.sunMs(sharpenShare()); }
    Clock::time_point lastTraced() const { return lastTraced_; }
    /// Changes with all that changes pictures of the same view.
    std::uint64_t revision() const { return revision_; }

    /// Whether another generation belongs into this frame before it is drawn.
    bool needsGeneration(const Job& job, const FrameRequest& frame) const;

    struct Frame {
        Message reply;
        bool reduced = false, late = false;
        double seconds = 0.0;  ///< since the request came
    };
    /// The client's picture through the fog of the scene. Errors: Cancelled, RequestError, TooSlow.
    Frame composite(const Job& job, const Composite& composite);
    /// Errors: Cancelled, RequestError, TooSlow.
    Frame draw(const Job& job, const FrameRequest& frame);

  private:
    struct Drawn;
    /// While it lives, work for a job ends where the job is cancelled or takes too long.
    class Guarded {
      public:
        Guarded(SceneSlot& slot, const std::atomic<bool>* cancelled);
        Guarded(const Guarded&) = delete;
        Guarded& operator=(const Guarded&) = delete;
        ~Guarded();

      private:
        SceneSlot& slot_;
    };

    std::vector<View> viewsOf(const FrameRequest& frame) const;
    Drawn drawViews(const FrameRequest& frame, const std::vector<View>& views, int reduction);
    void noteCosts(const Drawn& drawn, std::uint64_t rays);
    std::uint64_t raysOf(const std::vector<View>& views) const;
    void learnCosts();
    nlohmann::json shownDescription() const;
    std::vector<std::string> repeatOverrides() const;
    std::map<std::string, double> tracePasses();
    void probe();
    void guard() const;
    double sharpenShare() const;
    double allowSun(std::optional<double> milliseconds, double picture);

    nlohmann::json describe() const;

    /// Of the small pictures by which a scene is known.
    static constexpr int probeWidth = 96;

    std::string key_;
    std::string description_;
    scene::Scene scene_;   // with the light of now
    scene::Scene loaded_;  // as it was loaded
    const Limits& limits_;
    std::function<void()> abandoned_;
    const std::atomic<bool>* cancelled_ = nullptr;  // of the job that is drawn
    Clock::time_point deadline_ = Clock::time_point::max();
    std::unique_ptr<Renderer> renderer_;
    CostModel costs_;
    glm::dvec3 wind_{0.0};
    std::uint64_t revision_ = 1;
    std::deque<Clock::time_point> tracedAt_;  // of the generations in the ring
    Clock::time_point lastTraced_, lastSharpened_;
    std::map<std::string, double> passTotals_;  // of the passes of photons, when the last frame was made
    struct Probe {
        LayeredImage image;
        int generations = 0;
    };
    std::optional<Probe> probe_;
    double noise_ = -1.0;  // relMSE times photons; negative: not known yet
};

/// Lowers the budgets of memory to what the service gives. Errors: InputError for what goes beyond other limits.
/// Errors: InputError.
void applyLimits(scene::Scene& scene, const Limits& limits);

}  // namespace lumulus::service
