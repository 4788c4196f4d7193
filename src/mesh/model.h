#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

/// Triangle meshes as values: what a glTF file holds, in metres, +Y up.
namespace lumulus::mesh {

enum class Wrap { repeat, mirror, clamp };

/// A picture on surfaces, rows from the top.
struct Texture {
    int width = 0, height = 0;
    std::vector<std::array<std::uint8_t, 4>> texels;  ///< RGBA, x fastest
    Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
};

/// A material of glTF 2.0: metallic and roughness. A texture is an index into Model::textures, −1 without one; it
/// multiplies the values beside it.
struct Material {
    glm::vec3 colour{1.0F};  ///< base colour, linear Rec. 709; its texture is sRGB
    float metallic = 1.0F;
    float roughness = 1.0F;
    glm::vec3 emission{0.0F};  ///< radiance, W·m⁻²·sr⁻¹; its texture is sRGB
    float alpha = 1.0F;
    float alphaCutoff = 0.0F;  ///< where alpha is less, there is no surface; 0: everywhere is one
    float normalScale = 1.0F;
    int colourTexture = -1;
    int metallicRoughnessTexture = -1;  ///< roughness in G, metallic in B
    int emissionTexture = -1;
    int normalTexture = -1;

    bool masked() const { return alphaCutoff > 0.0F; }
};

struct Vertex {
    glm::vec3 position{0.0F};  ///< metres
    glm::vec3 normal{0.0F};    ///< unit vector
    glm::vec2 uv{0.0F};        ///< from the top left of textures
};

struct Triangle {
    glm::uvec3 vertices{0};
    std::uint32_t material = 0;
};

/// All triangles of a file, with the transforms of its nodes. At least one triangle and one material; indices are
/// valid and all numbers finite.
struct Model {
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;
    std::vector<Material> materials;
    std::vector<Texture> textures;
};

}  // namespace lumulus::mesh
