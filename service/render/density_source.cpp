#include "service/render/density_source.h"

#include <fmt/format.h>

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

void showUpload(scene::Cloud& cloud, const NewDensity& density, const RenderConfig& config) {
    cloud.vdb = uploadedFile(density.vdb, config);
    cloud.voxels.reset();
    cloud.moment.reset();
    cloud.held.clear();
}

/// The cloud of the scene's file that cloud `i` is, or that it was added like. Errors: RequestError `not_found`.
const scene::Cloud& inFile(const scene::Scene& file, const scene::Scene& scene, std::size_t i) {
    const std::string name = scene::nameOf(scene, i);
    const std::optional<scene::SequenceMoment>& moment = scene.clouds[i].moment;
    const scene::Cloud* like = nullptr;
    for (std::size_t k = 0; k < file.clouds.size(); ++k) {
        const scene::Cloud& cloud = file.clouds[k];
        if (scene::nameOf(file, k) == name) return cloud;
        if (moment && cloud.moment && cloud.moment->name == moment->name) like = &cloud;
    }
    if (like == nullptr)
        throw RequestError("not_found", "the scene's file has no cloud \"" + name + "\", and so no frames of it",
                           "cloud");
    return *like;
}

/// What the scene's file says of the frame. Where it shows nothing there, or showed nothing before, it says so by the
/// extinction.
void showFrame(scene::Cloud& cloud, const scene::Cloud& at) {
    cloud.vdb = at.vdb;
    cloud.voxels.reset();
    cloud.moment = at.moment;
    cloud.held = at.held;
    if (at.extinction == 0.0 || cloud.extinction == 0.0) cloud.extinction = at.extinction;
}

}  // namespace

std::vector<std::size_t> cloudsOfDensity(const scene::Scene& scene, const NewDensity& density,
                                         const std::optional<CloudReference>& cloud) {
    const bool frame = density.frame.has_value();
    if (cloud) {
        const std::size_t found = findCloud(scene, *cloud);
        if (frame && !isSequence(scene.clouds[found]))
            throw RequestError("bad_request", "the cloud is no sequence of files, and has no other frames", "cloud");
        return {found};
    }
    std::vector<std::size_t> clouds;
    for (std::size_t i = 0; i < scene.clouds.size(); ++i)
        if (!frame || isSequence(scene.clouds[i])) clouds.push_back(i);
    if (clouds.empty() && frame)
        throw RequestError("bad_request", "the scene has no cloud that is a sequence of files", "frame");
    if (clouds.empty()) throw RequestError("not_found", "the scene has no cloud", "cloud");
    if (clouds.size() > 1 && !frame)
        throw RequestError("bad_request", "the scene has several clouds: name the one that gets the density", "cloud");
    return clouds;
}

SourcedScene sourceDensity(const DensityWish& wish, const RenderConfig& config, ClientId owner, std::uint64_t id) {
    SourcedScene found = wish.shown;
    found.key = fmt::format("{}, density {} of client {}", wish.shown.key, id, owner);
    try {
        scene::Scene at;
        if (wish.density.frame) at = sceneAt(*wish.shown.load, config, *wish.density.frame);
        for (const std::size_t i : wish.clouds) {
            scene::Cloud& cloud = found.scene.clouds.at(i);
            if (!wish.density.grid.empty()) cloud.grid = wish.density.grid;
            if (!wish.density.frame)
                showUpload(cloud, wish.density, config);
            else
                showFrame(cloud, inFile(at, wish.shown.scene, i));
        }
    } catch (const InputError& e) {
        throw RequestError("bad_request", e.what(), "frame");
    }
    return found;
}

std::vector<CloudShown> cloudsShown(const scene::Scene& scene, const DensityWish& wish) {
    std::vector<CloudShown> shown;
    for (const std::size_t i : wish.clouds) {
        CloudShown& cloud = shown.emplace_back();
        cloud.name = scene::nameOf(scene, i);
        cloud.vdb = wish.density.vdb;
        if (const auto& moment = scene.clouds[i].moment; moment && wish.density.frame) cloud.file = moment->file;
    }
    return shown;
}

}  // namespace lumulus::service
