#include "render/picture.h"

#include <algorithm>
#include <limits>

#include "base/stopwatch.h"
#include "fog/screen/depth.h"
#include "frame/background.h"
#include "frame/sun_disc.h"
#include "render/painter_parts.h"
#include "render/view_light.h"
#include "render/world_fog.h"
#include "scene/ephemeris.h"
#include "sky/shell.h"

namespace lumulus {

namespace {

/// The sun as its disc is seen; without a disc where `state` shows none.
scene::Sun shownSun(const World& world, const ViewState::State& state) {
    scene::Sun sun = world.lights.sun;
    sun.directionTo = scene::apparentDirection(sun);
    if (!state.sunDisc) sun.angularDiameter = 0.0;
    return sun;
}

/// Where the eye is above level fog in an atmosphere.
fog::EyeAbove eyeAbove(const fog_light::AirOverFog& air, const Camera& camera) {
    const sky::Atmosphere& atmosphere = air.atmosphere();
    const double height = atmosphere.heightAt(camera.position);
    const double aboveTop = height - (air.top() - atmosphere.groundHeight());
    return {atmosphere.upAt(camera.position), sky::planetRadius + height,
            aboveTop > 0.0 ? std::optional(aboveTop) : std::nullopt};
}

}  // namespace

void PictureOrder::drawLight(ViewState::State& state, photon::Part part) {
    painter->findShown(work.context, world, state);
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
    const glm::vec3 sky = world.lights.environment.params().radiance;
    work.run([&](gpu::Commands& commands) {
        const Tile within{state.shown.x - state.tile.x, state.shown.y - state.tile.y, state.shown.width,
                          state.shown.height};
        state.frame->recordBackground(commands, sky, within);
    });
}

/// The sky and the ground behind the clouds, and the air before them.
void PictureOrder::drawAtmosphere(ViewState::State& state) {
    const bool fogged = world.airOverFog != nullptr;
    const sky::Atmosphere& air = fogged ? world.airOverFog->atmosphere() : *world.lights.environment.atmosphere();
    double nearest = std::numeric_limits<double>::max(), farthest = 0.0;
    for (const std::size_t i : world.visible()) {
        const double away = glm::length(world.instances[i].middle() - state.camera.position);
        nearest = std::min(nearest, std::max(0.0, away - 0.5 * world.instances[i].diagonal()));
        farthest = std::max(farthest, away + 0.5 * world.instances[i].diagonal());
    }
    if (state.meshes && state.meshes->shown.height > 0) {
        nearest = std::min(nearest, static_cast<double>(state.meshes->nearest));
        farthest = std::max(farthest, static_cast<double>(state.meshes->farthest));
    }
    if (state.shown.height <= 0) nearest = farthest;
    if (!state.sky) state.sky.emplace(work.context, world.lights.environment.moon(), fogged);
    state.sky->update(air, state.camera, world.lights.sun, nearest, farthest, state.coarse, world.airOverFog.get());
    work.run([&](gpu::Commands& commands) { state.sky->record(commands, *state.frame, state.camera, state.tile); });
}

/// The map of the surroundings behind the clouds.
void PictureOrder::drawMap(ViewState::State& state) {
    if (!state.map) state.map.emplace(work.context);
    work.run([&](gpu::Commands& commands) {
        state.map->record(commands, *state.frame, *world.lights.environment.map(), state.camera, state.tile);
    });
}

/// A part of the frame as seen through the fog. A sky that differs by direction differs from its mean, which is what
/// the fog takes for the same everywhere.
LayeredImage PictureOrder::throughFog(ViewState::State& state, const Tile& wanted) {
    report("fog", 0, 1);
    const glm::dvec3 sky = world.lights.environment.meanRadiance(state.camera.position, world.lights.sun);
    fog->apply(*state.frame, state.camera, glm::vec3(sky), wanted);
    frame::addTimes(work.times, fog->takeTimes());
    LayeredImage image = state.frame->download(work.commands, wanted, work.times);
    report("fog", 1, 1);
    return image;
}

/// Adds what is behind the clouds: ground and sun.
void PictureOrder::finish(LayeredImage& image, ViewState::State& state) {
    std::vector<shared::SunPixel> sun = frame::sunPixels(state.camera, state.tile, shownSun(world, state));
    if (ground != nullptr) {
        const auto seen =
            surface::seenGround(state.camera, state.tile, ground->light(work.context, world, state.coarse));
        surface::hideSun(sun, seen, state.tile.width);
        surface::addGround(image, seen, world.lights.constantSky());
    }
    frame::addSun(image, sun);
}

/// The same where there is fog. The tile is the whole picture, and the ground a layer of its own.
LayeredImage PictureOrder::finishInFog(ViewState::State& state, const Tile& wanted) {
    std::vector<shared::SunPixel> sun = frame::sunPixels(state.camera, state.tile, shownSun(world, state));
    if (ground == nullptr) {
        if (!sun.empty()) work.run([&](gpu::Commands& commands) { state.frame->recordSun(commands, sun); });
        return throughFog(state, wanted);
    }
    const glm::dvec3 sky = world.lights.constantSky();
    LayeredImage image = throughFog(state, wanted);
    const surface::GroundLight& light = ground->light(work.context, world, state.coarse);
    const auto seen = surface::seenGround(state.camera, state.tile, light);
    surface::hideSun(sun, seen, state.tile.width);
    const std::vector<glm::vec4> behind = groundThroughFog(*fog, state.camera, seen, sky, sun);
    frame::addTimes(work.times, fog->takeTimes());
    surface::addGround(image, surface::seenGround(state.camera, wanted, light), sky);  // for its depth
    layBehind(image, behind, wanted, state.tile.width);
    return image;
}

/// The same where sun and sky light the fog: it hides what is behind it and sends light of its own, pixel by pixel. The
/// filter spreads what clouds send beyond that.
LayeredImage PictureOrder::finishInLitFog(ViewState::State& state, const Tile& wanted) {
    std::vector<shared::SunPixel> sun = frame::sunPixels(state.camera, state.tile, shownSun(world, state));
    std::vector<glm::vec4> groundSeen;
    if (ground != nullptr) {
        const auto seen =
            surface::seenGround(state.camera, state.tile, ground->light(work.context, world, state.coarse));
        surface::hideSun(sun, seen, state.tile.width);
        for (const surface::GroundPixel& pixel : seen) groundSeen.emplace_back(pixel.radiance, pixel.share);
    }
    drawLitFog(state, sun, groundSeen);
    LayeredImage image = state.frame->download(work.commands, wanted, work.times);
    if (ground != nullptr)
        surface::addGroundDepth(
            image, surface::seenGround(state.camera, wanted, ground->light(work.context, world, state.coarse)));
    return image;
}

/// Fog, sun and ground, and what the filter spreads of the clouds' light.
void PictureOrder::drawLitFog(ViewState::State& state, const std::vector<shared::SunPixel>& sun,
                              const std::vector<glm::vec4>& groundSeen) {
    makeShadows(work, world, shadowReduction);
    litFog->update(*world.fogLight, world.fogVersion);
    fog::ShadowCasters casters = shadowCasters(world, state.camera);
    if (meshes != nullptr) meshes->addTo(casters, state.camera.position);
    const gpu::Image* sky = state.sky ? state.sky->behind() : nullptr;
    const fog_change::ChangeSeen* change =
        fogChange != nullptr ? &fogChange->seenBy(work.context, world, state.camera, state.coarse, check) : nullptr;
    work.run([&](gpu::Commands& commands) {
        if (!sun.empty()) {
            state.frame->recordSun(commands, sun);
            commands.barrier("sun");
        }
        litFog->record(commands, *state.frame, state.camera, state.tile, fogWithAir(world), casters, change, groundSeen,
                       sky, world.airOverFog ? eyeAbove(*world.airOverFog, state.camera) : fog::EyeAbove{});
    });
    const fog::LitFog::Excess excess = litFog->excess();
    if (fogChange == nullptr) return;
    fog::Fog& peaks = fogChange->peaks();
    if (excess.more != nullptr) peaks.addSpread(*state.frame, state.camera, *excess.more, 1.0F, excess.farthest);
    if (excess.less != nullptr) peaks.addSpread(*state.frame, state.camera, *excess.less, -1.0F, excess.farthest);
    frame::addTimes(work.times, peaks.takeTimes());
}

/// The discs of sun and moon as an eye at this place would see them through the air above it.
std::vector<shared::SunPixel> PictureOrder::discs(const ViewState::State& state, const glm::dvec3& eye) const {
    const sky::Environment& environment = world.lights.environment;
    Camera camera = state.camera;
    camera.position = eye;
    std::vector<shared::SunPixel> all =
        frame::sunPixels(camera, state.tile, shownSun(world, state), environment.atmosphere());
    if (!environment.moon() || !state.sunDisc) return all;
    for (const shared::SunPixel& pixel :
         frame::sunPixels(camera, state.tile, *environment.moon(), environment.atmosphere()))
        all.push_back(pixel);
    return all;
}

/// The ground of an atmosphere as pixels see it.
std::vector<glm::vec4> PictureOrder::planetSeen(const ViewState::State& state) {
    std::optional<surface::GroundLight> open;
    if (ground == nullptr) open = openGround(world, check);
    const surface::GroundLight& light = ground != nullptr ? ground->light(work.context, world, state.coarse) : *open;
    std::vector<glm::vec4> texels;
    for (const surface::GroundPixel& pixel : surface::seenGround(state.camera, state.tile, light))
        texels.emplace_back(pixel.radiance, pixel.share);
    return texels;
}

/// The same under an atmosphere. Seen from within the fog, its sky is behind the fog; seen from above, the air is
/// before it.
LayeredImage PictureOrder::finishInFoggyAir(ViewState::State& state, const Tile& wanted) {
    glm::dvec3 eye = state.camera.position;
    const bool above = eyeAbove(*world.airOverFog, state.camera).aboveTop.has_value();
    if (!above) eye.y = world.airOverFog->top();
    const std::vector<shared::SunPixel> sun = discs(state, eye);
    if (!above) drawAtmosphere(state);
    drawLitFog(state, above ? std::vector<shared::SunPixel>{} : sun, planetSeen(state));
    if (above) {
        drawAtmosphere(state);
        if (!sun.empty()) work.run([&](gpu::Commands& commands) { state.frame->recordSun(commands, sun); });
    }
    return state.frame->download(work.commands, wanted, work.times);
}

/// What follows the drawing into a frame.
LayeredImage PictureOrder::finished(ViewState::State& state, const Tile& wanted) {
    if (world.lights.environment.atmosphere() != nullptr) drawAtmosphere(state);
    if (world.lights.environment.map() != nullptr) drawMap(state);
    if (ground != nullptr && world.lights.planet) {
        const std::vector<shared::SunPixel> shade =
            groundShade(ground->light(work.context, world, state.coarse), *world.lights.environment.atmosphere(),
                        state.camera, state.tile);
        if (!shade.empty()) work.run([&](gpu::Commands& commands) { state.frame->recordSun(commands, shade); });
    }
    const auto addDisc = [&](const scene::Sun& of) {
        const std::vector<shared::SunPixel> disc =
            frame::sunPixels(state.camera, state.tile, of, world.lights.environment.atmosphere());
        if (!disc.empty()) work.run([&](gpu::Commands& commands) { state.frame->recordSun(commands, disc); });
    };
    addDisc(shownSun(world, state));
    if (world.lights.environment.moon() && state.sunDisc) addDisc(*world.lights.environment.moon());
    if (fog != nullptr) return throughFog(state, wanted);
    return state.frame->download(work.commands, {0, 0, state.tile.width, state.tile.height}, work.times);
}

LayeredImage PictureOrder::picture(ViewState::State& state, const View& view) {
    const Tile wanted = state.tile;
    if (fog != nullptr) state.tile = {0, 0, view.image.width, view.image.height};  // its filter sees beyond the tile
    state.meshes.reset();
    if (meshes != nullptr) state.meshes = meshes->draw(work, world, state.camera, state.tile, state.coarse, check);
    state.shown = painter != nullptr ? painter->shownPart(world, state) : Tile{state.tile.x, state.tile.y, 0, 0};
    if (state.meshes) state.shown = unite(state.shown, state.meshes->shown);
    LayeredImage image;
    if (inFrame())
        drawBackground(state);
    else
        image = frame::emptyFrame(state.tile, glm::dvec3(world.lights.environment.params().radiance));
    if (state.shown.height > 0 && painter == nullptr) {
        paintMeshes(work, *state.meshes, state.tile, glm::vec3(world.lights.environment.params().radiance),
                    inFrame() ? &*state.frame : nullptr, inFrame() ? nullptr : &image);
    } else if (state.shown.height > 0) {
        drawLight(state, photon::Part::all);
        painter->paint(work, world, state, draw::allBands(state.shown), inFrame() ? nullptr : &image, check, report);
    }
    if (world.airOverFog)
        image = finishInFoggyAir(state, wanted);
    else if (!world.lights.environment.isConstant())
        image = finished(state, wanted);
    else if (litFog != nullptr)
        image = finishInLitFog(state, wanted);
    else if (fog != nullptr)
        image = finishInFog(state, wanted);
    else
        finish(image, state);
    if (state.meshes) surface::addMeshIds(image, *state.meshes, wanted);
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
