#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

/// Where the pixels of environment maps look: a unit vector for each pixel, rows from the top. X, Y and Z are the axes
/// of the scene.
namespace lumulus::prefilter {

/// A cube map as OpenEXR has it (`envmap = cube`): size × 6 size pixels, faces +X −X +Y −Y +Z −Z one below the other,
/// the outer pixels of a face on its edges.
std::vector<glm::vec3> openExrCube(int size);

/// Names of the faces of graphics interfaces.
inline constexpr std::array<const char*, 6> faceNames{"px", "nx", "py", "ny", "pz", "nz"};

/// A face as OpenGL, Vulkan and Direct3D have it, in the order of faceNames: size × size pixels, which are areas. A
/// shader that samples the cube in a direction gets the light from there.
std::vector<glm::vec3> graphicsFace(int face, int size);

/// Middles of the pixels of a Panorama.
std::vector<glm::vec3> latLong(int width, int height);

}  // namespace lumulus::prefilter
