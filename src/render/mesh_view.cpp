#include "render/mesh_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "draw/bands.h"
#include "draw/drawing.h"
#include "frame/background.h"
#include "gpu/transfer.h"
#include "prefilter/panorama.h"
#include "render/world_media.h"

namespace lumulus {

namespace {

constexpr int aroundWidth = 512, aroundFaces = 128;  ///< pixels of the panorama and of the edge of a cube's face
constexpr std::uint32_t directions = 64, coarseDirections = 16;
constexpr double eyeAboveGround = 2.0;  ///< of the panorama at least, metres

std::optional<double> groundHeight(const World& world) {
    const scene::Ground* ground = world.shadedGround();
    return ground != nullptr ? std::optional(ground->height) : std::nullopt;
}

/// Edge of the cells in which the sun's light is known: it changes as fast as voxels do, or with the air.
double sunCell(const World& world, const query::Media& media) {
    constexpr double ofAir = 50.0, ofNothing = 1e6;
    if (media.clouds.size() > 0) return 0.5 * media.clouds.finestVoxel();
    return world.fog.media.empty() && world.lights.environment.isConstant() ? ofNothing : ofAir;
}

}  // namespace

MeshView::MeshView(gpu::Context& context, const scene::Scene& scene, const Check& check)
    : scene_(scene, check), solids_(surface::solidsOf(scene_)), tracer_(context, scene_) {}

View MeshView::surroundings(const World& world) const {
    const bvh::Box& box = scene_.world.box;
    glm::dvec3 eye = scene_.world.middle + glm::dvec3(box.middle());
    if (const auto height = groundHeight(world)) eye.y = std::max(eye.y, *height + eyeAboveGround);
    View view;
    view.camera.position = eye;
    view.camera.target = eye + glm::dvec3(1.0, 0.0, 0.0);  // as prefilter::Panorama has its middle
    view.camera.projection = scene::Projection::panorama;
    view.image.width = aroundWidth;
    view.image.height = aroundWidth / 2;
    view.sunDisc = false;
    return view;
}

void MeshView::setSun(gpu::Context& context, const World& world, const Check& check) {
    const scene::Sun& sun = world.lights.direct();
    const bool needed = world.lights.hasSun() && (world.fogLight || world.hasShadows() || world.photons);
    if (!needed || (sunMap_ && sunMap_->toSun() == sun.directionTo)) return;
    sunMap_.reset();
    sunMap_.emplace(context, scene_, sun.directionTo, check);
}

const gpu::Buffer& MeshView::forPhotons(gpu::Context& context, const World& world, const glm::dmat3& cells,
                                        const glm::dvec3& corner) {
    setSun(context, world, stopIfInterrupted);
    forPhotons_.reset();
    forPhotons_.emplace(sunMap_->forPhotons(context, cells, corner));
    return *forPhotons_;
}

void MeshView::addTo(fog::ShadowCasters& casters, const glm::dvec3& eye) const {
    if (!sunMap_) return;
    casters.meshes = &sunMap_->image();
    for (const glm::vec4& row : sunMap_->boxFrom(eye)) casters.texels.push_back(row);
    for (const glm::vec4& row : sunMap_->rowsFrom(eye)) casters.texels.push_back(row);
    for (int i = 0; i < 3; ++i) casters.texels.emplace_back(0.0F);
}

void MeshView::shade(gpu::Commands& commands, const cloud::Instance& instance, const light::ShadowGrid& grid,
                     const gpu::Image& volume, const glm::ivec3& origin) const {
    if (!sunMap_) return;
    glm::dmat4 texelToWorld(instance.voxelToMetres * grid.gridToVoxel);
    texelToWorld[3] = glm::dvec4(instance.voxelToMetres * grid.originVoxel + instance.origin + instance.offset, 1.0);
    sunMap_->shade(commands, volume, origin, grid.size, texelToWorld);
}

void MeshView::setLight(gpu::Context& context, World& world, const LayeredImage& seen,
                        const std::vector<scene::Lamp>& lamps, const Check& check) {
    const prefilter::Panorama around =
        prefilter::panoramaOf(seen.width, seen.height, seen.layers.at("R"), seen.layers.at("G"), seen.layers.at("B"));
    query::Media media = mediaOf(context, world, check);
    media.fog.media.clear();  // what reaches a point through it is known
    const scene::Sun& sun = world.lights.direct();
    const double cell = sunCell(world, media);
    const auto irradiance = [&world, media = std::move(media), check](std::span<const glm::dvec3> points) {
        std::vector<glm::dvec3> result(points.size());
        tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
            check();
            const scene::Sun there = world.lights.sunAt(points[i], world.fog);
            result[i] = there.irradiance;
            if (there.irradiance != glm::dvec3(0.0))
                result[i] *= media.along({points[i], there.directionTo}).transmittance();
        });
        return result;
    };
    light_ = surface::MeshLight{prefilter::CubeMap(around, aroundFaces, check),
                                surface::SunField(cell, groundHeight(world), irradiance), sun.directionTo,
                                glm::radians(0.5 * sun.angularDiameter)};
    if (!lamps.empty())
        light_->lamps = std::make_shared<surface::LampShading>(scene_, lamps, world.fog, scene_.world.middle,
                                                               cloudsForLamps(context, world, check));
    if (!shading_) shading_.emplace(scene_, tracer_, *light_);
}

surface::MeshPixels MeshView::draw(GpuWork& work, const World& world, const Camera& camera, const Tile& tile,
                                   bool coarse, const Check& check) {
    const surface::RunGpu run = [&](const std::function<void(gpu::Commands&)>& record) { work.run(record); };
    return surface::drawMeshes(camera, tile, groundHeight(world), scene_, tracer_, *shading_,
                               coarse ? coarseDirections : directions, run, check);
}

surface::GroundMeshes MeshView::shadeOn(const scene::Ground& ground, const scene::Sun& sun,
                                        const glm::dvec3& sky) const {
    return surface::shadeOnGround(scene_, ground, sun, sky, stopIfInterrupted);
}

void requireDrawableMeshes(const scene::Scene& scene, bool served) {
    if (scene.meshes.empty()) return;
    constexpr const char* leaveOut = "leave meshes out: --set mesh=[]";
    const std::string where = scene.source + ", mesh";
    if (served) throw InputError("meshes are not served", where, leaveOut);
    if (scene.draw.mode == scene::DrawMode::billboards)
        throw InputError("billboards are not drawn among meshes", where,
                         std::string("write draw.mode = \"march\", or ") + leaveOut);
}

void paintMeshes(GpuWork& work, const surface::MeshPixels& meshes, const Tile& tile, const glm::vec3& sky,
                 const frame::Frame* frame, LayeredImage* image) {
    for (const draw::Band& band : draw::allBands(meshes.shown)) {
        const Tile part{meshes.shown.x, meshes.shown.y + band.first, meshes.shown.width, band.rows};
        const Tile place{part.x - tile.x, part.y - tile.y, part.width, part.height};
        const std::vector<shared::Pixel> pixels = surface::pixelsOf(meshes, part, sky);
        if (image != nullptr) {
            frame::copyPixels(pixels, *image, place);
            continue;
        }
        const gpu::Buffer buffer = draw::pixelBuffer(work.context, "mesh pixels", pixels.size());
        gpu::upload(work.context, buffer, pixels);
        work.run([&](gpu::Commands& commands) { frame->recordBand(commands, buffer, place); });
    }
}

}  // namespace lumulus
