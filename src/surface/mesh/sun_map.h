#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "gpu/commands.h"
#include "surface/mesh/mesh_surface.h"

namespace lumulus::surface {

/// How high meshes reach towards the sun, seen from it: a point below that is in their shadow, whose edge is as sharp
/// as the map's texels. Axes of the map lie across the light and along it.
class SunMap {
  public:
    /// `toSun`: unit vector. Errors: what `check` throws.
    SunMap(gpu::Context& context, const MeshScene& scene, const glm::dvec3& toSun, const Check& check);

    const glm::dvec3& toSun() const { return toSun_; }
    /// Heights over the middle plane [m], one float a texel; −3e38 where there is no mesh.
    const gpu::Image& image() const { return image_; }
    /// Rows from places relative to `origin` to columns and rows of the map [texels] and height [m].
    std::array<glm::vec4, 3> rowsFrom(const glm::dvec3& origin) const;
    /// Rows from such places to the box around all meshes, along the map's axes, and its edges [m].
    std::array<glm::vec4, 4> boxFrom(const glm::dvec3& origin) const;

    /// Records what adds shadows to a shadow volume of a cloud: that of `size` texels from `origin` on in an image.
    /// `texelToWorld`: from numbers of texels to places, metres.
    void shade(gpu::Commands& commands, const gpu::Image& volume, const glm::ivec3& origin, const glm::ivec3& size,
               const glm::dmat4& texelToWorld) const;

    /// What photons ask of it (shared::MeshShadeParams and heights), whose cells have these edges and begin at a corner
    /// [m].
    gpu::Buffer forPhotons(gpu::Context& context, const glm::dmat3& cells, const glm::dvec3& corner) const;

  private:
    std::array<glm::vec4, 3> rowsOf(const glm::dmat3& cells, const glm::dvec3& corner) const;

    glm::dvec3 toSun_;
    glm::dmat3 toMap_;                    ///< rows: across, up, to the sun
    glm::dvec3 corner_{0.0}, size_{0.0};  ///< of the box in these axes, metres
    double texel_ = 1.0;                  ///< metres
    std::vector<float> heights_;
    gpu::Image image_;
    gpu::Program<shared::MeshVolumePush> program_;
};

}  // namespace lumulus::surface
