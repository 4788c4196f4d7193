// How a scene that is served makes its frames.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/error.h"
#include "base/version.h"
#include "service/protocol/encode.h"
#include "service/protocol/json_fields.h"
#include "service/render/resample.h"
#include "service/render/scene_slot.h"
#include "service/values/sha256.h"

namespace lumulus::service {

using nlohmann::json;

namespace {

constexpr std::array<std::string_view, 4> photonPasses{"trace", "sort", "gather", "accumulate"};
/// Once for each direction of the sun: not what a frame costs.
constexpr std::array<std::string_view, 1> sunPasses{"sun depth"};
constexpr std::array<std::string_view, 4> pixelPasses{"march", "billboards", "interpolate", "interpolate halves"};

template <std::size_t N>
bool among(const std::array<std::string_view, N>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

double milliseconds(Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

View viewOf(const ViewRequest& request, const View& sceneView) {
    View view = sceneView;
    const CameraRequest& camera = request.camera;
    if (camera.position) view.camera.position = camera.position;
    if (camera.target) view.camera.target = camera.target;
    view.camera.up = camera.up.value_or(view.camera.up);
    view.camera.verticalFov = camera.verticalFov.value_or(view.camera.verticalFov);
    view.camera.projection = camera.projection.value_or(view.camera.projection);
    view.orientation = camera.orientation;
    view.frustum = camera.frustum;
    // the orientation says where it looks; the target only must not be the position
    if (camera.orientation) view.camera.target = *view.camera.position - glm::dvec3(0.0, 0.0, 1.0);
    view.image.width = request.width.value_or(view.image.width);
    view.image.height = request.height.value_or(view.image.height);
    view.tile = request.tile;
    return view;
}

std::uint64_t pixelsOf(const std::vector<View>& views) {
    std::uint64_t pixels = 0;
    for (const View& view : views) {
        const Tile tile = drawnTile(view);
        pixels += static_cast<std::uint64_t>(tile.width) * static_cast<std::uint64_t>(tile.height);
    }
    return pixels;
}

json hashOf(const std::vector<std::byte>& payload, bool wanted) {
    return wanted ? json("sha256:" + sha256Hex(payload)) : json();
}

}  // namespace

struct SceneSlot::Drawn {
    std::vector<std::byte> payload;
    json views = json::array();
    std::map<std::string, double> passes;
    double drawMs = 0.0, encodeMs = 0.0;
};

bool SceneSlot::needsGeneration(const Job& job, const FrameRequest& frame) const {
    if (!wantsGeneration()) return false;
    const Generations shown = renderer_->generations();
    if (frame.budget.photons)
        return static_cast<std::uint64_t>(shown.current) * shown.photonsEach < *frame.budget.photons ||
               (shown.current == 0 && *frame.budget.photons > 0);
    if (!frame.budget.milliseconds) return !job.stream;  // a stream gets what is there
    const double left = *frame.budget.milliseconds - milliseconds(Clock::now() - job.arrived);
    const std::vector<View> views = viewsOf(frame);
    double after = costs_.drawMs(views.size(), raysOf(views)) + costs_.encodeMs(frame.encoding, pixelsOf(views));
    if (renderer_->sunReduction() == 0) after += costs_.sunMs(CostModel::sunShare(CostModel::sunReductions.back()));
    return costs_.traceMs() > 0.0 && costs_.traceMs() + after <= left;
}

std::vector<View> SceneSlot::viewsOf(const FrameRequest& frame) const {
    std::vector<View> views;
    try {
        for (const ViewRequest& request : frame.views) {
            views.push_back(viewOf(request, renderer_->sceneView()));
            drawnTile(views.back());
            makeCamera(views.back(), renderer_->bounds());
        }
    } catch (const InputError& e) {
        throw RequestError("bad_request", e.what());
    }
    if (pixelsOf(views) > limits_.requests.pixels)
        throw RequestError("too_large", fmt::format("a frame may hold {} pixels here", limits_.requests.pixels));
    return views;
}

std::uint64_t SceneSlot::raysOf(const std::vector<View>& views) const {
    std::uint64_t rays = 0;
    for (const View& view : views) {
        const auto across = static_cast<std::uint64_t>(renderer_->raysAcross(view));
        rays += pixelsOf({view}) * across * across;
    }
    return rays;
}

/// A small frame, thrown away: compiles shaders, and shows what pictures cost.
void SceneSlot::learnCosts() {
    FrameRequest frame;
    const scene::Image& image = scene_.image;
    frame.views.resize(1);
    frame.views[0].width = probeWidth;
    frame.views[0].height = std::clamp(probeWidth * image.height / image.width, 1, 4 * probeWidth);
    drawViews(frame, viewsOf(frame), 1);
    const std::vector<View> views = viewsOf(frame);
    noteCosts(drawViews(frame, views, 1), raysOf(views));
}

SceneSlot::Drawn SceneSlot::drawViews(const FrameRequest& frame, const std::vector<View>& views, int reduction) {
    Drawn drawn;
    const EncodeOptions options{frame.products, frame.encoding, frame.quality,
                                frame.exposure.value_or(scene_.image.exposure)};
    for (const View& view : views) {
        const auto start = Clock::now();
        const View small = reduction > 1 ? reducedView(view, reduction) : view;
        LayeredImage image = renderer_->draw(small);
        const int width = image.width, height = image.height;
        if (reduction > 1) image = enlarged(image, view, small);
        const auto made = Clock::now();
        for (const PassTime& pass : renderer_->statistics().passes)
            if (!among(photonPasses, pass.name)) drawn.passes[pass.name] += pass.milliseconds;
        image.attributes["scene"] = scene_.source;
        image.attributes["seed"] = std::to_string(scene_.photonMap.seed);
        image.attributes["software"] = std::string("lumulus ") + version;
        image.attributes["samples"] = std::to_string(renderer_->generations().photons());
        drawn.views.push_back(appendView(image, options, drawn.payload));
        drawn.views.back()["drawn_width"] = width;
        drawn.views.back()["drawn_height"] = height;
        drawn.drawMs += milliseconds(made - start);
        drawn.encodeMs += milliseconds(Clock::now() - made);
    }
    return drawn;
}

/// Milliseconds that photons took since the last frame.
std::map<std::string, double> SceneSlot::tracePasses() {
    std::map<std::string, double> since;
    for (const PassTime& pass : renderer_->statistics().passes)
        if (among(photonPasses, pass.name)) {
            double& total = passTotals_[pass.name];
            if (pass.milliseconds > total) since[pass.name] = pass.milliseconds - total;
            total = pass.milliseconds;
        }
    return since;
}

void SceneSlot::noteCosts(const Drawn& drawn, std::uint64_t rays) {
    double fixed = 0.0, sun = 0.0;
    for (const auto& [name, ms] : drawn.passes) {
        if (among(sunPasses, name)) sun += ms;
        if (!among(sunPasses, name) && !among(pixelPasses, name)) fixed += ms;
    }
    if (sun > 0.0) costs_.lit(sun, CostModel::sunShare(renderer_->sunReduction()));
    const auto views = static_cast<double>(drawn.views.size());
    costs_.drawn(fixed / views, std::max(0.0, drawn.drawMs - sun) - fixed * (1.0 - 1.0 / views), rays);
}

/// What `render` needs to make the same picture, as values of --set.
std::vector<std::string> SceneSlot::repeatOverrides() const {
    const Generations shown = renderer_->generations();
    std::vector<std::string> overrides;
    if (shown.count > 0)
        overrides = {fmt::format("photon_map.first_generation={}", shown.first),
                     fmt::format("photon_map.generations={}", shown.count),
                     fmt::format("photon_map.photons={}", shown.photons())};
    if (const glm::dvec3 d = scene_.sun.directionTo; d != loaded_.sun.directionTo)
        overrides.push_back(fmt::format("sun.direction_to=[{},{},{}]", d.x, d.y, d.z));
    if (const glm::dvec3 e = scene_.sun.irradiance; e != loaded_.sun.irradiance)
        overrides.push_back(fmt::format("sun.irradiance=[{},{},{}]", e.x, e.y, e.z));
    if (!scene_.clouds.empty() && scene_.clouds[0].extinction != loaded_.clouds[0].extinction)
        overrides.push_back(fmt::format("cloud.0.extinction={}", scene_.clouds[0].extinction));
    return overrides;
}

json SceneSlot::shownDescription() const {
    const Generations shown = renderer_->generations();
    json result{{"scene", scene_.source},
                {"photons", shown.photons()},
                {"generations", shown.count},
                {"current_generations", shown.current},
                {"first_generation", shown.first},
                {"photons_each", shown.photonsEach},
                {"repeat", repeatOverrides()},
                {"oldest_seconds", tracedAt_.empty() ? 0.0 : milliseconds(Clock::now() - tracedAt_.front()) / 1e3}};
    const bool known = noise_ >= 0.0 && shown.photons() > 0;
    result["noise"] = known ? json(noise_ / static_cast<double>(shown.photons())) : json();
    return result;
}

SceneSlot::Frame SceneSlot::composite(const Job& job, const Composite& composite) {
    const auto start = Clock::now();
    ViewRequest request;
    request.camera = composite.camera;
    request.width = composite.width;
    request.height = composite.height;
    FrameRequest frame;
    frame.views = {request};
    LayeredImage picture;
    picture.width = composite.width;
    picture.height = composite.height;
    picture.layer("A", 1.0F);
    const char* names[3] = {"R", "G", "B"};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        std::vector<float>& layer = picture.layer(names[channel]);
        for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = composite.color[3 * i + channel];
    }
    const View view = viewsOf(frame).front();
    {
        const Guarded guarded(*this, job.cancelled.get());
        picture = renderer_->throughFog(view, std::move(picture), composite.depth);
    }
    std::vector<std::byte> payload;
    const EncodeOptions options{
        {Product::color}, composite.encoding, composite.quality, composite.exposure.value_or(scene_.image.exposure)};
    json body{{"scene", scene_.source}, {"encoding", encodingName(composite.encoding)}};
    body["views"] = json::array({appendView(picture, options, payload)});
    body["hash"] = hashOf(payload, composite.hash);
    const double total = milliseconds(Clock::now() - job.arrived);
    body["milliseconds"] = {{"waited", milliseconds(start - job.arrived)}, {"total", total}};
    return {{replyTo(MessageType::composite), job.id, body.dump(), std::move(payload)}, false, false, total / 1e3};
}

SceneSlot::Frame SceneSlot::draw(const Job& job, const FrameRequest& frame) {
    const auto start = Clock::now();
    const std::vector<View> views = viewsOf(frame);
    const std::uint64_t pixels = pixelsOf(views), rays = raysOf(views);
    const double queued = milliseconds(start - job.arrived);
    const std::optional<double> limit = frame.budget.milliseconds;
    const double picture = costs_.drawMs(views.size(), rays) + costs_.encodeMs(frame.encoding, pixels);
    const double sun = allowSun(limit ? std::optional(*limit - queued) : std::nullopt, picture);
    const double spent = milliseconds(Clock::now() - job.arrived) + sun;
    const int reduction = limit ? costs_.reductionFor(*limit - spent, views.size(), rays, pixels, frame.encoding) : 1;

    renderer_->setOffset(wind_ * frame.time);
    Drawn drawn;
    {
        const Guarded guarded(*this, job.cancelled.get());
        drawn = drawViews(frame, views, reduction);
    }

    noteCosts(drawn, reduction == 1 ? rays : pixels / static_cast<std::uint64_t>(reduction * reduction));
    const auto hashing = Clock::now();
    const json hash = hashOf(drawn.payload, frame.hash);
    drawn.encodeMs += milliseconds(Clock::now() - hashing);
    costs_.encoded(frame.encoding, drawn.encodeMs, pixels);

    const double total = milliseconds(Clock::now() - job.arrived);
    const std::map<std::string, double> traced = tracePasses();
    double traceMs = 0.0;
    for (const auto& [name, ms] : traced) traceMs += ms;
    drawn.passes.insert(traced.begin(), traced.end());
    json body = shownDescription();
    const std::uint64_t photons = body["photons"].get<std::uint64_t>();
    const bool met = (!limit || total <= *limit) && (!frame.budget.photons || photons >= *frame.budget.photons);
    body["channel"] = frame.channel;
    body["number"] = job.number;
    body["time"] = frame.time;
    body["encoding"] = encodingName(frame.encoding);
    body["views"] = drawn.views;
    body["reduction"] = reduction;
    body["sun_reduction"] = std::max(1, renderer_->sunReduction());
    body["budget_met"] = met;
    body["hash"] = hash;
    body["milliseconds"] = {{"waited", queued},         {"trace", traceMs}, {"draw", drawn.drawMs},
                            {"encode", drawn.encodeMs}, {"total", total},   {"passes", drawn.passes}};
    const auto type = replyTo(job.stream ? MessageType::startStream : MessageType::frame);
    Frame result{
        {type, job.id, body.dump(), std::move(drawn.payload)}, reduction > 1, limit && total > *limit, total / 1e3};
    return result;
}

}  // namespace lumulus::service
