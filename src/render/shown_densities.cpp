#include "render/shown_densities.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "cloud/asset_copy.h"
#include "render/kept_assets.h"
#include "volume/known_fields.h"
#include "volume/load.h"

namespace lumulus {

namespace {

struct CopiedAsset {
    AssetOrigin origin;
    float maximum = 0.0F;
    cloud::AssetCopy copy;
};

}  // namespace

struct DensityCopies::State {
    KnownFields known;  ///< without values
    std::vector<CopiedAsset> assets;
};

DensityCopies::DensityCopies() : state_(std::make_unique<State>()) {}
DensityCopies::DensityCopies(DensityCopies&&) noexcept = default;
DensityCopies& DensityCopies::operator=(DensityCopies&&) noexcept = default;
DensityCopies::~DensityCopies() = default;

bool DensityCopies::empty() const {
    return state_->assets.empty();
}

struct ShownDensities::State {
    KnownFields known;  ///< without values
    KeptClouds kept;

    /// Those that a scene shows too, in an order that stays.
    std::vector<const KeptAsset*> shownIn(const KnownFields& wanted) {
        std::vector<const KeptAsset*> assets;
        for (const KeptAsset& asset : kept.state().assets)
            if (std::ranges::any_of(wanted.fields,
                                    [&](const KnownField& field) { return asset.origin.isOf(field.volume); }))
                assets.push_back(&asset);
        return assets;
    }
};

ShownDensities::ShownDensities() : state_(std::make_unique<State>()) {}
ShownDensities::~ShownDensities() = default;

std::unique_ptr<Renderer> ShownDensities::makeRenderer(const scene::Scene& scene, RendererOptions options,
                                                       DensityCopies copies) {
    if (!copies.empty()) {
        options.context = std::make_shared<gpu::Context>(gpu::ContextOptions{options.device, options.validation});
        KeptClouds::State& kept = state_->kept.state();
        kept.context = options.context;
        for (CopiedAsset& each : copies.state_->assets) {
            options.check();
            auto asset =
                std::make_shared<const cloud::Asset>(cloud::makeAsset(*options.context, std::exchange(each.copy, {})));
            kept.assets.push_back({each.origin, each.maximum, std::move(asset)});
        }
        state_->known = std::move(copies.state_->known);
        copies = {};
        try {
            return make(scene, options);
        } catch (const DensityMissing&) {  // it would be prepared in another way
            *state_ = {};
            options.context.reset();
        }
    }
    return make(scene, options);
}

std::unique_ptr<Renderer> ShownDensities::make(const scene::Scene& scene, const RendererOptions& options) {
    RendererOptions noting = options;
    noting.kept = &state_->kept;
    noting.read = [&](const scene::Scene& wanted) {
        return loadClouds(wanted, options.report, options.check, FieldStorage::asWanted, &state_->known);
    };
    auto renderer = std::make_unique<Renderer>(scene, noting);
    forgetValues();
    return renderer;
}

/// Values are on the device from now on.
void ShownDensities::forgetValues() {
    KeptClouds::State& kept = state_->kept.state();
    std::erase_if(state_->known.fields, [](const KnownField& field) { return field.inBricks; });
    std::erase_if(kept.assets, [](const KeptAsset& asset) { return asset.asset->isSparse(); });
    kept.pool = {};
    for (KnownField& field : state_->known.fields) {
        const auto bare = withoutValues(*field.volume);
        for (KeptAsset& asset : kept.assets)
            if (asset.origin.isOf(field.volume)) asset.origin.field = bare;
        field.volume = bare;
    }
    kept.shared.reset();  // other worlds of these densities have their own
    kept.sharedOf.clear();
}

std::uint64_t ShownDensities::copyBytes(const scene::Scene& scene) const {
    std::uint64_t bytes = 0;
    for (const KeptAsset* asset : state_->shownIn(knownIn(state_->known, scene)))
        bytes += cloud::copyBytes(*asset->asset);
    return bytes;
}

bool ShownDensities::copy(const scene::Scene& scene, DensityCopies& copies, std::uint64_t bytes) const {
    DensityCopies::State& copied = *copies.state_;
    copied.known = knownIn(state_->known, scene);
    const std::vector<const KeptAsset*> wanted = state_->shownIn(copied.known);
    std::uint64_t read = 0;
    for (std::size_t i = copied.assets.empty() ? 0 : copied.assets.size() - 1; i < wanted.size(); ++i) {
        if (read >= bytes) return false;
        const cloud::Asset& asset = *wanted[i]->asset;
        if (i == copied.assets.size())
            copied.assets.push_back({wanted[i]->origin, wanted[i]->maximum, cloud::beginCopy(asset)});
        cloud::AssetCopy& copy = copied.assets[i].copy;
        const std::size_t before = copy.texels.size();
        const bool whole = cloud::readMore(*state_->kept.state().context, asset, copy, bytes - read);
        read += copy.texels.size() - before;
        if (!whole) return false;
    }
    return true;
}

}  // namespace lumulus
