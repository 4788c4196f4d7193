#include "fog/screen/frame_layers.h"

#include <bit>

#include "fog/screen/light.h"
#include "gpu/transfer.h"
#include "shared/draw.h"

namespace lumulus::fog {

namespace {

namespace spirv {
#include "spirv/fog/join.comp.h"
#include "spirv/fog/split.comp.h"
}  // namespace spirv

gpu::Image oneDistance(gpu::Context& context, float distance) {
    gpu::Image image(context, "fog far", glm::ivec2(1), VK_FORMAT_R32_SFLOAT);
    gpu::upload(context, image, std::vector{distance});
    return image;
}

/// Uploads the values of a part of the picture, or the one value of all its pixels.
void upload(gpu::Context& context, std::optional<gpu::Image>& image, const char* name,
            const std::vector<glm::vec4>& values, const Tile& part) {
    const glm::ivec2 size = values.size() == 1 ? glm::ivec2(1) : glm::ivec2(part.width, part.height);
    if (!image || glm::ivec2(image->extent()) != size) {
        image.reset();
        image.emplace(context, name, size, lightFormat);
    }
    gpu::upload(context, *image, values);
}

}  // namespace

FrameLayers::FrameLayers(gpu::Context& context, const glm::ivec2& size)
    : context_(context),
      shadow_(context, "fog shadow", size, lightFormat),
      bright_(context, "fog bright", size, lightFormat),
      far_(oneDistance(context, shared::FAR_DEPTH)),
      seenCloud_(context, "fog cloud", size, lightFormat),
      summary_(context, "fog layer summary", sizeof(shared::LayerSummary), gpu::Memory::host),
      split_(context, "split", spirv::split_comp),
      join_(context, "join", spirv::join_comp) {}

void FrameLayers::recordSplit(gpu::Commands& commands, const frame::Frame& frame, const glm::vec3& sky) {
    summary_.mapped<shared::LayerSummary>()[0] = {};
    commands.pass("fog split");
    commands.dispatch(split_,
                      {{"cloud", frame.cloud(), gpu::Sampler::nearest},
                       {"radiance", frame.radiance(), gpu::Sampler::nearest},
                       {"depth", frame.depth(), gpu::Sampler::nearest},
                       {"shadow", shadow_},
                       {"bright", bright_},
                       {"Summary", summary_}},
                      {frame.size(), sky}, gpu::pixelGroups(frame.size()));
}

FrameLayers::Present FrameLayers::present() const {
    context_.addDownloaded(summary_.bytes());
    const shared::LayerSummary& found = summary_.mapped<const shared::LayerSummary>()[0];
    return {found.clouded != 0, found.lit != 0, static_cast<double>(std::bit_cast<float>(found.farthest))};
}

void FrameLayers::recordJoin(gpu::Commands& commands, const frame::Frame& frame, const Present& present,
                             const OpenSky& open, const Tile& part) {
    upload(context_, openSky_, "fog open sky", open.sky, part);
    upload(context_, ownLight_, "fog own light", open.own, part);
    const glm::ivec2 size(part.width, part.height);
    commands.pass("fog join");
    commands.dispatch(join_,
                      {{"cloud", frame.cloud()},
                       {"radiance", frame.radiance()},
                       {"seenCloud", seenCloud_, gpu::Sampler::nearest},
                       {"shadow", shadow_, gpu::Sampler::nearest},
                       {"bright", bright_, gpu::Sampler::nearest},
                       {"openSky", *openSky_, gpu::Sampler::nearest},
                       {"ownLight", *ownLight_, gpu::Sampler::nearest}},
                      {{part.x, part.y}, size, present.clouded, present.lit}, gpu::pixelGroups(size));
}

}  // namespace lumulus::fog
