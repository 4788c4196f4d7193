#include "frame/frame.h"

#include <algorithm>

#include "frame/background.h"
#include "frame/pass_times.h"
#include "gpu/groups.h"

namespace lumulus::frame {

namespace {

namespace spirv {
#include "spirv/frame/background.comp.h"
#include "spirv/frame/read_band.comp.h"
#include "spirv/frame/sun_pixels.comp.h"
#include "spirv/frame/write_band.comp.h"
}  // namespace spirv

/// Rows that are read at once: as many as 2^18 pixels have.
int rowsAtOnce(const Tile& part) {
    return std::clamp((1 << 18) / part.width, 1, part.height);
}

}  // namespace

Frame::Frame(gpu::Context& context, const glm::ivec2& size)
    : context_(context),
      size_(size),
      cloud_(context, "frame cloud", size, VK_FORMAT_R32G32B32A32_SFLOAT),
      radiance_(context, "frame radiance", size, VK_FORMAT_R32G32B32A32_SFLOAT),
      depth_(context, "frame depth", size, VK_FORMAT_R32_SFLOAT),
      front_(context, "frame front", size, VK_FORMAT_R32_SFLOAT),
      background_(context, "background", spirv::background_comp),
      sun_(context, "sun_pixels", spirv::sun_pixels_comp),
      write_(context, "write_band", spirv::write_band_comp),
      read_(context, "read_band", spirv::read_band_comp) {}

void Frame::recordBackground(gpu::Commands& commands, const glm::vec3& sky, const Tile& without) const {
    commands.pass("frame background");
    commands.dispatch(background_, {{"cloud", cloud_}, {"radiance", radiance_}, {"depth", depth_}, {"front", front_}},
                      {size_, {without.x, without.y}, {without.width, without.height}, sky}, gpu::pixelGroups(size_));
}

void Frame::recordSun(gpu::Commands& commands, const std::vector<shared::SunPixel>& sunPixels) {
    sunPixels_.emplace(context_, "sun pixels", sunPixels.size() * sizeof(shared::SunPixel), gpu::Memory::host);
    std::ranges::copy(sunPixels, sunPixels_->mapped<shared::SunPixel>().begin());
    context_.addUploaded(sunPixels_->bytes());
    commands.pass("frame sun");
    commands.dispatch(sun_, {{"SunPixels", *sunPixels_}, {"radiance", radiance_}}, {static_cast<int>(sunPixels.size())},
                      gpu::linearGroups(sunPixels.size(), 64));
}

void Frame::recordBand(gpu::Commands& commands, const gpu::Buffer& pixels, const Tile& place) const {
    const glm::ivec2 rectangle(place.width, place.height);
    commands.pass("frame band");
    commands.dispatch(
        write_, {{"pixels", pixels}, {"cloud", cloud_}, {"radiance", radiance_}, {"depth", depth_}, {"front", front_}},
        {{place.x, place.y}, rectangle}, gpu::pixelGroups(rectangle));
}

LayeredImage Frame::download(gpu::Commands& commands, const Tile& part, std::vector<gpu::PassTime>& times) const {
    const int rows = rowsAtOnce(part);
    const gpu::Buffer pixels(
        context_, "frame pixels",
        static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(part.width) * sizeof(shared::Pixel),
        gpu::Memory::host);
    LayeredImage image = emptyFrame(part);
    for (int row = 0; row < part.height; row += rows) {
        const glm::ivec2 band(part.width, std::min(rows, part.height - row));
        commands.begin();
        commands.pass("frame download");
        commands.dispatch(read_,
                          {{"cloud", cloud_, gpu::Sampler::nearest},
                           {"radiance", radiance_, gpu::Sampler::nearest},
                           {"depth", depth_, gpu::Sampler::nearest},
                           {"front", front_, gpu::Sampler::nearest},
                           {"Pixels", pixels}},
                          {{part.x, part.y + row}, band}, gpu::pixelGroups(band));
        commands.submit();
        commands.wait();
        addTimes(times, commands.times());
        copyPixels(pixels.mapped<const shared::Pixel>(), image, {0, row, band.x, band.y});
    }
    context_.addDownloaded(image.pixels() * sizeof(shared::Pixel));
    return image;
}

}  // namespace lumulus::frame
