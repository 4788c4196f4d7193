#include "cloud/bricks.h"

#include <algorithm>

#include "gpu/commands.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "shared/cloud.h"

namespace lumulus::cloud {

namespace {

namespace spirv {
#include "spirv/cloud/copy_index.comp.h"
}  // namespace spirv

constexpr std::uint64_t indexWidth = 1024;

VkFormat formatOf(vdb::DensityFormat format) {
    return format == vdb::DensityFormat::r8 ? VK_FORMAT_R8_UNORM : VK_FORMAT_R16_SFLOAT;
}

/// Room for so many texels, and for some more in the last row and slice.
glm::ivec3 indexExtent(std::uint64_t texels) {
    const std::uint64_t rows = std::max<std::uint64_t>((texels + indexWidth - 1) / indexWidth, 1);
    const std::uint64_t slices = (rows + indexWidth - 1) / indexWidth;
    return {indexWidth, std::min(rows, indexWidth), slices};
}

/// Copies texels of whole slots from the host to their places in the pool.
class SlotUpload {
  public:
    SlotUpload(gpu::Context& context, const gpu::Image& pool, std::uint64_t slotBytes)
        : context_(context),
          pool_(pool),
          slotBytes_(slotBytes),
          stride_((slotBytes + 3) / 4 * 4),
          staging_(context, "brick staging", together * stride_, gpu::Memory::host) {}

    void upload(const vdb::SparseVolume& volume, std::uint32_t first, std::span<const std::byte> texels) {
        const std::uint64_t slots = texels.size() / slotBytes_;
        for (std::uint64_t begin = 0; begin < slots; begin += together) {
            const std::uint64_t count = std::min(together, slots - begin);
            std::vector<VkBufferImageCopy> regions;
            for (std::uint64_t i = 0; i < count; ++i) {
                const auto slot = texels.subspan((begin + i) * slotBytes_, slotBytes_);
                std::ranges::copy(slot, staging_.mapped<std::byte>().subspan(i * stride_).begin());
                regions.push_back(
                    regionOf(volume.slotAt(volume.firstSlot + first + static_cast<std::uint32_t>(begin + i)), i));
            }
            context_.immediately([&](VkCommandBuffer commands) {
                context_.api().vkCmdCopyBufferToImage(commands, staging_.handle(), pool_.handle(),
                                                      VK_IMAGE_LAYOUT_GENERAL,
                                                      static_cast<std::uint32_t>(regions.size()), regions.data());
            });
            context_.addUploaded(count * slotBytes_);
        }
    }

  private:
    static constexpr std::uint64_t together = 1024;

    VkBufferImageCopy regionOf(const glm::uvec3& slot, std::uint64_t number) const {
        constexpr std::uint32_t edge = vdb::SparseVolume::slotEdge;
        const glm::ivec3 corner(edge * slot);
        return {number * stride_,  0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {corner.x, corner.y, corner.z},
                {edge, edge, edge}};
    }

    gpu::Context& context_;
    const gpu::Image& pool_;
    std::uint64_t slotBytes_, stride_;  ///< offsets of copies are multiples of 4 on some devices
    gpu::Buffer staging_;
};

}  // namespace

std::shared_ptr<const gpu::Image> makePool(gpu::Context& context, std::span<vdb::SparseVolume* const> volumes,
                                           const Check& check) {
    std::size_t slots = 0;
    vdb::DensityFormat format = vdb::DensityFormat::r8;
    for (const vdb::SparseVolume* volume : volumes) {
        slots += volume->slots.size();
        if (volume->format != vdb::DensityFormat::r8) format = volume->format;
    }
    const int width = vdb::poolWidthFor(slots);
    const auto layer = static_cast<std::size_t>(width) * static_cast<std::size_t>(width);
    const auto layers = static_cast<int>(std::max<std::size_t>((slots + layer - 1) / layer, 1));
    const glm::ivec3 size = vdb::SparseVolume::slotEdge * glm::ivec3(width, width, layers);
    auto pool = std::make_shared<gpu::Image>(context, "density bricks", size, formatOf(format));
    gpu::clear(context, *pool);  // slots that nobody has must not hold what is no number
    SlotUpload upload(context, *pool, vdb::SparseVolume::slotTexels * vdb::texelBytes(format));
    std::uint32_t first = 0;
    for (vdb::SparseVolume* volume : volumes) {
        volume->format = format;
        vdb::placeSlots(*volume, width, first);
        vdb::fillSlots(
            *volume,
            [&](std::uint32_t number, std::span<const std::byte> texels) { upload.upload(*volume, number, texels); },
            check);
        first += static_cast<std::uint32_t>(volume->slots.size());
    }
    return pool;
}

gpu::Image makeIndexImage(gpu::Context& context, const char* name, std::vector<glm::uvec2> texels) {
    const glm::ivec3 extent = indexExtent(texels.size());
    gpu::Image image(context, name, extent, VK_FORMAT_R32G32_UINT);
    texels.resize(image.bytes() / sizeof(glm::uvec2), glm::uvec2(0));
    gpu::upload(context, image, texels);
    return image;
}

gpu::Image makeBrickIndex(gpu::Context& context, const vdb::SparseVolume& volume) {
    std::vector<glm::uvec2> texels;
    texels.reserve(volume.nodes.size() + volume.entries.size());
    const auto first = static_cast<std::uint32_t>(volume.nodes.size());
    for (const std::uint32_t node : volume.nodes) texels.emplace_back(first + vdb::SparseVolume::nodeEntries * node, 0);
    for (const vdb::BrickEntry& entry : volume.entries) texels.emplace_back(entry.place, entry.range);
    return makeIndexImage(context, "brick index", std::move(texels));
}

JoinedIndex joinIndices(gpu::Context& context, std::span<const gpu::Image* const> indices) {
    const auto texelsOf = [](const gpu::Image& image) {
        return static_cast<std::uint32_t>(image.bytes() / sizeof(glm::uvec2));
    };
    std::vector<std::uint32_t> firsts;
    std::uint32_t texels = 0;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const auto same = static_cast<std::size_t>(std::ranges::find(indices, indices[i]) - indices.begin());
        firsts.push_back(same == i ? texels : firsts[same]);
        if (same == i) texels += texelsOf(*indices[i]);
    }
    JoinedIndex joined{gpu::Image(context, "brick indices", indexExtent(texels), VK_FORMAT_R32G32_UINT), firsts};
    const gpu::Program<shared::CopyIndexPush> program(context, "copy_index", spirv::copy_index_comp);
    gpu::Commands commands(context);
    commands.begin();
    commands.pass("brick indices");
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (std::ranges::find(indices, indices[i]) - indices.begin() != static_cast<std::ptrdiff_t>(i)) continue;
        commands.dispatch(program, {{"source", *indices[i], gpu::Sampler::nearest}, {"target", joined.image}},
                          {texelsOf(*indices[i]), firsts[i]}, gpu::linearGroups(texelsOf(*indices[i]), 64));
        commands.barrier("index copied");
    }
    commands.submit();
    commands.wait();
    return joined;
}

}  // namespace lumulus::cloud
