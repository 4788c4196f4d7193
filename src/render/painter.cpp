#include "render/painter.h"

#include <algorithm>
#include <cmath>

#include "draw/light_params.h"
#include "draw/shown.h"
#include "frame/background.h"
#include "frame/view_params.h"
#include "render/painter_parts.h"
#include "render/view_light.h"

namespace lumulus {

namespace {

/// Part of the tiles with clouds in which every pixel is drawn, at most: sampling points cost a third of a pixel each
/// where nothing comes of them.
constexpr double mostDrawn = 0.75;

}  // namespace

Painter::Painter(gpu::Context& context, const World& world, const scene::Draw& draw, bool meshes)
    : tolerance_(draw.tolerance),
      visible_(world.visible()),
      phaseTables_(visible_.size()),
      features_(featuresOf(world, meshes)),
      phase_(makePhaseTables(context, world, features_, phaseTables_)),
      none_(context, "none", glm::ivec3(1), VK_FORMAT_R32G32B32A32_SFLOAT),
      noColours_(context, "no colours", glm::ivec2(1), VK_FORMAT_R32G32B32A32_SFLOAT),
      noSquares_(draw::noSquares(context)),
      noTiles_(context) {
    if (draw.mode == scene::DrawMode::billboards)
        billboards_.emplace(context, instancesOf(world), features_);
    else
        march_.emplace(context, features_);
}

int raysOf(const World& world, std::size_t instance, const Camera& camera) {
    // levels of detail have voxels of half a pixel to a whole one, which one ray sees well enough
    const double voxels = world.levelsOfDetail ? 2.0 : 1.0;
    const cloud::Instance& of = world.instances[instance];
    return frame::raysAcross(voxels * of.voxelWidth(camera.position) / frame::pixelLength(camera, of.middle()));
}

std::vector<draw::Fineness> Painter::fineness(const World& world, const Camera& camera, int mostRays) const {
    std::vector<draw::Fineness> found;
    for (const std::size_t i : visible_) {
        const cloud::Instance& instance = world.instances[i];
        const double away = glm::length(instance.middle() - camera.position);
        const glm::dvec3 farthest = camera.position + (away + 0.5 * instance.diagonal()) * camera.axes[2];
        const double width = instance.voxelWidth(camera.position);
        found.push_back({draw::samplingSpacing(width / frame::pixelLength(camera, farthest)),
                         std::min(mostRays, raysOf(world, i, camera))});
    }
    return found;
}

int Painter::samplingSpacing(const World& world, const Camera& camera) const {
    if (tolerance_ <= 0.0 || features_.mesh) return 1;
    const std::vector<draw::Fineness> each = fineness(world, camera, 1);
    if (!features_.many) return each.front().spacing;
    return std::ranges::max(each, {}, &draw::Fineness::spacing).spacing > 1 ? draw::widestSpacing : 1;
}

Tile Painter::shownPart(const World& world, const ViewState::State& view) const {
    Tile shown{view.tile.x, view.tile.y, 0, 0};
    for (std::size_t place = 0; place < visible_.size(); ++place) {
        const cloud::Instance& instance = world.instances[visible_[place]];
        const glm::dmat3& voxel = instance.voxelToMetres;
        const double half = 0.5 * (glm::length(voxel[0]) + glm::length(voxel[1]) + glm::length(voxel[2]));
        Camera unmoved = view.camera;  // bounds are those of the cloud without its offset
        unmoved.position -= instance.offset;
        shown = unite(shown, draw::shownPart(unmoved, instance.bounds, billboards_ ? billboards_->reach(place) : half,
                                             view.tile));
    }
    return shown;
}

draw::Volumes Painter::volumes(const World& world, const ViewState::State& view, const gpu::Image& sunColours,
                               const gpu::Image& skyReturn) const {
    const cloud::Asset& first = *world.instances[visible_.front()].asset;
    if (features_.many)
        return {world.sharedVolumes->density(),
                world.sharedVolumes->brickIndex(),
                world.sharedVolumes->majorants().image(),
                view.lightFields ? view.lightFields->image() : none_,
                world.sharedShadow ? world.sharedShadow->image() : none_,
                sunColours,
                skyReturn};
    const std::size_t only = visible_.front();
    const auto& field = view.instances[only].field;
    const auto& shadow = world.light[only].shadow;
    return {*first.density,
            first.brickIndex(),
            first.marchedCells(),
            field ? field->image() : none_,
            shadow ? shadow->image() : none_,
            sunColours,
            skyReturn};
}

shared::InstanceParams Painter::instanceParams(const World& world, const ViewState::State& view,
                                               std::size_t place) const {
    const std::size_t number = visible_[place];
    const cloud::Instance& instance = world.instances[number];
    const light::InstanceLight& light = world.light[number];
    shared::InstanceParams params{};
    setPlace(params, instance, view.camera);
    setMedium(params, instance.medium, light.sun, phaseTables_[place]);
    if (const auto& field = view.instances[number].field) params.radianceScale = field->scale();
    if (light.shadow) {
        params.voxelToShadow = light.shadow->voxelToTexture();
        params.shadowOffset = light.shadow->textureOffset();
    }
    if (light.air) {
        params.air = light.air->place;
        params.airTexel = glm::vec2(sunColourPlace(place));
    }
    if (!features_.many) return params;
    if (features_.sparse)
        params.firstBrick = static_cast<int>(world.sharedVolumes->place(place).x);
    else
        params.densityOrigin = world.sharedVolumes->place(place);
    params.cellOrigin = world.sharedVolumes->majorants().origin(place);
    if (view.lightFields) {
        params.lightOrigin = glm::vec3(view.lightFields->origin(place));
        const auto& field = view.instances[number].field;
        params.lightSize = field ? glm::vec3(field->image().extent()) : glm::vec3(1.0F);
    }
    if (world.sharedShadow) {
        params.shadowOrigin = glm::vec3(world.sharedShadow->origin(place));
        params.shadowSize = light.shadow ? glm::vec3(light.shadow->image().extent()) : glm::vec3(1.0F);
    }
    return params;
}

shared::DrawParams Painter::drawParams(const World& world, const ViewState::State& view) const {
    double finest = 1e300;
    for (const std::size_t i : visible_) finest = std::min(finest, world.instances[i].voxelEdge());
    shared::DrawParams values{};
    values.view = frame::viewParams(view.camera);
    values.light = draw::lightParams(world.lights.direct());
    values.environment = world.lights.environment.params();
    if (features_.many) {
        values.atlas.density = world.sharedVolumes->inverseSize();
        if (view.lightFields) values.atlas.light = view.lightFields->inverseSize();
        if (world.sharedShadow) values.atlas.shadow = world.sharedShadow->inverseSize();
    }
    values.sampling = draw::samplingGridOf(view.camera, view.shown, view.spacing, tolerance_,
                                           static_cast<double>(static_cast<float>(finest)));
    values.instances = static_cast<int>(visible_.size());
    values.samples = view.raysAcross;
    if (world.lights.ground)
        values.eyeAboveGround = static_cast<float>(view.camera.position.y - world.lights.ground->height);
    if (features_.skyReturn) values.skyAxes = glm::mat3(world.skyReturn->axes);
    values.tilesAcross = view.tiles ? view.tiles->across() : 0;
    if (view.billboards) values.tilesAcross = view.billboards->tilesAcross();
    return values;
}

/// Light fields of all instances in one image.
void Painter::fillAtlas(GpuWork& work, ViewState::State& view) const {
    if (!features_.photons) return;
    std::vector<const gpu::Image*> fields;
    for (const std::size_t i : visible_) {
        const auto& field = view.instances[i].field;
        fields.push_back(field ? &field->image() : &none_);
    }
    if (!view.lightFields || !view.lightFields->holds(fields)) {
        view.lightFields.reset();
        view.lightFields.emplace(work.context, "light field atlas", fields, VK_FORMAT_R32G32B32A32_SFLOAT);
    }
    work.run([&](gpu::Commands& commands) { view.lightFields->record(commands, fields); });
}

void Painter::findShown(gpu::Context& context, const World& world, ViewState::State& view) const {
    view.tiles.reset();
    if (!features_.many) return;
    view.tiles.emplace(context, instancesOf(world), fineness(world, view.camera, view.raysAcross), view.camera);
    if (view.tiles->pixelShare() > mostDrawn) view.spacing = 1;
}

void Painter::prepare(GpuWork& work, ViewState::State& view) const {
    if (features_.many) fillAtlas(work, view);
    view.billboards.reset();
    if (billboards_) view.billboards.emplace(work.context, *billboards_, view.camera);
}

void Painter::recordPixels(gpu::Commands& commands, const draw::DrawInputs& inputs, const ViewState::State& view,
                           const draw::MeshBuffers* meshes, const shared::DrawPush& push) const {
    if (billboards_)
        billboards_->record(commands, inputs, *view.billboards, push);
    else
        march_->record(commands, inputs, view.tiles ? *view.tiles : noTiles_, meshes, push);
}

/// The points of sparse sampling that are not drawn yet, what can be interpolated between them, and the rest.
void Painter::recordBlocks(gpu::Commands& commands, const draw::DrawInputs& inputs, ViewState::State& view,
                           const shared::SamplingGrid& sampling, const draw::Band& band, const Tile& pixels) const {
    draw::Interpolation& interpolation = view.interpolations.at(view.spacing);
    const auto into = [&](const gpu::Buffer& target, const gpu::Buffer& list) {
        return draw::DrawInputs{inputs.params, inputs.instances, inputs.phase, inputs.volumes, target, list};
    };
    const draw::Band needed = draw::samplingRows(sampling, view.shown, band);
    const int first = std::max(needed.first, view.sampledRowsDrawn), end = needed.first + needed.rows;
    if (end > first) {
        recordPixels(commands, into(interpolation.points(), inputs.squares), view, nullptr,
                     {shared::DRAW_SPARSE, sampling.first + glm::ivec2(0, first), {sampling.size.x, end - first}});
        commands.barrier("sample points");
        view.sampledRowsDrawn = end;
    }
    const draw::InstanceTiles& tiles = view.tiles ? *view.tiles : noTiles_;
    interpolation.record(commands, inputs, tiles, pixels);
    commands.barrier("blocks");
    if (draw::hasRefinement(view.spacing)) {
        recordPixels(commands, into(interpolation.refined(), interpolation.blocks()), view, nullptr,
                     interpolation.refinedPoints(pixels));
        commands.barrier("refined points");
        interpolation.recordRefined(commands, inputs, tiles, pixels);
        commands.barrier("cells");
    }
    recordPixels(commands, into(inputs.pixels, interpolation.lastList()), view, nullptr, interpolation.squares(pixels));
}

void Painter::paintBand(GpuWork& work, const draw::DrawInputs& inputs, ViewState::State& view,
                        const shared::SamplingGrid& sampling, const draw::Band& band, LayeredImage* image) const {
    const Tile& shown = view.shown;
    const Tile pixels{shown.x, shown.y + band.first, shown.width, band.rows};
    const Tile place{pixels.x - view.tile.x, pixels.y - view.tile.y, pixels.width, pixels.height};
    if (sampling.spacing > 1) view.interpolations.at(view.spacing).clearLists();
    std::optional<MeshBand> meshes;
    if (features_.mesh) meshes.emplace(work.context, view, pixels);
    const std::optional<draw::MeshBuffers> bound =
        meshes ? std::optional(draw::MeshBuffers{meshes->pixels, meshes->edges}) : std::nullopt;
    work.run([&](gpu::Commands& commands) {
        if (sampling.spacing > 1)
            recordBlocks(commands, inputs, view, sampling, band, pixels);
        else
            recordPixels(commands, inputs, view, bound ? &*bound : nullptr,
                         {shared::DRAW_PIXELS, {pixels.x, pixels.y}, {pixels.width, pixels.height}});
        if (image != nullptr) return;
        commands.barrier("pixels");
        view.frame->recordBand(commands, inputs.pixels, place);
    });
    if (image == nullptr) return;
    frame::copyPixels(inputs.pixels.mapped<const shared::Pixel>(), *image, place);
    work.context.addDownloaded(static_cast<std::uint64_t>(place.width) * static_cast<std::uint64_t>(place.height) *
                               sizeof(shared::Pixel));
}

void Painter::paint(GpuWork& work, const World& world, ViewState::State& view, const std::vector<draw::Band>& bands,
                    LayeredImage* image, const Check& check, const Report& report) const {
    gpu::Context& context = work.context;
    const int rows = draw::bandRows(view.shown);
    const auto most = static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(view.shown.width);
    const gpu::Buffer pixels = image == nullptr
                                   ? draw::pixelBuffer(context, "pixels", most)
                                   : gpu::Buffer(context, "pixels", most * sizeof(shared::Pixel), gpu::Memory::host);
    gpu::Buffer params(context, "draw params", sizeof(shared::DrawParams), gpu::Memory::host);
    gpu::Buffer instances(context, "instances", visible_.size() * sizeof(shared::InstanceParams), gpu::Memory::host);
    const shared::DrawParams values = drawParams(world, view);
    params.mapped<shared::DrawParams>()[0] = values;
    for (std::size_t place = 0; place < visible_.size(); ++place)
        instances.mapped<shared::InstanceParams>()[place] = instanceParams(world, view, place);
    if (view.spacing > 1) {
        auto& interpolation =
            view.interpolations.try_emplace(view.spacing, context, view.spacing, features_.many).first->second;
        interpolation.prepare(values.sampling, rows);
        view.sampledRowsDrawn = 0;
    }
    std::optional<gpu::Image> sunColours;
    if (features_.air) sunColours.emplace(sunColourImage(context, world));
    std::optional<gpu::Image> skyReturn;
    if (features_.skyReturn) skyReturn.emplace(skyReturnImage(context, *world.skyReturn));
    const draw::Volumes bound =
        volumes(world, view, sunColours ? *sunColours : noColours_, skyReturn ? *skyReturn : none_);
    const draw::DrawInputs inputs{params, instances, phase_, bound, pixels, noSquares_};
    report("drawing", 0, bands.size());
    for (std::size_t done = 0; done < bands.size(); ++done) {
        check();
        paintBand(work, inputs, view, values.sampling, bands[done], image);
        report("drawing", done + 1, bands.size());
    }
}

}  // namespace lumulus
