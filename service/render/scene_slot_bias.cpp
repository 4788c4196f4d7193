#include <algorithm>
#include <cmath>
#include <numeric>

#include "service/render/scene_slot.h"

// The error of pictures that rest.
namespace lumulus::service {

namespace {

constexpr int biasWidth = 96;  // pixels, as that of the picture that tells of the noise
constexpr auto rest = std::chrono::milliseconds(500);
/// Of all densities together, which paths need on the host: 96 MiB.
constexpr std::uint64_t mostVoxels = 24ULL << 20U;
/// Of a path, about: the thread ends between some paths.
constexpr double mostScatterings = 300.0;

std::uint64_t voxelsOf(const Statistics& statistics) {
    std::uint64_t voxels = 0;
    for (const AssetSummary& asset : statistics.assets)
        voxels += std::accumulate(
            asset.voxels.begin(), asset.voxels.end(), std::uint64_t{1},
            [](std::uint64_t product, int along) { return product * static_cast<std::uint64_t>(along); });
    return voxels;
}

/// How often a path scatters at most, about, in the clouds as they are now: until it is absorbed, or through the
/// thickest.
double scatteringsIn(const scene::Scene& now, const scene::Scene& loaded, const std::vector<CloudSummary>& clouds) {
    double most = 0.0;
    for (std::size_t i = 0; i < std::min(clouds.size(), now.clouds.size()); ++i) {
        const glm::dvec3& albedo = now.clouds[i].albedo;
        const double absorbed = std::max(1.0 - std::max({albedo.x, albedo.y, albedo.z}), 1e-9);
        const double thicker = now.clouds[i].extinction / std::max(loaded.clouds[i].extinction, 1e-12);
        most = std::max(most, std::min(clouds[i].largestThickness * thicker, 1.0 / absorbed));
    }
    return most;
}

}  // namespace

void SceneSlot::noteSeen(const std::vector<View>& views, int reduction) {
    if (seen_ != views || reduction != seenReduction_ || seenRevision_ != revision_) restsSince_ = Clock::now();
    seen_ = views;
    seenReduction_ = reduction;
    seenRevision_ = revision_;
    if (bias_.old && !biasIsOfNow()) *bias_.old = true;
}

bool SceneSlot::biasIsOfNow() const {
    return bias_.revision == revision_ && !seen_.empty() && bias_.view == seen_.front();
}

std::optional<Clock::time_point> SceneSlot::biasDue() const {
    if (seen_.empty() || seenReduction_ != 1 || seenRevision_ != revision_ || biasIsOfNow()) return std::nullopt;
    if (wantsGeneration() || renderer_->generations().count == 0 || renderer_->sunReduction() > 1) return std::nullopt;
    return restsSince_ + rest;
}

std::optional<BiasJob> SceneSlot::beginBias() {
    bias_ = {revision_, seen_.front(), std::nullopt, std::make_shared<std::atomic<bool>>(false)};
    BiasJob job;
    job.scene = sceneNow();
    const Statistics statistics = renderer_->statistics();
    if (voxelsOf(statistics) > mostVoxels || scatteringsIn(job.scene, scene_, statistics.clouds) > mostScatterings)
        return std::nullopt;
    job.view = seen_.front();
    const double aspect = static_cast<double>(job.view.image.height) / job.view.image.width;
    job.view.image.width = std::min(job.view.image.width, biasWidth);
    job.view.image.height = std::clamp(static_cast<int>(std::lround(aspect * job.view.image.width)), 1, 4 * biasWidth);
    job.view.tile.reset();
    const WorkGuard::Work guarded(guard_, nullptr, limits_.generationSeconds, true);
    const Counted drawing(drawing_);
    job.picture = renderer_->draw(job.view, viewer().whole.state);
    job.fields = renderer_->fields();
    job.revision = revision_;
    job.old = bias_.old;
    return job;
}

bool SceneSlot::keepBias(std::uint64_t revision, const std::optional<Bias>& found) {
    if (!found || bias_.revision != revision || revision_ != revision) return false;
    bias_.value = found;
    bias_.revision = seenRevision_ = ++revision_;  // frames have something to say
    return true;
}

}  // namespace lumulus::service
