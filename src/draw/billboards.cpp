#include "draw/billboards.h"

#include <algorithm>

#include "draw/billboard_shares.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/billboards.comp.h"
}  // namespace spirv

/// Two texels each: the sphere; its share.
std::vector<glm::vec4> billboardTexels(const std::vector<shared::Billboard>& billboards) {
    std::vector<glm::vec4> texels;
    texels.reserve(2 * billboards.size());
    for (const shared::Billboard& b : billboards) {
        texels.emplace_back(b.centre, b.radius);
        texels.emplace_back(b.share, 0.0F, 0.0F, 0.0F);
    }
    return texels;
}

/// A list as rows of an image, the last one filled up.
template <class Texel>
gpu::Image listImage(gpu::Context& context, const char* name, std::vector<Texel> texels, VkFormat format) {
    const std::size_t width = shared::LIST_WIDTH, rows = std::max<std::size_t>(1, (texels.size() + width - 1) / width);
    texels.resize(rows * width);
    gpu::Image image(context, name, glm::ivec2(width, rows), format);
    gpu::upload(context, image, texels);
    return image;
}

}  // namespace

std::vector<shared::Billboard> makeBillboards(const cloud::Cloud& cloud, std::span<const float> shares,
                                              const Camera& camera) {
    struct Placed {
        double order;
        std::size_t collector;
        shared::Billboard billboard;
    };
    std::vector<Placed> placed;
    placed.reserve(cloud.collectors.size());
    const bool parallel = camera.projection == scene::Projection::orthographic;
    for (std::size_t i = 0; i < cloud.collectors.size(); ++i) {
        const cloud::Collector& collector = cloud.collectors[i];
        const glm::dvec3 centre = cloud.toWorld.point(glm::dvec3(collector.centre)) - camera.position;
        const auto radius = static_cast<float>(billboardRadius(cloud, collector));
        const double order = parallel ? glm::dot(centre, camera.axes[2]) : glm::dot(centre, centre);
        placed.push_back({order, i, {glm::vec3(centre), radius, shares[i]}});
    }
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return a.order < b.order || (a.order == b.order && a.collector < b.collector);
    });
    std::vector<shared::Billboard> billboards;
    billboards.reserve(placed.size());
    for (const Placed& p : placed) billboards.push_back(p.billboard);
    return billboards;
}

Billboards::Billboards(gpu::Context& context, const cloud::Cloud& cloud, const DrawFeatures& features)
    : context_(context),
      cloud_(cloud),
      program_(context, "billboards", spirv::billboards_comp, features.constants()),
      shares_(billboardShares(context, cloud)),
      offsets_(context, "tile offsets", 0, gpu::Memory::device) {
    for (const cloud::Collector& collector : cloud.collectors)
        reach_ = std::max(reach_, billboardRadius(cloud, collector));
}

void Billboards::prepare(const Camera& camera) {
    const std::vector<shared::Billboard> billboards = makeBillboards(cloud_, shares_, camera);
    tiles_ = makeTileLists(camera, billboards);
    billboards_.emplace(listImage(context_, "billboards", billboardTexels(billboards), VK_FORMAT_R32G32B32A32_SFLOAT));
    offsets_ = gpu::filledBuffer(context_, "tile offsets", tiles_.offsets);
    lists_.emplace(listImage(context_, "tile lists", tiles_.lists, VK_FORMAT_R32_UINT));
}

void Billboards::record(gpu::Commands& commands, const FrameInputs& inputs, const shared::DrawPush& push) const {
    std::vector<gpu::Binding> bindings = inputs.bindings();
    bindings.emplace_back("billboards", *billboards_);
    bindings.emplace_back("TileOffsets", offsets_);
    bindings.emplace_back("tileLists", *lists_);
    bindings.emplace_back("density", cloud_.density, gpu::Sampler::linear);
    commands.pass("billboards");
    dispatchDrawing(commands, program_, bindings, inputs.squares, push);
}

}  // namespace lumulus::draw
