// Drawing of a view.
#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "draw/shown.h"
#include "frame/background.h"
#include "frame/view_params.h"
#include "render/renderer_state.h"

namespace lumulus {

void Renderer::State::addTimes(const std::vector<gpu::PassTime>& times) {
    for (const gpu::PassTime& pass : times) {
        const auto known = std::find_if(statistics.passes.begin(), statistics.passes.end(),
                                        [&](const PassTime& t) { return t.name == pass.name; });
        if (known == statistics.passes.end())
            statistics.passes.push_back({pass.name, pass.milliseconds});
        else
            known->milliseconds += pass.milliseconds;
    }
}

void Renderer::State::makeLightField(std::uint64_t forPhotons) {
    const cloud::CellGrid grid = light::lightGrid(*cloud, forPhotons);
    if (lightField && grid == lightField->grid()) return;
    lightField.emplace(context, *cloud, grid, estimatorGrid);
    forgetLight();
}

glm::dvec3 Renderer::State::toVoxel(const glm::dvec3& world) const {
    return glm::inverse(cloud->toWorld.linear) * (world - cloud->toWorld.translation);
}

glm::vec3 Renderer::State::eyeVoxel() const {
    // An orthographic eye is far away: all collectors see it in one direction.
    glm::dvec3 eye = camera.position;
    if (camera.projection == scene::Projection::orthographic)
        eye -= camera.axes[2] * (1e5 * glm::length(cloud->toWorld.linear * glm::dvec3(cloud->size)));
    return glm::vec3(toVoxel(eye));
}

shared::FieldParams Renderer::State::fieldParams() const {
    shared::FieldParams field{};
    field.worldToVoxel = glm::mat3(glm::inverse(cloud->toWorld.linear));
    field.eyeVoxel = glm::vec3(toVoxel(camera.position));
    field.size = glm::vec3(cloud->size);
    field.cells = cloud->cells.cells;
    field.cellSize = cloud->cells.cellSize;
    field.extinction = static_cast<float>(medium.extinction);
    field.voxelLength = static_cast<float>(std::cbrt(cloud->voxelVolume));
    if (lightField) field.radianceScale = lightField->scale();
    if (shadowVolume) {
        field.voxelToShadow = shadowVolume->voxelToTexture();
        field.shadowOffset = shadowVolume->textureOffset();
    }
    return field;
}

/// The photons' light is not what the light field was made of.
void Renderer::State::forgetLight() {
    lightEye.reset();
    lightCounted = false;
}

light::CollisionEstimates Renderer::State::estimates(const photon::Light& light) const {
    const double moment = scene.photonMap.bands > 1 ? static_cast<double>(medium.tables.bandMoments[1]) : 0.0;
    return {*light.counts, photons->estimatorBase(), light.unit, photons->photonPower(), photons->massScale(), moment};
}

/// Light in the cloud as this view sees it; the sun's depths only once.
void Renderer::State::recordLight(photon::Part part) {
    if (shadowVolume && (sunDrawn == 0 || sunDrawn > sunAllowed)) {
        shadowVolume->record(commands, -sunlight.directionTo, medium.extinction, sunAllowed);
        showShadowVolume(sunAllowed);
    }
    const glm::vec3 eye = eyeVoxel();
    if (photons && (part != photon::Part::all || lightEye != eye)) {
        const photon::Light light = photons->light(part);
        photons->reconstruct(commands, eye, light);
        commands.barrier("collector radiance");
        if (!lightCounted || part != photon::Part::all) {
            lightField->recordCounts(commands, photons->fluences(), estimates(light));
            lightCounted = part == photon::Part::all;
        }
        lightField->record(commands, eye, photons->radiance());
        lightEye = part == photon::Part::all ? std::optional(eye) : std::nullopt;
    }
}

shared::DrawParams Renderer::State::drawParams() const {
    shared::DrawParams values{};
    values.view = frame::viewParams(camera);
    values.light = draw::lightParams(sunlight, scene.sky, medium.albedo, medium.tables);
    values.light.sunDisc = draw::lightParams(scene.sun, scene.sky, medium.albedo, medium.tables).sunDisc;
    values.field = fieldParams();
    values.sampling = draw::samplingGridOf(camera, shown, spacing, scene.draw.tolerance,
                                           static_cast<double>(values.field.voxelLength));
    values.samples = raysAcross;
    values.tilesAcross = billboards ? billboards->tilesAcross() : 0;
    return values;
}

void Renderer::State::recordPixels(const draw::FrameInputs& inputs, const shared::DrawPush& push) {
    if (billboards)
        billboards->record(commands, inputs, push);
    else
        march->record(commands, inputs, push);
}

/// SparseSampling points that are not drawn yet, what can be interpolated between them, and the rest.
void Renderer::State::recordBlocks(const draw::FrameInputs& inputs, const shared::SamplingGrid& sampling,
                                   const draw::Band& band, const Tile& pixels) {
    draw::Interpolation& interpolation = interpolations.at(spacing);
    const auto into = [&](const gpu::Buffer& target, const gpu::Buffer& list) {
        return draw::FrameInputs{inputs.params, inputs.phase, inputs.lightField, inputs.shadowVolume, target, list};
    };
    const draw::Band needed = draw::samplingRows(sampling, shown, band);
    const int first = std::max(needed.first, sampledRowsDrawn), end = needed.first + needed.rows;
    if (end > first) {
        recordPixels(into(interpolation.points(), inputs.squares),
                     {shared::DRAW_SPARSE, sampling.first + glm::ivec2(0, first), {sampling.size.x, end - first}});
        commands.barrier("sample points");
        sampledRowsDrawn = end;
    }
    interpolation.record(commands, inputs, pixels);
    commands.barrier("blocks");
    if (draw::hasRefinement(spacing)) {
        recordPixels(into(interpolation.refined(), interpolation.blocks()), interpolation.refinedPoints(pixels));
        commands.barrier("splitCounts");
        interpolation.recordRefined(commands, inputs, pixels);
        commands.barrier("cells");
    }
    recordPixels(into(inputs.pixels, interpolation.lastList()), interpolation.squares(pixels));
}

void Renderer::State::drawBand(LayeredImage* image, const draw::FrameInputs& inputs,
                               const shared::SamplingGrid& sampling, const draw::Band& band) {
    const Tile pixels{shown.x, shown.y + band.first, shown.width, band.rows};
    const Tile place{pixels.x - tile.x, pixels.y - tile.y, pixels.width, pixels.height};
    if (sampling.spacing > 1) interpolations.at(spacing).clearLists();
    commands.begin();
    if (sampling.spacing > 1)
        recordBlocks(inputs, sampling, band, pixels);
    else
        recordPixels(inputs, {shared::DRAW_PIXELS, {pixels.x, pixels.y}, {pixels.width, pixels.height}});
    if (image == nullptr) {
        commands.barrier("pixels");
        frame->recordBand(commands, inputs.pixels, place);
    }
    commands.submit();
    commands.wait();
    addTimes(commands.times());
    if (image == nullptr) return;
    frame::copyPixels(inputs.pixels.mapped<const shared::Pixel>(), *image, place);
    context.addDownloaded(static_cast<std::uint64_t>(place.width) * static_cast<std::uint64_t>(place.height) *
                          sizeof(shared::Pixel));
}

/// The light that this view sees, by all photons or by a part of them.
void Renderer::State::drawLight(photon::Part part) {
    if (photons) makeLightField(std::max<std::uint64_t>(1, photons->photonsInRing()));
    if (shadowVolume || photons) {
        commands.begin();
        recordLight(part);
        commands.submit();
        commands.wait();
        addTimes(commands.times());
    }
    if (billboards) billboards->prepare(camera);
}

/// Draws into the image, or into the frame on the GPU where there is no image.
void Renderer::State::drawBands(LayeredImage* image, const std::vector<draw::Band>& bands, const Report& told) {
    gpu::Buffer params(context, "draw params", sizeof(shared::DrawParams), gpu::Memory::host);
    const auto most = static_cast<std::uint64_t>(draw::bandRows(shown)) * static_cast<std::uint64_t>(shown.width);
    const gpu::Buffer pixels = image == nullptr
                                   ? draw::pixelBuffer(context, "pixels", most)
                                   : gpu::Buffer(context, "pixels", most * sizeof(shared::Pixel), gpu::Memory::host);
    // Stand for what the scene does not have: the shaders never read them, but every binding must be there.
    const gpu::Image none(context, "none", glm::ivec3(1), VK_FORMAT_R32G32B32A32_SFLOAT);
    const gpu::Buffer noSquares = draw::noSquares(context);
    params.mapped<shared::DrawParams>()[0] = drawParams();
    const shared::SamplingGrid sampling = params.mapped<shared::DrawParams>()[0].sampling;
    if (spacing > 1) {
        interpolations.try_emplace(spacing, context, spacing).first->second.prepare(sampling, draw::bandRows(shown));
        sampledRowsDrawn = 0;
    }
    const draw::FrameInputs inputs{
        params, *phase,   lightField ? lightField->image() : none, shadowVolume ? shadowVolume->image() : none,
        pixels, noSquares};
    told("drawing", 0, bands.size());
    for (std::size_t done = 0; done < bands.size(); ++done) {
        check();
        drawBand(image, inputs, sampling, bands[done]);
        told("drawing", done + 1, bands.size());
    }
    statistics.gpuBytes = context.allocatedBytes();
}

/// The frame as it is without a cloud, but for the part that the cloud may be seen in.
void Renderer::State::drawBackground() {
    const glm::ivec2 size(tile.width, tile.height);
    if (!frame || frame->size() != size) {
        frame.reset();
        frame.emplace(context, size);
    }
    commands.begin();
    frame->recordBackground(commands, glm::vec3(scene.sky.radiance),
                            frame::sunPixels(camera, tile, scene.sun, scene.sky, raysAcross, shown), shown);
    commands.submit();
    commands.wait();
    addTimes(commands.times());
}

/// A part of the frame as seen through the fog.
LayeredImage Renderer::State::throughFog(const Tile& wanted) {
    report("fog", 0, 1);
    fog->apply(*frame, camera, glm::vec3(scene.sky.radiance), wanted);
    addTimes(fog->takeTimes());
    std::vector<gpu::PassTime> times;
    LayeredImage image = frame->download(commands, wanted, times);
    addTimes(times);
    statistics.gpuBytes = context.allocatedBytes();
    report("fog", 1, 1);
    return image;
}

LayeredImage Renderer::draw() {
    return draw(sceneView());
}

View Renderer::sceneView() const {
    View view;
    view.camera = state_->scene.camera;
    view.image = state_->scene.image;
    return view;
}

int Renderer::raysAcross(const View& view) const {
    const State& s = *state_;
    if (!s.cloud) return 1;
    const double pixel = frame::pixelLength(makeCamera(view, s.bounds), s.middle());
    return std::min(view.mostRays, frame::raysAcross(std::cbrt(s.cloud->voxelVolume) / pixel));
}

glm::dvec3 Renderer::State::middle() const {
    return cloud->toWorld.point(0.5 * glm::dvec3(cloud->size));
}

/// Of the sampling, by the farthest voxels.
int Renderer::State::samplingSpacing() const {
    if (!cloud || scene.draw.tolerance <= 0.0) return 1;
    const glm::dvec3 away = middle() - camera.position;
    const double reach = 0.5 * glm::length(cloud->toWorld.linear * glm::dvec3(cloud->size));
    const glm::dvec3 farthest = camera.position + (glm::length(away) + reach) * camera.axes[2];
    return draw::samplingSpacing(std::cbrt(cloud->voxelVolume) / frame::pixelLength(camera, farthest));
}

const Bounds& Renderer::bounds() const {
    return state_->bounds;
}

void Renderer::State::showView(const View& view) {
    camera = makeCamera(view, bounds);
    tile = drawnTile(view);
}

LayeredImage Renderer::draw(const View& view) {
    State& s = *state_;
    const Stopwatch watch;
    s.showView(view);
    s.raysAcross = raysAcross(view);
    s.spacing = s.samplingSpacing();
    const Tile wanted = s.tile;
    if (s.fog) s.tile = {0, 0, view.image.width, view.image.height};  // its filter sees beyond the tile
    s.shown = s.shownPart();
    s.statistics.passes.clear();
    LayeredImage image;
    if (s.fog)
        s.drawBackground();
    else
        image = frame::skyImage(s.camera, s.tile, s.scene.sun, s.scene.sky, s.raysAcross, s.shown);
    if (s.photons) {
        s.photons->settle();
        s.addTimes(s.photons->times());
    }
    if (s.shown.height > 0) {
        s.drawLight(photon::Part::all);
        s.drawBands(s.fog ? nullptr : &image, draw::allBands(s.shown), s.report);
    }
    if (s.fog) image = s.throughFog(wanted);
    s.statistics.drawSeconds += watch.seconds();
    return image;
}

/// Voxels reach half a voxel farther than their bounds, billboards as far as the largest.
Tile Renderer::State::shownPart() const {
    if (!march && !billboards) return {tile.x, tile.y, 0, 0};
    const glm::dmat3& voxel = cloud->toWorld.linear;
    const double half = 0.5 * (glm::length(voxel[0]) + glm::length(voxel[1]) + glm::length(voxel[2]));
    Camera unmoved = camera;  // the bounds are those of the cloud without its offset
    unmoved.position -= offset;
    return draw::shownPart(unmoved, bounds, billboards ? billboards->reach() : half, tile);
}

/// Of the passes that were drawn last.
double Renderer::State::passSeconds() const {
    double milliseconds = 0.0;
    for (const PassTime& pass : statistics.passes) milliseconds += pass.milliseconds;
    return 1e-3 * milliseconds;
}

Preview Renderer::preview() {
    State& s = *state_;
    Preview preview;
    const View view = sceneView();
    s.showView(view);
    s.raysAcross = raysAcross(view);
    s.spacing = 1;
    s.shown = s.tile;
    const std::vector<draw::Band> bands = draw::sampleBands(s.tile);
    for (const draw::Band& band : bands)
        for (int row = 0; row < band.rows; ++row) preview.rows.push_back(band.first + row);
    preview.evenGenerations = s.photons->splitCounts().even;
    preview.oddGenerations = s.photons->splitCounts().odd;
    s.forgetLight();
    for (const photon::Part part : {photon::Part::even, photon::Part::odd}) {
        const Stopwatch watch;
        LayeredImage& image = part == photon::Part::even ? preview.even : preview.odd;
        image = frame::emptyFrame(s.tile);
        s.drawLight(part);
        const double whole = watch.seconds();
        s.statistics.passes.clear();
        s.drawBands(&image, bands, noReport);
        // the first of the two also pays for what is made once
        preview.forecastSeconds = whole + s.passSeconds() * s.camera.height / static_cast<double>(preview.rows.size()) *
                                              draw::drawnShare(s.samplingSpacing());
    }
    return preview;
}

}  // namespace lumulus
