#pragma once

#include <optional>
#include <vector>

#include "base/image.h"
#include "shared/draw.h"
#include "surface/mesh/mesh_shading.h"
#include "view/camera.h"
#include "view/view.h"

namespace lumulus::surface {

/// What a part of a picture shows of meshes, row by row.
struct MeshPixels {
    Tile tile;
    std::vector<shared::MeshPixel> pixels;
    std::vector<float> edges;   ///< distances of the rays of pixels with edges, MESH_EDGE_RAYS² for each [m]
    std::vector<int> instance;  ///< that most rays of the pixel meet; −1: none
    Tile shown;                 ///< the smallest part with all pixels that show one; of height 0 where none does

    float nearest = shared::FAR_DEPTH, farthest = 0.0F;  ///< of all distances, metres

    /// A part of the tile with its own numbers of edges.
    MeshPixels part(const Tile& wanted) const;
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - tile.y) * static_cast<std::size_t>(tile.width) +
               static_cast<std::size_t>(x - tile.x);
    }
};

/// Draws meshes without what is in front of them: 2 × 2 rays a pixel, and MESH_EDGE_RAYS² where they do not meet the
/// same. `ground`: height of a level ground that ends rays. `directions`: of the light of a pixel. Errors: what `check`
/// throws.
MeshPixels drawMeshes(const Camera& camera, const Tile& tile, std::optional<double> ground, const MeshScene& scene,
                      RayTracer& tracer, MeshShading& shading, std::uint32_t directions, const RunGpu& run,
                      const Check& check);

/// The pixels without clouds, as a march leaves them, in front of a sky of that radiance.
std::vector<shared::Pixel> pixelsOf(const MeshPixels& meshes, const Tile& part, const glm::vec3& sky);

/// Adds the layer mesh.id to the picture of a part: 1 + the number of the instance, 0 where none is.
void addMeshIds(LayeredImage& image, const MeshPixels& meshes, const Tile& part);

}  // namespace lumulus::surface
