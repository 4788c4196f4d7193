#include "frame/sky_pass.h"

#include <numbers>

#include "frame/view_params.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::frame {

namespace {

namespace spirv {
#include "spirv/frame/sky.comp.h"
}  // namespace spirv

}  // namespace

SkyPass::SkyPass(gpu::Context& context)
    : context_(context),
      program_(context, "sky", spirv::sky_comp),
      params_(context, "sky params", sizeof(shared::SkyPassParams), gpu::Memory::host) {}

void SkyPass::upload(std::optional<gpu::Image>& image, const char* name, glm::ivec3 size, bool volume,
                     const std::vector<glm::vec4>& texels) {
    if (!image || image->extent() != size) {
        image.reset();
        if (volume)
            image.emplace(context_, name, size, VK_FORMAT_R32G32B32A32_SFLOAT);
        else
            image.emplace(context_, name, glm::ivec2(size), VK_FORMAT_R32G32B32A32_SFLOAT);
    }
    gpu::upload(context_, *image, texels);
}

void SkyPass::update(const sky::Atmosphere& atmosphere, const Camera& camera, const scene::Sun& sun, double nearest,
                     double farthest) {
    const Made wanted{atmosphere.upAt(camera.position), atmosphere.heightAt(camera.position), sun.directionTo,
                      sun.irradiance};
    if (made_ != wanted) {
        const sky::SkyView view = sky::makeSkyView(atmosphere, camera.position, sun);
        const glm::ivec3 size(shared::SKY_COLUMNS, shared::SKY_ROWS + shared::GROUND_ROWS, 1);
        upload(scattered_, "sky scattered", size, false, view.scattered);
        upload(aerosol_, "sky aerosol", size, false, view.aerosol);
        sky_ = view.params;
        made_ = wanted;
    }
    const sky::AirBetween between =
        farthest > nearest ? sky::makeAirBetween(atmosphere, camera, sun, nearest, farthest) : sky::AirBetween{};
    upload(airLight_, "air light", between.size, true, between.light);
    upload(airTransmittance_, "air transmittance", between.size, true, between.transmittance);
    nearest_ = between.nearest;
    farthest_ = between.farthest;
}

void SkyPass::record(gpu::Commands& commands, const Frame& frame, const Camera& camera, const Tile& tile) {
    const bool panorama = camera.projection == scene::Projection::panorama;
    const double angle = (panorama ? std::numbers::pi : 2.0 * camera.tanHalfFov) / camera.height;
    params_.mapped<shared::SkyPassParams>()[0] = {
        viewParams(camera),           sky_, {tile.x, tile.y}, static_cast<float>(angle), static_cast<float>(nearest_),
        static_cast<float>(farthest_)};
    commands.pass("frame sky");
    commands.dispatch(program_,
                      {{"cloud", frame.cloud()},
                       {"radiance", frame.radiance()},
                       {"depth", frame.depth(), gpu::Sampler::nearest},
                       {"Params", params_},
                       {"skyScattered", *scattered_, gpu::Sampler::linearClamp},
                       {"skyAerosol", *aerosol_, gpu::Sampler::linearClamp},
                       {"airLight", *airLight_, gpu::Sampler::linearClamp},
                       {"airTransmittance", *airTransmittance_, gpu::Sampler::linearClamp}},
                      {}, gpu::pixelGroups(frame.size()));
}

}  // namespace lumulus::frame
