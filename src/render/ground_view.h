#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "fog/screen/fog.h"
#include "light/photon/ground.h"
#include "render/gpu_work.h"
#include "render/world.h"
#include "surface/ground_light.h"
#include "surface/ground_picture.h"

namespace lumulus {

/// The ground of a world as pictures show it: its light is made anew where sun or clouds have changed.
class GroundView {
  public:
    /// `interactive`: the sun moves from picture to picture, and its shadow has fewer nodes.
    explicit GroundView(bool interactive) : sunNodes_(interactive ? 8192.0 : 65536.0) {}

    /// What meshes do to the light on a ground, of that sun and a sky of that radiance.
    using Meshes = std::function<surface::GroundMeshes(const scene::Ground&, const scene::Sun&, const glm::dvec3& sky)>;
    void setMeshes(Meshes meshes) { meshes_ = std::move(meshes); }
    /// Brings the light on the ground up to date, on all threads. A generation's check is not asked meanwhile: it draws
    /// pictures of others, and that only on the thread of the generation. For a `coarse` picture (View::coarse) the
    /// shadow of a sun that has moved has a quarter of the nodes. Errors: Error where interrupted.
    const surface::GroundLight& light(gpu::Context& context, World& world, bool coarse);
    /// The ground for the photons of the next generation. Errors: as above.
    photon::Ground forPhotons(gpu::Context& context, World& world);

  private:
    /// What the shares of sun and sky that arrive depend on.
    struct Clouds {
        std::vector<glm::dvec3> places;  ///< of all from the first
        std::vector<double> extinctions;
        double height = 0.0;  ///< of the first

        bool operator==(const Clouds&) const = default;
    };

    void update(gpu::Context& context, World& world, bool coarse);

    std::optional<surface::GroundLight> light_;
    Clouds clouds_;
    glm::dvec3 first_{0.0};  ///< where the first cloud was
    std::optional<scene::Sun> sun_;
    std::uint64_t fogVersion_ = 0;  ///< of the fog that sun and sky come through
    bool sunIsCoarse_ = false;
    double sunNodes_;
    Meshes meshes_;
};

/// What clouds change of the light of an atmosphere's ground, as pixels of a part of the picture see it through the air
/// [W/(m² sr)]; below 0 in shadows. Pixels that see no change are left out.
std::vector<shared::SunPixel> groundShade(const surface::GroundLight& light, const sky::Atmosphere& air,
                                          const Camera& camera, const Tile& tile);

/// The ground of a world's atmosphere without shadows of clouds, in the light of its fog. Errors: Error where
/// interrupted.
surface::GroundLight openGround(const World& world, const Check& check);

/// Throws InputError where a camera is below the ground.
void requireAbove(const scene::Ground& ground, const Camera& camera);

/// What is behind the clouds as seen through fog: ground, sky and the sun's disc, RGB row by row.
std::vector<glm::vec4> groundThroughFog(fog::Fog& fog, const Camera& camera,
                                        const std::vector<surface::GroundPixel>& ground, const glm::dvec3& sky,
                                        const std::vector<shared::SunPixel>& sun);

/// Puts what is behind the clouds into a part of a picture of that width: R, G, B = cloud + (1 − alpha) · behind.
void layBehind(LayeredImage& image, const std::vector<glm::vec4>& behind, const Tile& part, int width);

}  // namespace lumulus
