#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "vdb/read_limits.h"
#include "vdb/volume.h"

namespace lumulus::vdb {

/// Where the density of a file is.
struct VoxelBox {
    Affine toWorld;      ///< voxels → metres, the file's own coordinates
    glm::ivec3 size{0};  ///< voxels
};

/// The velocity of what is in a file: a grid of vectors called `vel`, `velocity` or `v`, in any case.
class VelocityField {
  public:
    /// None where the file has no such grid. Errors: InputError for a file that cannot be read, and for a grid whose
    /// transform is singular, that has values which are no numbers, or that lies outside of the cloud; Error where
    /// interrupted.
    static std::optional<VelocityField> read(const std::filesystem::path& path, const VoxelBox& density,
                                             const ReadLimits& limits);
    VelocityField(VelocityField&&) noexcept;
    VelocityField& operator=(VelocityField&&) noexcept;
    ~VelocityField();

    /// Interpolated, at a place in the file's own coordinates [m/s]. May be asked by several threads at once.
    glm::dvec3 at(const glm::dvec3& place) const;

  private:
    struct Grid;
    explicit VelocityField(std::unique_ptr<const Grid> grid);
    std::unique_ptr<const Grid> grid_;
};

}  // namespace lumulus::vdb
