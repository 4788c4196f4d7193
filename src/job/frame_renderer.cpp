#include "job/frame_renderer.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/interrupt.h"
#include "service/values/sha256.h"
#include "volume/motion.h"

namespace lumulus::job {

namespace {

/// `b` as seen like `a`, where the detail of clouds does not depend on the view: that of a single one.
scene::Scene seenLike(const scene::Scene& a, scene::Scene b) {
    if (b.clouds.size() <= 1) {
        b.camera = a.camera;
        b.image = a.image;
    }
    b.image.exposure = a.image.exposure;
    b.image.exposureMode = a.image.exposureMode;
    b.image.ev100 = a.image.ev100;
    b.image.toneMap = a.image.toneMap;
    b.image.background = a.image.background;
    b.source = a.source;
    b.seconds = a.seconds;  // clouds lie where it has carried them
    return b;
}

/// Of the light of a frame that goes on with others: no map of one picture has it.
std::string fingerprintOf(Renderer& renderer, const scene::Scene& scene) {
    const std::string text = "transfer " + renderer.lightFingerprint(scene);
    return service::sha256Hex(std::as_bytes(std::span(text)));
}

InputError otherSequence() {
    return {"the photon map is of another sequence", "--skip-existing", "it is traced again"};
}

}  // namespace

bool haveSameLight(const scene::Scene& a, const scene::Scene& b) {
    return seenLike(a, b) == a;
}

bool haveSameClouds(const scene::Scene& a, const scene::Scene& b) {
    if (a.sun.angularDiameter != b.sun.angularDiameter) return false;  // tables of the media hold it
    scene::Scene other = seenLike(a, b);
    other.sun = a.sun;
    other.moon = a.moon;
    other.sky = a.sky;
    other.time = a.time;
    other.ground = a.ground;
    other.fog = a.fog;
    return other == a;
}

FrameRenderer::FrameRenderer(const RendererOptions& options) : options_(options), next_(options.check) {
    options_.read = [this](const scene::Scene&) { return next_.take(*made_); };
    options_.kept = &kept_;
}

void FrameRenderer::makeRenderer(const scene::Scene& scene, std::int64_t number) {
    scene::Scene traced = scene;
    made_ = &scene;
    if (scene.photonMap.transfer) traced.photonMap.firstGeneration += number * scene.photonMap.generations;
    if (renderer_ && haveSameClouds(*shown_, scene)) {
        renderer_ = std::make_unique<Renderer>(traced, *renderer_, options_);
    } else {
        if (renderer_) options_.context = renderer_->context();
        renderer_.reset();  // its memory is the next one's
        renderer_ = std::make_unique<Renderer>(traced, options_);
    }
}

void FrameRenderer::make(const scene::Scene& scene, std::int64_t number, const scene::Scene* next) {
    makeRenderer(scene, number);
    if (next != nullptr && !haveSameClouds(scene, *next))
        next_.begin(*next);
    else
        next_.drop();
    for (int done = 0; done < renderer_->generationsWanted(); ++done) {
        stopIfInterrupted();
        renderer_->traceGeneration();
    }
    if (scene.photonMap.transfer) {
        if (light_) carry(*shown_, scene);
        light_ = renderer_->frameLight(scene);
    }
    shown_ = scene;
}

/// Goes on with the light of the frame before, which counts the less the older it is.
void FrameRenderer::carry(const scene::Scene& before, const scene::Scene& now) {
    constexpr int unknown = 4;  // frames, where the motion is not known
    if (before.clouds.size() != now.clouds.size()) return;
    const vdb::ReadLimits limits{options_.check};
    std::vector<photon::Way> ways(now.clouds.size());
    int frames = scene::mostFrames(now.photonMap);
    for (const photon::CarriedCloud& cloud : light_->plan.clouds) {
        const std::size_t i = cloud.number;
        CloudMotion motion = motionBetween(before.clouds[i], now.clouds[i], {cloud.toCloud, cloud.size}, limits);
        if (!motion.goesOn) return;
        if (!motion.known && now.photonMap.transferFrames == 0) frames = unknown;
        ways[i] = std::move(motion.way);
    }
    const double framesBefore = light_->plan.generations / before.photonMap.generations;
    const int more = std::min(frames, static_cast<int>(std::lround(framesBefore)) + 1) - 1;
    renderer_->carryOn(now, *light_, ways, more * now.photonMap.generations);
}

Renderer& FrameRenderer::of(const scene::Scene& scene, std::int64_t number, const scene::Scene* next) {
    if (renderer_ && !scene.photonMap.transfer && haveSameLight(*shown_, scene)) return *renderer_;
    try {
        make(scene, number, next);
    } catch (...) {
        forget();
        throw;
    }
    return *renderer_;
}

void FrameRenderer::forget() {
    renderer_.reset();
    light_.reset();
    kept_ = KeptClouds();
}

std::optional<map_file::MapFile> FrameRenderer::map() {
    if (!light_ || !renderer_) return std::nullopt;
    return map_file::MapFile{fingerprintOf(*renderer_, *shown_), light_->sums};
}

std::int64_t FrameRenderer::numberOf(const map_file::MapFile& map, const scene::Scene& scene) {
    const auto each = static_cast<std::int64_t>(scene.photonMap.generations);
    const std::int64_t first =
        map.sums.generations.empty()
            ? -1
            : static_cast<std::int64_t>(map.sums.generations.front().first) - scene.photonMap.firstGeneration;
    if (first < 0 || first % each != 0 || map.sums.generations.size() != 1) throw otherSequence();
    return first / each;
}

void FrameRenderer::resume(const scene::Scene& scene, std::int64_t number, const map_file::MapFile& map) {
    makeRenderer(scene, number);
    if (map.fingerprint != fingerprintOf(*renderer_, scene)) {
        forget();
        throw otherSequence();
    }
    renderer_->goOnFrom(map.sums);
    light_ = renderer_->frameLight(scene);
    shown_ = scene;
}

}  // namespace lumulus::job
