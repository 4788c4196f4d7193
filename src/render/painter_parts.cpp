#include "render/painter_parts.h"

#include <algorithm>

#include "render/asset_maker.h"

namespace lumulus {

namespace {

/// Whether the light that reaches a cloud's voxels falls by more than a fifth within one, where they are densest: by
/// the transport's mean free path.
bool hasThickVoxels(const cloud::Instance& instance, int bands) {
    constexpr double thick = 0.25;
    return reducedExtinction(instance.medium, bands) * instance.voxelEdge() >= thick;
}

}  // namespace

draw::DrawFeatures featuresOf(const World& world, bool meshes) {
    draw::DrawFeatures features;
    features.mesh = meshes;
    features.ground = world.lights.ground.has_value();
    const std::vector<const cloud::Instance*> instances = instancesOf(world);
    features.forwardCut =
        std::ranges::any_of(instances, [](const auto* i) { return !i->medium.tables.singleScatterH.empty(); });
    features.grey = std::ranges::all_of(instances, [](const auto* i) { return i->medium.isGrey(); });
    features.coloured = std::ranges::any_of(instances, [](const auto* i) { return i->medium.tables.coloured; });
    features.sun = world.hasShadows();
    features.photons = world.hasPhotons();
    features.many = instances.size() > 1;
    features.sparse = std::ranges::any_of(instances, [](const auto* i) { return i->asset->isSparse(); });
    features.air = world.fogLight != nullptr || world.lights.environment.atmosphere() != nullptr;
    features.skyReturn = world.skyReturn.has_value();
    features.thickVoxels = features.sun && std::ranges::any_of(instances, [&](const auto* i) {
                               return hasThickVoxels(*i, world.photonMap.bands);
                           });
    return features;
}

std::vector<const cloud::Instance*> instancesOf(const World& world) {
    std::vector<const cloud::Instance*> instances;
    for (const std::size_t i : world.visible()) instances.push_back(&world.instances[i]);
    return instances;
}

draw::PhaseTables makePhaseTables(gpu::Context& context, const World& world, const draw::DrawFeatures& how,
                                  std::span<int> numbers) {
    const std::vector<const cloud::Instance*> instances = instancesOf(world);
    std::vector<const phase::ScatteringTables*> media;
    for (std::size_t place = 0; place < instances.size(); ++place) {
        const phase::ScatteringTables& tables = instances[place]->medium.tables;
        const auto same = std::ranges::find_if(media, [&](const phase::ScatteringTables* other) {
            return other->phaseTable == tables.phaseTable && other->singleScatterH == tables.singleScatterH &&
                   other->singleScatterK == tables.singleScatterK;
        });
        numbers[place] = static_cast<int>(same - media.begin());
        if (same == media.end()) media.push_back(&tables);
    }
    return {context, media, how};
}

void setPlace(shared::InstanceParams& params, const cloud::Instance& instance, const Camera& camera) {
    const cloud::Asset& asset = *instance.asset;
    params.worldToVoxel = glm::mat3(glm::inverse(instance.voxelToMetres));
    params.eyeVoxel = glm::vec3(instance.toVoxel(camera.position));
    params.size = glm::vec3(asset.size);
    params.cells = asset.cells.cells;
    params.cellSize = asset.cells.cellSize;
    params.voxelLength = instance.isFlat() ? 0.0F : static_cast<float>(instance.voxelEdge());
}

void setMedium(shared::InstanceParams& params, const phase::ScatteringMedium& medium, const scene::Sun& sun,
               int phaseTable) {
    const phase::ScatteringTables& tables = medium.tables;
    params.extinction = static_cast<float>(medium.extinction);
    params.sunIrradiance = glm::vec3(sun.irradiance);
    params.albedo = glm::vec3(medium.albedo);
    params.extinctionScale = glm::vec3(1.0 - static_cast<double>(tables.forwardFraction) * medium.albedo);
    params.scatterShare = tables.scatterFraction;
    params.angleScale = tables.angleScale;
    params.tauMaximum = tables.tauMaximum;
    params.phaseTable = phaseTable;
}

glm::ivec2 sunColourPlace(std::size_t place) {
    constexpr std::size_t down = 256;
    return {static_cast<int>(place / down) * shared::SUN_COLOUR_COLUMNS,
            static_cast<int>(place % down) * shared::SUN_COLOUR_ROWS};
}

gpu::Image sunColourImage(gpu::Context& context, const World& world) {
    const std::vector<std::size_t> visible = world.visible();
    const glm::ivec2 last = sunColourPlace(visible.size() - 1);
    const glm::ivec2 table(shared::SUN_COLOUR_COLUMNS, shared::SUN_COLOUR_ROWS);
    const glm::ivec2 size = glm::ivec2(last.x, last.x > 0 ? sunColourPlace(255).y : last.y) + table;
    gpu::Image image(context, "sun colours", size, VK_FORMAT_R32G32B32A32_SFLOAT);
    std::vector<glm::vec4> texels(static_cast<std::size_t>(size.x * size.y), glm::vec4(1.0F));
    for (std::size_t place = 0; place < visible.size(); ++place) {
        const std::vector<glm::vec3>& colours = world.light[visible[place]].air->sunColours;
        const glm::ivec2 at = sunColourPlace(place);
        for (int i = 0; i < table.x * table.y; ++i)
            texels[static_cast<std::size_t>((at.y + i / table.x) * size.x + at.x + i % table.x)] =
                glm::vec4(colours[static_cast<std::size_t>(i)], 1.0F);
    }
    gpu::upload(context, image, texels);
    return image;
}

gpu::Image skyReturnImage(gpu::Context& context, const photon::SkyReturn& sky) {
    gpu::Image image(context, "sky return", photon::SkyReturn::size(), VK_FORMAT_R32G32B32A32_SFLOAT);
    gpu::upload(context, image, sky.texels);
    return image;
}

namespace {

surface::MeshPixels meshesOf(const ViewState::State& view, const Tile& band) {
    if (view.meshes) return view.meshes->part(band);
    surface::MeshPixels none;
    none.pixels.assign(static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.height),
                       {glm::vec3(0.0F), shared::FAR_DEPTH, -1});
    return none;
}

}  // namespace

MeshBand::MeshBand(gpu::Context& context, const ViewState::State& view, const Tile& band)
    : MeshBand(context, meshesOf(view, band)) {}

MeshBand::MeshBand(gpu::Context& context, const surface::MeshPixels& meshes)
    : pixels(gpu::filledBuffer(context, "mesh pixels", meshes.pixels)),
      edges(gpu::filledBuffer(context, "mesh edges", meshes.edges)) {}

Tile unite(const Tile& a, const Tile& b) {
    if (a.width <= 0 || a.height <= 0) return b;
    if (b.width <= 0 || b.height <= 0) return a;
    const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

}  // namespace lumulus
