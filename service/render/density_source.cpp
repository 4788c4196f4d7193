#include "service/render/density_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "service/render/cloud_edits.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

/// Whether a cloud of the scene shows files of a sequence: at some frames it shows none.
bool isSequence(const scene::Cloud& cloud) {
    return cloud.moment.has_value() || cloud.sequence.frames.has_value();
}

void takeGrid(scene::Cloud& cloud, const NewDensity& density) {
    if (!density.grid.empty()) cloud.grid = density.grid;
}

void showUpload(scene::Cloud& cloud, const NewDensity& density, const RenderConfig& config) {
    cloud.vdb = uploadedFile(density.vdb, config);
    cloud.voxels.reset();
    cloud.moment.reset();
    cloud.held.clear();
    takeGrid(cloud, density);
}

/// The cloud of the scene's file that cloud `i` is, or that it was added like; null where it has none.
const scene::Cloud* inFile(const scene::Scene& file, const scene::Scene& scene, std::size_t i) {
    const std::string name = scene::nameOf(scene, i);
    const std::optional<scene::SequenceMoment>& moment = scene.clouds[i].moment;
    const scene::Cloud* like = nullptr;
    for (std::size_t k = 0; k < file.clouds.size(); ++k) {
        const scene::Cloud& cloud = file.clouds[k];
        if (scene::nameOf(file, k) == name) return &cloud;
        if (moment && cloud.moment && cloud.moment->name == moment->name) like = &cloud;
    }
    return like;
}

/// What the scene's file says of the frame. Where it shows nothing there, or showed nothing before, it says so by the
/// extinction.
void showFrame(scene::Cloud& cloud, const scene::Cloud& at) {
    cloud.vdb = at.vdb;
    cloud.voxels.reset();
    cloud.moment = at.moment;
    cloud.held = at.held;
    cloud.sequence = at.sequence;
    if (at.extinction == 0.0 || cloud.extinction == 0.0) cloud.extinction = at.extinction;
}

/// Puts the files of a frame into the place of those that are shown.
void showFrames(scene::Scene& scene, const DensityWish& wish, const RenderConfig& config) {
    const scene::Scene file = sceneAt(*wish.shown.load, config, *wish.density.frame);
    bool any = false;
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) {
        const bool named = std::ranges::find(wish.clouds, i) != wish.clouds.end();
        if (!named && !wish.clouds.empty()) continue;
        const scene::Cloud* at = inFile(file, wish.shown.scene, i);
        const bool has = at != nullptr && isSequence(*at);
        if (named && !has)
            throw RequestError("bad_request", "the cloud is no sequence of files, and has no other frames", "cloud");
        if (!has) continue;
        showFrame(scene.clouds[i], *at);
        takeGrid(scene.clouds[i], wish.density);
        any = true;
    }
    if (!any) throw RequestError("bad_request", "the scene has no cloud that is a sequence of files", "frame");
}

}  // namespace

std::vector<std::size_t> cloudsOfDensity(const scene::Scene& scene, const NewDensity& density,
                                         const std::optional<CloudReference>& cloud) {
    if (cloud) return {findCloud(scene, *cloud)};
    if (density.frame) return {};
    if (scene.clouds.empty()) throw RequestError("not_found", "the scene has no cloud", "cloud");
    if (scene.clouds.size() > 1)
        throw RequestError("bad_request", "the scene has several clouds: name the one that gets the density", "cloud");
    return {0};
}

SourcedScene sourceDensity(const DensityWish& wish, const RenderConfig& config, ClientId owner, std::uint64_t id) {
    SourcedScene found = wish.shown;
    found.key = fmt::format("{}, density {} of client {}", wish.shown.key, id, owner);
    try {
        if (wish.density.frame)
            showFrames(found.scene, wish, config);
        else
            for (const std::size_t i : wish.clouds) showUpload(found.scene.clouds.at(i), wish.density, config);
    } catch (const InputError& e) {
        throw RequestError("bad_request", e.what(), "frame");
    }
    return found;
}

std::vector<CloudShown> cloudsShown(const scene::Scene& scene, const DensityWish& wish) {
    std::vector<CloudShown> shown;
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) {
        const bool named = std::ranges::find(wish.clouds, i) != wish.clouds.end();
        if (!named && !(wish.clouds.empty() && isSequence(scene.clouds[i]))) continue;
        CloudShown& cloud = shown.emplace_back();
        cloud.name = scene::nameOf(scene, i);
        cloud.vdb = wish.density.vdb;
        if (const auto& moment = scene.clouds[i].moment; moment && wish.density.frame) cloud.file = moment->file;
    }
    return shown;
}

}  // namespace lumulus::service
