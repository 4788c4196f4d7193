#pragma once

#include <span>
#include <vector>

#include "draw/drawing.h"
#include "render/view_state.h"
#include "render/world.h"
#include "view/camera.h"
#include "view/view.h"

/// What a painter's passes need to know of the visible instances of a world, in their order.
namespace lumulus {

/// `meshes`: whether the scene has some.
draw::DrawFeatures featuresOf(const World& world, bool meshes);
std::vector<const cloud::Instance*> instancesOf(const World& world);

/// Phase functions of all visible instances. Equal ones share tables: `numbers` becomes the number of each one's.
draw::PhaseTables makePhaseTables(gpu::Context& context, const World& world, const draw::DrawFeatures& how,
                                  std::span<int> numbers);

void setPlace(shared::InstanceParams& params, const cloud::Instance& instance, const Camera& camera);
/// `sun` as it reaches the instance; `phaseTable` as makePhaseTables() numbers it.
void setMedium(shared::InstanceParams& params, const phase::ScatteringMedium& medium, const scene::Sun& sun,
               int phaseTable);

/// Where the table of the instance at a place of the list begins in sunColourImage() [texels].
glm::ivec2 sunColourPlace(std::size_t place);
/// How the sun's light changes within each visible instance, in a world whose sky is an atmosphere.
gpu::Image sunColourImage(gpu::Context& context, const World& world);

gpu::Image skyReturnImage(gpu::Context& context, const photon::SkyReturn& sky);

/// What the pixels of a band show of the meshes of a view, as the march reads it; nothing where the view has none.
struct MeshBand {
    MeshBand(gpu::Context& context, const ViewState::State& view, const Tile& band);

    gpu::Buffer pixels, edges;

  private:
    MeshBand(gpu::Context& context, const surface::MeshPixels& meshes);
};

/// The smallest tile that holds both. An empty one adds nothing.
Tile unite(const Tile& a, const Tile& b);

}  // namespace lumulus
