#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "render/shown_densities.h"
#include "scene/scene.h"
#include "service/render/bias_desk.h"
#include "service/render/cloud_edits.h"
#include "service/render/cost_model.h"
#include "service/render/exposure_desk.h"
#include "service/render/light_state.h"
#include "service/render/media_source.h"
#include "service/render/noise.h"
#include "service/render/render_config.h"
#include "service/render/scene_source.h"
#include "service/render/scheduler.h"
#include "service/render/viewed_light.h"
#include "service/render/work_guard.h"
#include "service/telemetry/memory_budget.h"
#include "service/values/results.h"

namespace lumulus::service {

struct SceneBefore;

/// A scene that is served: its renderer, and what its work costs. The renderer owns light, extinction and wind; the
/// scene as it was loaded never changes. Not for several threads, but for key(), owner(), source(),
/// scene() and description().
class SceneSlot {
  public:
    /// Loads and prepares the scene, or takes copies of densities that it shows and another scene has prepared, and
    /// draws a small picture, so that shaders are compiled and costs known. `abandoned` is called between the steps;
    /// what it throws ends the load. `begins` is told which step begins. Both may be empty. Errors: InputError, Error,
    /// TooSlow.
    SceneSlot(const SourcedScene& found, const RenderConfig& config, const std::function<void()>& abandoned,
              const std::function<void(std::string_view)>& begins = {}, DensityCopies copies = {});

    /// The scene of another slot with light of its own for a client: as the scene has it, and no photons yet. Density,
    /// device and programs are shared, so that nothing is loaded and one thread has to use both. With clouds that are
    /// `edited`, those of sceneNow() of `shown`, it goes on with light and photons of `shown`. Errors: Error,
    /// InputError.
    SceneSlot(const std::shared_ptr<SceneSlot>& shown, ClientId owner, const EditedClouds* edited = nullptr);

    const std::string& key() const { return key_; }
    /// The client to whom the light belongs; none where clients share it.
    std::optional<ClientId> owner() const { return owner_; }
    /// Makes the light a client's. Before the scene is held.
    void giveTo(ClientId client) { owner_ = client; }
    /// Whose density is shared; null where the scene was loaded.
    const std::shared_ptr<SceneSlot>& source() const { return source_; }
    /// Whether another slot shows the same scene, if under another light or with other clouds.
    bool isOfSameScene(const SceneSlot& other) const {
        const SceneSlot *own = source_ ? source_.get() : this, *its = other.source_ ? other.source_.get() : &other;
        return own == its;
    }
    /// The scene as it was loaded; where clouds were edited, as they were then.
    const scene::Scene& scene() const { return scene_; }
    /// What asked for it, with the text that a name stands for.
    const std::shared_ptr<const LoadScene>& load() const { return load_; }
    /// The scene as it was when it was loaded.
    const SceneDescription& description() const { return description_; }
    SceneState state() const;
    /// The scene under the light of now.
    scene::Scene sceneNow() const;

    /// `cloud`: whose extinction changes; all without it. Errors: RequestError where the scene cannot have such a
    /// light.
    void apply(const LightChange& change, std::optional<std::size_t> cloud = {});

    /// Finds other fog for the scene, on any thread. Errors: InputError where the scene has none.
    FogMaker fogMaker() const { return renderer_->fogMaker(); }
    const std::vector<scene::FogMedium>& fogMedia() const { return renderer_->fogMedia(); }
    /// What of the media clients have changed.
    const MediaKeys& mediaKeys() const { return mediaKeys_; }
    bool hasFog(const NewFog& fog) const { return renderer_->hasFog(fog); }
    /// Shows fog that fogMaker() has found for media with such keys. When canChange().
    void apply(const NewFog& fog, MediaKeys keys) {
        mediaKeys_ = std::move(keys);
        if (renderer_->setFog(fog)) ++revision_;
    }

    /// Brings back the light of before, where no generation was finished since it changed. Returns whether it did.
    bool revert() {
        const bool reverted = light_->revert();
        if (reverted) ++revision_;
        dropsGeneration_ = dropsGeneration_ || (reverted && tracing_ > 0);
        return reverted;
    }

    /// Whether the ring lacks generations under the light of now.
    bool wantsGeneration() const { return renderer_->generations().current < renderer_->generationsWanted(); }
    /// Traces a generation, unless the light changes so that it is of no use. Errors: TooSlow.
    void traceGeneration();
    double traceMs() const { return costs_.traceMs(); }
    /// Whether a generation is known to be short enough to trace it between the steps of other work.
    bool tracesQuickly() const {
        constexpr double longest = 150.0;  // ms
        return costs_.traceMs() > 0.0 && costs_.traceMs() <= longest && !light_->costUnknown();
    }
    /// Whether work on the scene is at a step at which a picture of it can be made: also within one other, unless a
    /// filter sees all of that. Light can be changed within none, and a generation traced within no other.
    bool canDraw() const { return drawing_ == 0 || (drawing_ < viewers_.size() && scene_.fog.media.empty()); }
    bool canChange() const { return drawing_ == 0; }
    bool canTrace() const { return drawing_ == 0 && !tracing_; }
    /// Whether pictures show the sun by a shadow volume of reduced resolution.
    bool wantsSun() const { return renderer_->sunReduction() > 1; }
    /// Makes a part of the shadow volume's full resolution.
    void sharpenSun();
    double sharpenMs() const { return costs_.sunMs(sharpenShare()); }
    Clock::time_point lastTraced() const { return lastTraced_; }
    /// What light meets in the scene as it is now, and the direction towards its sun.
    query::Media media() { return renderer_->media(); }
    const glm::dvec3& sunDirection() const { return renderer_->sun().directionTo; }
    /// A number that changes with everything that changes pictures of the same view.
    std::uint64_t revision() const { return revision_; }

    /// Whether another generation belongs into this frame before it is drawn.
    bool needsGeneration(const Job& job, const FrameRequest& frame) const;
    /// Errors: Cancelled, RequestError, TooSlow.
    FrameResult draw(const Job& job, const FrameRequest& frame);
    /// Draws the client's picture through the fog of the scene. Errors: Cancelled, RequestError, TooSlow.
    CompositeResult composite(const Job& job, const Composite& composite);
    /// Irradiance of a plane that faces the sun, then the coefficients of ambient light (AmbientLight) at a point [m].
    /// Ends where it is cancelled. Errors: Cancelled, InputError, TooSlow.
    std::vector<glm::dvec3> ambientAt(const glm::dvec3& point, const std::atomic<bool>* cancelled);
    /// When the error of the pictures that were drawn last is to be measured, if nothing changes; none where it is
    /// known or cannot be told.
    std::optional<Clock::time_point> biasDue() const;
    /// Draws a small picture of what was drawn last, to be measured; none where densities are too large for paths.
    /// Errors: Error, TooSlow.
    std::optional<BiasJob> beginBias();
    /// Takes what was found for pictures of a revision(). Returns whether frames have it from now on.
    bool keepBias(std::uint64_t revision, const std::optional<Bias>& found);
    /// Takes what encoding a picture of this scene cost.
    void noteEncoded(Encoding encoding, double milliseconds, std::uint64_t pixels) {
        costs_.encoded(encoding, milliseconds, pixels);
    }

    /// What a scene with another density goes on with. When canChange().
    SceneBefore before();
    /// Bytes of its light on the host.
    std::uint64_t lightBytes() const { return renderer_->frameLightBytes(); }
    /// What another scene needs not load. When canChange().
    const ShownDensities& densities() const { return *densities_; }
    /// Goes on with another scene's light, which is shown while this one is loaded, along the motion that goOn() tells
    /// of, traces a generation, so that it is known what that takes, and draws what was drawn there. Returns whether
    /// there was light to go on with. While it is loaded. Errors: those of goOn(), of traceGeneration() and of draw().
    bool goOnFrom(const SceneBefore& before, double seconds);
    /// Is shown to a client in the place of `shown`, whose scene it is but for the density, under the light that has
    /// changed meanwhile: light of its own that goes back to the same scene. Errors: InputError.
    void takePlaceOf(const std::shared_ptr<SceneSlot>& shown, ClientId owner);

    /// Draws what the scene holds by now from the budget, and keeps that in step from now on. Returns false where the
    /// budget does not have it. Before the scene is held.
    bool holdMemory(MemoryBudget& budget);
    /// Bytes of the device that the scene holds, with all lights of it.
    std::uint64_t heldBytes() const { return renderer_->statistics().gpuBytesHeld; }
    /// Bytes that the pictures of a frame take until they are encoded.
    std::uint64_t frameBytes(const FrameRequest& frame) const;
    /// The same of a picture of so many pixels.
    static std::uint64_t pictureBytes(std::uint64_t pixels) {
        constexpr std::uint64_t layers = 12, encoded = 16;  // colour, cloud, transmittance, depths; floats of colour
        return pixels * (layers * sizeof(float) + encoded);
    }
    /// `step` is called between the steps of all work from now on, and returns the seconds that the next one should
    /// take: on the thread that draws, never on those that help it. Before the scene is held.
    void onStep(const std::function<double()>& step);

  private:
    /// Counts work of a kind while it lives.
    class Counted {
      public:
        explicit Counted(std::size_t& count) : count_(count) { ++count_; }
        Counted(const Counted&) = delete;
        Counted& operator=(const Counted&) = delete;
        ~Counted() { --count_; }

      private:
        std::size_t& count_;
    };
    /// What looks at the scene, at all views one after the other. It is gone before the renderer.
    struct Looking {
        ViewState state;
        ViewedLight viewed;
    };
    /// Who looks at whole pictures and at reduced ones, whose light is coarse.
    struct Viewer {
        Looking whole, reduced;
        Looking& of(int reduction) { return reduction > 1 ? reduced : whole; }
    };
    Viewer& viewer() { return viewers_[std::min(drawing_, viewers_.size() - 1)]; }
    const Viewer& viewer() const { return viewers_[std::min(drawing_, viewers_.size() - 1)]; }
    void forgetViewed() {
        for (Viewer& each : viewers_)
            for (Looking* looking : {&each.whole, &each.reduced}) looking->viewed.forget();
    }

    /// What is known of the error of pictures of one view.
    struct KnownBias {
        std::uint64_t revision = 0;
        View view;
        std::optional<Bias> value;
        std::shared_ptr<std::atomic<bool>> old;  ///< BiasJob's
    };
    void noteSeen(const std::vector<View>& views, int reduction);
    bool biasIsOfNow() const;

    RendererOptions options();
    void countMemory() { memory_->resize(heldBytes()); }
    std::vector<View> viewsOf(const std::vector<ViewRequest>& requests) const;
    CostModel::Work workFor(const std::vector<View>& views, double time) const;
    View smallView() const;
    void learnCosts();
    void probeNoise();
    double sharpenShare() const;
    double allowSun(std::optional<double> milliseconds, double picture);
    double drawViews(Viewer& viewer, const std::vector<View>& views, int reduction, FrameResult& result);
    void noteDrawn(const FrameResult& result, CostModel::Work work, double enlarging);
    std::vector<PassTime> tracePasses();
    PhotonState photons() const {
        const Generations ring = renderer_->generations();
        return {ring.first, ring.count, ring.current, ring.photonsEach};
    }
    /// Whether most photons have the light of now.
    bool hasLightOfNow() const { return 2 * photons().current >= photons().generations; }
    SceneShown shown() const;

    std::shared_ptr<SceneSlot> source_;
    std::string key_;
    std::optional<ClientId> owner_;
    std::shared_ptr<const LoadScene> load_;
    scene::Scene scene_;  ///< the sun is the map's where it has one; never changes after the load
    const RenderLimits& limits_;
    WorkGuard guard_;
    std::size_t tracing_ = 0, drawing_ = 0;
    bool dropsGeneration_ = false;                                                    ///< that is traced
    std::shared_ptr<ShownDensities> densities_ = std::make_shared<ShownDensities>();  ///< of all lights of them
    std::unique_ptr<Renderer> renderer_;
    std::array<Viewer, 2> viewers_;  ///< the second one of pictures that come within another
    std::vector<View> seen_;         ///< that were drawn last
    int seenReduction_ = 1;
    std::uint64_t seenRevision_ = 0;
    Clock::time_point restsSince_;  ///< that views and revision are the same
    KnownBias bias_;
    double time_ = 0.0;                ///< of the wind, of the picture that is drawn [s]
    std::optional<LightState> light_;  ///< of the renderer
    MediaKeys mediaKeys_;
    std::shared_ptr<MemoryBudget::Share> memory_ = std::make_shared<MemoryBudget::Share>();  ///< of the whole device
    SceneDescription description_;
    CostModel costs_;
    NoiseEstimate noise_;
    ExposureDesk exposures_;
    std::uint64_t revision_ = 1;
    std::deque<Clock::time_point> tracedAt_;  // of the generations in the ring
    Clock::time_point lastTraced_, lastSharpened_;
    std::map<std::string, double> passTotals_;  // of the passes of photons, when the last frame was made
};

}  // namespace lumulus::service
