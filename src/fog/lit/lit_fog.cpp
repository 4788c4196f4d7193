#include "fog/lit/lit_fog.h"

#include <algorithm>
#include <bit>

#include "frame/view_params.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "medium/fog_media.h"

namespace lumulus::fog {

namespace {

namespace spirv {
#include "spirv/fog/lit.comp.h"
}  // namespace spirv

constexpr VkFormat lightFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

std::vector<glm::vec4> texelsOf(const std::vector<glm::vec3>& values) {
    std::vector<glm::vec4> texels;
    texels.reserve(values.size());
    for (const glm::vec3& value : values) texels.emplace_back(value, 1.0F);
    return texels;
}

/// Which level, with fractions, lies at heights from the lowest level to the highest.
std::vector<float> levelTable(const std::vector<double>& levels) {
    std::vector<float> table;
    std::size_t level = 0;
    for (int i = 0; i < shared::FOG_HEIGHTS; ++i) {
        const double height = levels.front() + (levels.back() - levels.front()) * i / (shared::FOG_HEIGHTS - 1.0);
        while (level + 2 < levels.size() && levels[level + 1] < height) ++level;
        const double share = (height - levels[level]) / (levels[level + 1] - levels[level]);
        table.push_back(static_cast<float>(static_cast<double>(level) + std::clamp(share, 0.0, 1.0)));
    }
    return table;
}

template <class Size, class Texels>
void upload(gpu::Context& context, std::optional<gpu::Image>& image, const char* name, const Size& size,
            VkFormat format, const Texels& texels) {
    image.reset();
    image.emplace(context, name, size, format);
    gpu::upload(context, *image, texels);
}

}  // namespace

LitFog::LitFog(gpu::Context& context, const Has& has)
    : context_(context),
      ground_(has.ground),
      program_(context, "lit", spirv::lit_comp,
               {gpu::SpecConstant::of(4, has.many), gpu::SpecConstant::of(6, has.ground),
                gpu::SpecConstant::of(20, has.shadows), gpu::SpecConstant::of(24, has.air),
                gpu::SpecConstant::of(25, has.change)}),
      params_(context, "lit fog params", sizeof(shared::LitFogParams), gpu::Memory::host),
      summary_(context, "lit fog summary", sizeof(shared::LitFogSummary), gpu::Memory::host),
      none_(context, "no ground", glm::ivec2(1), lightFormat),
      noVolume_(context, "no shadow", glm::ivec3(1), VK_FORMAT_R32_SFLOAT),
      noChange_(context, "no change", glm::ivec3(1), lightFormat) {}

void LitFog::update(const fog_light::FogLight& light, std::uint64_t version) {
    light_ = &light;
    if (version_ == version) return;
    version_ = version;
    const auto levels = static_cast<int>(light.levels().size());
    upload(context_, levels_, "fog levels", glm::ivec2(shared::FOG_HEIGHTS, 1), VK_FORMAT_R32_SFLOAT,
           levelTable(light.levels()));
    const glm::ivec3 table(shared::FOG_COLUMNS, 2 * shared::FOG_ROWS, levels);
    upload(context_, scattered_, "fog scattered", table, lightFormat, texelsOf(light.scattered()));
    std::vector<glm::vec4> once;
    for (const auto& medium : light.once())
        for (const glm::vec3& value : medium) once.emplace_back(value, 1.0F);
    upload(context_, once_, "fog scattered once",
           glm::ivec3(2 * shared::FOG_ROWS, levels, static_cast<int>(light.once().size())), lightFormat, once);
}

shared::LitFogParams LitFog::paramsOf(const Camera& camera, const Tile& tile, const ShadowCasters& casters,
                                      const EyeAbove& eye) const {
    const fog_light::FogSetting& setting = light_->setting();
    const glm::dvec2 across(setting.toSun.x, setting.toSun.z);
    shared::LitFogParams params{};
    params.view = frame::viewParams(camera);
    params.first = {tile.x, tile.y};
    params.toSun = glm::vec3(setting.toSun);
    params.sunIrradiance = setting.toSun.y > 0.0 ? glm::vec3(setting.sun) : glm::vec3(0.0F);
    params.sunAcross = glm::length(across) > 1e-9 ? glm::vec2(glm::normalize(across)) : glm::vec2(1.0F, 0.0F);
    params.height = static_cast<float>(light_->top() - light_->bottom());
    params.levels = static_cast<int>(light_->levels().size());
    params.media = static_cast<int>(light_->once().size());
    params.airMedia = static_cast<int>(light_->layers().size() - light_->once().size());
    const double aboveTop = eye.aboveTop.value_or(camera.position.y - light_->top()), height = light_->top() + aboveTop;
    params.eyeHeight = static_cast<float>(height - light_->bottom());
    params.aboveTop = static_cast<float>(aboveTop);
    params.planetHeight = static_cast<float>(eye.fromMiddle);
    params.up = glm::vec3(eye.up);
    if (setting.groundHeight) params.aboveGround = static_cast<float>(height - *setting.groundHeight);
    params.meshes = casters.meshes != nullptr ? 1 : 0;
    params.casters = static_cast<int>(casters.texels.size()) / shared::CASTER_TEXELS - params.meshes;
    params.inverseShadows = casters.inverseSize;
    params.sky = glm::vec3(setting.sky);
    return params;
}

void LitFog::record(gpu::Commands& commands, const frame::Frame& frame, const Camera& camera, const Tile& tile,
                    const scene::Fog& fog, const ShadowCasters& casters, const fog_change::ChangeSeen* change,
                    const std::vector<glm::vec4>& groundSeen, const gpu::Image* skyBehind, const EyeAbove& eye) {
    shared::LitFogParams& params = params_.mapped<shared::LitFogParams>()[0];
    params = paramsOf(camera, tile, casters, eye);
    if (change != nullptr) {
        params.changeSize = glm::vec3(change->size);
        params.changeNear = static_cast<float>(change->near);
        params.changeFar = static_cast<float>(change->far);
        if (!change_ || change_->extent() != change->size) {
            change_.reset();
            change_.emplace(context_, "fog change", change->size, lightFormat);
        }
        gpu::upload(context_, *change_, change->light);
    }
    glm::dvec3 place = camera.position;  // of the eye as level fog has it
    if (eye.aboveTop) place.y = light_->top() + *eye.aboveTop;
    std::vector<shared::FogMedium> media = mediaAround(fog, place);
    for (std::size_t i = 0; i < light_->once().size(); ++i)
        media[i].scattering *= 1.0F - static_cast<float>(fog_light::truncatedShare(static_cast<double>(media[i].g)));
    media_.emplace(gpu::filledBuffer(context_, "lit fog media", media));
    const std::vector<glm::vec4> texels = casters.texels.empty() ? std::vector(1, glm::vec4(0.0F)) : casters.texels;
    casters_.emplace(context_, "shadow casters", texels.size(), lightFormat, gpu::Memory::device);
    gpu::upload(context_, *casters_, texels);
    if (ground_) upload(context_, groundSeen_, "ground seen", frame.size(), lightFormat, groundSeen);
    if (!more_ || glm::ivec2(more_->extent()) != frame.size()) {
        more_.reset(), less_.reset();
        more_.emplace(context_, "more light of clouds", frame.size(), lightFormat);
        less_.emplace(context_, "less light of clouds", frame.size(), lightFormat);
    }
    summary_.mapped<shared::LitFogSummary>()[0] = {};
    commands.pass("lit fog");
    commands.dispatch(
        program_,
        {{"cloud", frame.cloud()},
         {"radiance", frame.radiance()},
         {"depth", frame.depth(), gpu::Sampler::nearest},
         {"Params", params_},
         {"Media", *media_},
         {"levelTable", *levels_, gpu::Sampler::linearClamp},
         {"scattered", *scattered_, gpu::Sampler::linearClamp},
         {"changeSeen", change_ ? *change_ : noChange_, gpu::Sampler::linearClamp},
         {"onceScattered", *once_, gpu::Sampler::linearClamp},
         {"casters", *casters_},
         {"shadowVolume", casters.volumes != nullptr ? *casters.volumes : noVolume_, gpu::Sampler::linearClamp},
         {"meshHeights", casters.meshes != nullptr ? *casters.meshes : none_, gpu::Sampler::nearest},
         {"moreLight", *more_},
         {"lessLight", *less_},
         {"Summary", summary_},
         {"groundSeen", groundSeen_ ? *groundSeen_ : none_, gpu::Sampler::nearest},
         {"skyBehind", skyBehind != nullptr ? *skyBehind : none_, gpu::Sampler::nearest}},
        {}, gpu::pixelGroups(frame.size()));
}

LitFog::Excess LitFog::excess() const {
    context_.addDownloaded(summary_.bytes());
    const shared::LitFogSummary& found = summary_.mapped<const shared::LitFogSummary>()[0];
    return {found.more != 0 ? &*more_ : nullptr, found.less != 0 ? &*less_ : nullptr,
            static_cast<double>(std::bit_cast<float>(found.farthest))};
}

}  // namespace lumulus::fog
