#include "frame/map_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "frame/view_params.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::frame {

namespace {

namespace spirv {
#include "spirv/frame/sky_map.comp.h"
}  // namespace spirv

constexpr int mostWidth = 4096;  ///< of a map on the device: 128 MiB
constexpr int mostSamples = 4;

/// Angle of a pixel in the middle of a picture [radians].
double pixelAngle(const Camera& camera) {
    const bool panorama = camera.projection == scene::Projection::panorama;
    return (panorama ? std::numbers::pi : 2.0 * camera.tanHalfFov) / camera.height;
}

}  // namespace

MapPass::MapPass(gpu::Context& context)
    : context_(context),
      program_(context, "sky map", spirv::sky_map_comp),
      params_(context, "sky map params", sizeof(shared::SkyMapParams), gpu::Memory::host) {}

void MapPass::upload(const sky::MapSky& map, int width) {
    if (image_ && width_ == width) return;
    const sky::LatLong shown = width < map.pixels().width ? sky::reduced(map.pixels(), width) : map.pixels();
    std::vector<glm::vec4> texels;
    texels.reserve(static_cast<std::size_t>(shown.width + 2) * static_cast<std::size_t>(shown.height));
    for (int y = 0; y < shown.height; ++y)
        for (int x = -1; x <= shown.width; ++x) texels.emplace_back(shown.at((x + shown.width) % shown.width, y), 1.0F);
    image_.reset();
    image_.emplace(context_, "sky map", glm::ivec2(shown.width + 2, shown.height), VK_FORMAT_R32G32B32A32_SFLOAT);
    gpu::upload(context_, *image_, texels);
    width_ = width;
}

void MapPass::record(gpu::Commands& commands, const Frame& frame, const sky::MapSky& map, const Camera& camera,
                     const Tile& tile) {
    // texels of half a pixel at least, in steps of two, so that a zoom does not make another map for each picture
    const double pixel = pixelAngle(camera);
    int width = map.pixels().width;
    while (width > mostWidth || (width > 64 && 2.0 * std::numbers::pi / width < 0.5 * pixel)) width = (width / 4) * 2;
    upload(map, width);
    const double texel = 2.0 * std::numbers::pi / width;
    shared::SkyMapParams params{};
    params.view = viewParams(camera);
    params.toMap = glm::mat3(glm::transpose(map.axes()));
    params.size = glm::vec2(width, width / 2);
    params.first = {tile.x, tile.y};
    params.samples = std::clamp(static_cast<int>(std::ceil(2.0 * pixel / texel)), 1, mostSamples);
    params_.mapped<shared::SkyMapParams>()[0] = params;
    commands.pass("frame sky map");
    commands.dispatch(program_,
                      {{"cloud", frame.cloud()},
                       {"radiance", frame.radiance()},
                       {"Params", params_},
                       {"map", *image_, gpu::Sampler::linearClamp}},
                      {}, gpu::pixelGroups(frame.size()));
}

}  // namespace lumulus::frame
