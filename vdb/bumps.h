#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

/// Round bumps between sharp creases, as on a cauliflower, from a table of spheres (inside vdb/ only).
namespace lumulus::vdb {

/// One sphere in each cell of a unit grid, with a place and a radius of its own by a hash of the cell. The table holds
/// the spheres of the cells around one block of voxels, so that no voxel hashes: about 20 ns a value.
class BumpTable {
  public:
    /// Makes the spheres that points from `low` to `high` can meet. Coordinates are in cells.
    void cover(const glm::vec3& low, const glm::vec3& high, std::uint32_t seed);

    /// r² − d² of the sphere that has most of it, over the largest r²: 1 in the middle of the largest sphere, 0 outside
    /// of all. `point` lies within what the table covers.
    float at(const glm::vec3& point) const;

    /// The mean of at() over all space.
    static constexpr float mean = 0.299F;

  private:
    struct Sphere {
        glm::vec3 centre;     ///< in cells, from `origin_`
        float squaredRadius;  ///< cells²
    };

    glm::ivec3 origin_{0};  ///< first cell of the table
    glm::ivec3 size_{0};    ///< cells of the table
    std::vector<Sphere> spheres_;
};

}  // namespace lumulus::vdb
