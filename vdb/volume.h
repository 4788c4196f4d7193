#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace lumulus::vdb {

/// world = linear · local + translation, in metres. Doubles are needed for clouds 1e7 m from the origin.
struct Affine {
    glm::dmat3 linear{1.0};
    glm::dvec3 translation{0.0};

    glm::dvec3 point(const glm::dvec3& local) const { return linear * local + translation; }
    glm::dvec3 vector(const glm::dvec3& local) const { return linear * local; }
};

/// A dense density field. Voxel (i,j,k) holds the value at *voxel coordinate* (i+½, j+½, k+½), trilinear between, so
/// that the field lives on [0,size.x]×[0,size.y]×[0,size.z] and voxel (i,j,k) owns the cube from (i,j,k) to
/// (i+1,j+1,k+1). The outermost voxels are zero (a ring that the loader adds), so that the interpolated field fades
/// within the box.
struct Volume {
    glm::ivec3 size{0};          ///< voxels along x, y, z, with the ring
    std::vector<float> density;  ///< size.x·size.y·size.z values ≥ 0, x fastest
    float maximum = 0.0F;        ///< largest value; 0 for a cloud with nothing in it
    Affine toWorld;              ///< voxel coordinates → metres
    std::string name;            ///< grid name, or the kind of a procedural cloud

    bool empty() const { return maximum <= 0.0F; }
    std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(size.x) +
               static_cast<std::size_t>(x);
    }
};

}  // namespace lumulus::vdb
