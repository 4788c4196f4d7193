#include "frame/sky_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include "frame/view_params.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::frame {

namespace {

namespace spirv {
#include "spirv/frame/sky.comp.h"
#include "spirv/frame/sky_fog.comp.h"
}  // namespace spirv

using Spirv = std::span<const std::uint32_t>;

}  // namespace

SkyPass::SkyPass(gpu::Context& context, const std::optional<scene::Sun>& moon, bool fog)
    : context_(context),
      program_(context, fog ? "sky_fog" : "sky", fog ? Spirv(spirv::sky_fog_comp) : Spirv(spirv::sky_comp),
               moon ? std::vector{gpu::SpecConstant::of(18, true)} : std::vector<gpu::SpecConstant>{}),
      params_(context, "sky params", fog ? sizeof(shared::SkyFogParams) : sizeof(shared::SkyPassParams),
              gpu::Memory::host),
      fog_(fog),
      moon_(moon) {
    if (moon_) return;
    upload(moonScattered_, "no moon", {1, 1, 1}, false, {glm::vec4(0.0F)});
    upload(moonAerosol_, "no moon", {1, 1, 1}, false, {glm::vec4(0.0F)});
}

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

// 1 mrad are 6 km on the planet, by which the sun's height changes by 0.06°. 2 % of the height change the horizon's dip
// by 1 % of it. By 0.01° of the sun's height twilight changes by half a per cent.
bool SkyPass::Made::isNear(const Made& other) const {
    constexpr double farthest = 1e-3, higher = 0.02, always = 2.0;  // radians, share, metres
    constexpr double sunHigher = 2e-4;                              // radians
    return std::abs(glm::dot(up, toSun) - glm::dot(up, other.toSun)) <= sunHigher && irradiance == other.irradiance &&
           fogTop == other.fogTop && groundAlbedo == other.groundAlbedo && glm::length(up - other.up) <= farthest &&
           std::abs(height - other.height) <= std::max(always, higher * std::abs(other.height));
}

void SkyPass::makeTables(const sky::Atmosphere& atmosphere, const glm::dvec3& eye, const scene::Sun& sun,
                         const fog_light::AirOverFog* fog) {
    const auto viewOf = [&](const scene::Sun& light) {
        return fog != nullptr ? fog->skyFrom(eye, light) : sky::makeSkyView(atmosphere, eye, light);
    };
    const sky::SkyView view = viewOf(sun);
    const glm::ivec3 size(shared::SKY_COLUMNS, shared::SKY_ROWS + shared::GROUND_ROWS, 1);
    upload(scattered_, "sky scattered", size, false, view.scattered);
    upload(aerosol_, "sky aerosol", size, false, view.aerosol);
    if (fog != nullptr) upload(transmittance_, "sky transmittance", {1, size.y, 1}, false, view.transmittance);
    sky_ = view.params;
    if (!moon_) return;
    const sky::SkyView moonlit = viewOf(*moon_);
    upload(moonScattered_, "moon scattered", size, false, moonlit.scattered);
    upload(moonAerosol_, "moon aerosol", size, false, moonlit.aerosol);
    moonSky_ = moonlit.params;
}

void SkyPass::update(const sky::Atmosphere& atmosphere, const Camera& camera, const scene::Sun& sun, double nearest,
                     double farthest, bool coarse, const fog_light::AirOverFog* fog) {
    const auto fogTop = fog != nullptr ? std::optional(fog->top() - atmosphere.groundHeight()) : std::nullopt;
    Made wanted{
        atmosphere.upAt(camera.position), atmosphere.heightAt(camera.position), sun.directionTo, sun.irradiance, fogTop,
        atmosphere.air().groundAlbedo};
    aboveFog_ = fogTop && wanted.height > *fogTop;
    if (fogTop) wanted.height = std::max(wanted.height, *fogTop);
    const bool serves = made_ && (*made_ == wanted || (coarse && made_->isNear(wanted)));
    if (!serves) {
        makeTables(atmosphere, camera.position, sun, fog);
        made_ = wanted;
    } else if (sky_.toSun != glm::vec3(wanted.toSun)) {
        sky::turnTo(sky_, made_->up, wanted.toSun);
    }
    sky::AirBetween between = farthest > nearest
                                  ? sky::makeAirBetween(atmosphere, camera, sun, nearest, farthest, fogTop, coarse)
                                  : sky::AirBetween{};
    if (moon_ && farthest > nearest) {
        const sky::AirBetween moonlit =
            sky::makeAirBetween(atmosphere, camera, *moon_, nearest, farthest, fogTop, coarse);
        for (std::size_t i = 0; i < between.light.size(); ++i) between.light[i] += moonlit.light[i];
    }
    upload(airLight_, "air light", between.size, true, between.light);
    upload(airTransmittance_, "air transmittance", between.size, true, between.transmittance);
    nearest_ = between.nearest;
    farthest_ = between.farthest;
}

void SkyPass::record(gpu::Commands& commands, const Frame& frame, const Camera& camera, const Tile& tile) {
    const bool panorama = camera.projection == scene::Projection::panorama;
    const double angle = (panorama ? std::numbers::pi : 2.0 * camera.tanHalfFov) / camera.height;
    const shared::SkyPassParams params{viewParams(camera),
                                       sky_,
                                       {tile.x, tile.y},
                                       static_cast<float>(angle),
                                       static_cast<float>(nearest_),
                                       static_cast<float>(farthest_),
                                       moonSky_};
    if (fog_)
        params_.mapped<shared::SkyFogParams>()[0] = {params, aboveFog_ ? 1 : 0};
    else
        params_.mapped<shared::SkyPassParams>()[0] = params;
    commands.pass("frame sky");
    std::vector<gpu::Binding> bindings{{"cloud", frame.cloud()},
                                       {"radiance", frame.radiance()},
                                       {"depth", frame.depth(), gpu::Sampler::nearest},
                                       {"Params", params_},
                                       {"skyScattered", *scattered_, gpu::Sampler::linearClamp},
                                       {"skyAerosol", *aerosol_, gpu::Sampler::linearClamp},
                                       {"moonScattered", *moonScattered_, gpu::Sampler::linearClamp},
                                       {"moonAerosol", *moonAerosol_, gpu::Sampler::linearClamp},
                                       {"airLight", *airLight_, gpu::Sampler::linearClamp},
                                       {"airTransmittance", *airTransmittance_, gpu::Sampler::linearClamp}};
    if (fog_) {
        if (!behind_ || glm::ivec2(behind_->extent()) != frame.size()) {
            behind_.reset();
            behind_.emplace(context_, "sky behind", frame.size(), VK_FORMAT_R32G32B32A32_SFLOAT);
        }
        bindings.emplace_back("skyTransmittance", *transmittance_, gpu::Sampler::linearClamp);
        bindings.emplace_back("skyBehind", *behind_);
    }
    commands.dispatch(program_, bindings, {}, gpu::pixelGroups(frame.size()));
}

}  // namespace lumulus::frame
