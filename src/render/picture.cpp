#include "render/picture.h"

#include <algorithm>

#include "base/stopwatch.h"
#include "fog/screen/depth.h"
#include "frame/background.h"
#include "render/view_light.h"

namespace lumulus {

void PictureOrder::drawLight(ViewState::State& state, photon::Part part) {
    lightView(work, world, state, part, bands, shadowReduction);
    painter->prepare(work, state);
}

/// The frame as it is without a cloud, but for the part that clouds may be seen in.
void PictureOrder::drawBackground(ViewState::State& state) {
    const glm::ivec2 size(state.tile.width, state.tile.height);
    if (!state.frame || state.frame->size() != size) {
        state.frame.reset();
        state.frame.emplace(work.context, size);
    }
    work.run([&](gpu::Commands& commands) {
        state.frame->recordBackground(commands, glm::vec3(world.lights.environment.uniformRadiance()), state.shown);
    });
}

/// A part of the frame as seen through the fog.
LayeredImage PictureOrder::throughFog(ViewState::State& state, const Tile& wanted) {
    report("fog", 0, 1);
    fog->apply(*state.frame, state.camera, glm::vec3(world.lights.environment.uniformRadiance()), wanted);
    frame::addTimes(work.times, fog->takeTimes());
    LayeredImage image = state.frame->download(work.commands, wanted, work.times);
    report("fog", 1, 1);
    return image;
}

/// Adds what is behind the clouds: ground and sun.
void PictureOrder::finish(LayeredImage& image, ViewState::State& state) {
    std::vector<shared::SunPixel> sun = frame::sunPixels(state.camera, state.tile, world.lights.sun);
    if (ground != nullptr) {
        const auto seen = surface::seenGround(state.camera, state.tile, ground->light(work.context, world, check));
        surface::hideSun(sun, seen, state.tile.width);
        surface::addGround(image, seen, world.lights.environment.uniformRadiance());
    }
    frame::addSun(image, sun);
}

/// The same where there is fog. The tile is the whole picture, and the ground a layer of its own.
LayeredImage PictureOrder::finishInFog(ViewState::State& state, const Tile& wanted) {
    std::vector<shared::SunPixel> sun = frame::sunPixels(state.camera, state.tile, world.lights.sun);
    if (ground == nullptr) {
        if (!sun.empty()) work.run([&](gpu::Commands& commands) { state.frame->recordSun(commands, sun); });
        return throughFog(state, wanted);
    }
    const glm::dvec3& sky = world.lights.environment.uniformRadiance();
    LayeredImage image = throughFog(state, wanted);
    const surface::GroundLight& light = ground->light(work.context, world, check);
    const auto seen = surface::seenGround(state.camera, state.tile, light);
    surface::hideSun(sun, seen, state.tile.width);
    const std::vector<glm::vec4> behind = groundThroughFog(*fog, state.camera, seen, sky, sun);
    frame::addTimes(work.times, fog->takeTimes());
    surface::addGround(image, surface::seenGround(state.camera, wanted, light), sky);  // for its depth
    layBehind(image, behind, wanted, state.tile.width);
    return image;
}

LayeredImage PictureOrder::picture(ViewState::State& state, const View& view) {
    const Tile wanted = state.tile;
    if (fog != nullptr) state.tile = {0, 0, view.image.width, view.image.height};  // its filter sees beyond the tile
    state.shown = painter != nullptr ? painter->shownPart(world, state) : Tile{state.tile.x, state.tile.y, 0, 0};
    LayeredImage image;
    if (fog != nullptr)
        drawBackground(state);
    else
        image = frame::emptyFrame(state.tile, world.lights.environment.uniformRadiance());
    if (state.shown.height > 0) {
        drawLight(state, photon::Part::all);
        painter->paint(work, world, state, draw::allBands(state.shown), fog == nullptr ? &image : nullptr, check,
                       report);
    }
    if (fog != nullptr)
        image = finishInFog(state, wanted);
    else
        finish(image, state);
    if (!view.image.background) frame::leaveOutBackground(image);
    return image;
}

Preview PictureOrder::preview(ViewState::State& state) {
    Preview preview;
    const int spacing = state.spacing;
    state.spacing = 1;
    state.shown = state.tile;
    const std::vector<draw::Band> rows = draw::sampleBands(state.tile);
    for (const draw::Band& band : rows)
        for (int row = 0; row < band.rows; ++row) preview.rows.push_back(band.first + row);
    for (light::InstanceLight& light : world.light) light.changed();
    if (world.photons) {
        preview.evenGenerations = world.photons->splitCounts().even;
        preview.oddGenerations = world.photons->splitCounts().odd;
    }
    for (const photon::Part part : {photon::Part::even, photon::Part::odd}) {
        const Stopwatch watch;
        LayeredImage& image = part == photon::Part::even ? preview.even : preview.odd;
        image = frame::emptyFrame(state.tile);
        drawLight(state, part);
        const double whole = watch.seconds();
        work.times.clear();
        painter->paint(work, world, state, rows, &image, check, noReport);
        double milliseconds = 0.0;
        for (const gpu::PassTime& pass : work.times) milliseconds += pass.milliseconds;
        // the first of the two also pays for what is made once
        preview.forecastSeconds = whole + 1e-3 * milliseconds * state.camera.height /
                                              static_cast<double>(preview.rows.size()) * draw::drawnShare(spacing);
    }
    return preview;
}

LayeredImage seenThroughFog(fog::Fog& fog, const scene::Fog& media, const Camera& camera, LayeredImage picture,
                            std::vector<float> depth) {
    fog::depthToDistance(depth, media, camera);
    fog::Layer layer{std::vector<glm::vec4>(picture.pixels(), glm::vec4(1.0F)), std::move(depth)};
    const char* names[3] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel) {
        const std::vector<float>& values = picture.layers.at(names[channel]);
        for (std::size_t i = 0; i < values.size(); ++i) layer.radiance[i][channel] = std::max(0.0F, values[i]);
    }
    const std::vector<glm::vec4> seen = fog.apply(layer, camera);
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<float>& values = picture.layers.at(names[channel]);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = seen[i][channel];
    }
    return picture;
}

}  // namespace lumulus
