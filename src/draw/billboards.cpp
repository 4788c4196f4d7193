#include "draw/billboards.h"

#include <algorithm>
#include <tuple>

#include "draw/billboard_shares.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/billboards.comp.h"
}  // namespace spirv

/// Two texels each: the sphere; its share and its instance.
std::vector<glm::vec4> billboardTexels(const std::vector<shared::Billboard>& billboards) {
    std::vector<glm::vec4> texels;
    texels.reserve(2 * billboards.size());
    for (const shared::Billboard& b : billboards) {
        texels.emplace_back(b.centre, b.radius);
        texels.emplace_back(b.share, b.instance, 0.0F, 0.0F);
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

std::vector<shared::Billboard> makeBillboards(std::span<const cloud::Instance* const> instances,
                                              std::span<const std::vector<float>> shares, const Camera& camera) {
    struct Placed {
        double order;
        std::size_t instance, collector;
        shared::Billboard billboard;
    };
    std::vector<Placed> placed;
    const bool parallel = camera.projection == scene::Projection::orthographic;
    for (std::size_t number = 0; number < instances.size(); ++number) {
        const cloud::Instance& instance = *instances[number];
        const cloud::Asset& asset = *instance.asset;
        for (std::size_t i = 0; i < asset.collectors.size(); ++i) {
            const cloud::Collector& collector = asset.collectors[i];
            const glm::dvec3 centre = instance.toWorld(glm::dvec3(collector.centre)) - camera.position;
            const auto radius = static_cast<float>(instance.scale() * billboardRadius(asset, collector));
            const double order = parallel ? glm::dot(centre, camera.axes[2]) : glm::dot(centre, centre);
            placed.push_back(
                {order, number, i, {glm::vec3(centre), radius, shares[number][i], static_cast<float>(number)}});
        }
    }
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return std::tie(a.order, a.instance, a.collector) < std::tie(b.order, b.instance, b.collector);
    });
    std::vector<shared::Billboard> billboards;
    billboards.reserve(placed.size());
    for (const Placed& p : placed) billboards.push_back(p.billboard);
    return billboards;
}

Billboards::Billboards(gpu::Context& context, std::span<const cloud::Instance* const> instances,
                       const DrawFeatures& features)
    : instances_(instances.begin(), instances.end()),
      program_(context, "billboards", spirv::billboards_comp, features.constants()) {
    for (const cloud::Instance* instance : instances_) {
        if (const std::size_t same = firstWith(instance->asset); same < shares_.size())
            shares_.push_back(shares_[same]);
        else
            shares_.push_back(billboardShares(context, *instance->asset));
        reach_.push_back(0.0);
        for (const cloud::Collector& collector : instance->asset->collectors)
            reach_.back() = std::max(reach_.back(), instance->scale() * billboardRadius(*instance->asset, collector));
    }
}

std::size_t Billboards::firstWith(const cloud::Asset* asset) const {
    return static_cast<std::size_t>(
        std::ranges::find(instances_, asset, [](const cloud::Instance* i) { return i->asset; }) - instances_.begin());
}

Billboards::View::View(gpu::Context& context, const Billboards& billboards, const Camera& camera)
    : View(context, makeBillboards(billboards.instances_, billboards.shares_, camera), camera) {}

Billboards::View::View(gpu::Context& context, const std::vector<shared::Billboard>& billboards, const Camera& camera)
    : tiles_(makeTileLists(camera, billboards)),
      billboards_(listImage(context, "billboards", billboardTexels(billboards), VK_FORMAT_R32G32B32A32_SFLOAT)),
      lists_(listImage(context, "tile lists", tiles_.lists, VK_FORMAT_R32_UINT)),
      offsets_(gpu::filledBuffer(context, "tile offsets", tiles_.offsets)) {}

void Billboards::record(gpu::Commands& commands, const DrawInputs& inputs, const View& view,
                        const shared::DrawPush& push) const {
    std::vector<gpu::Binding> bindings = inputs.bindings();
    bindings.emplace_back("billboards", view.billboards_);
    bindings.emplace_back("TileOffsets", view.offsets_);
    bindings.emplace_back("tileLists", view.lists_);
    commands.pass("billboards");
    dispatchDrawing(commands, program_, bindings, inputs.squares, push);
}

}  // namespace lumulus::draw
