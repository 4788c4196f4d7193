#pragma once

#include "fuzz/promise.h"
#include "mesh/gltf.h"

namespace lumulus::test {

/// Reads bytes as a glTF file. Throws std::logic_error where a model's indices or numbers are not what it promises.
inline void feed(std::span<const std::byte> input) {
    readOrRefuse(input, "input.gltf", [](const std::filesystem::path& path) {
        const mesh::Model model = mesh::loadGltf(path);
        promise(!model.triangles.empty() && !model.materials.empty(), "a model has triangles and materials");
        for (const mesh::Triangle& triangle : model.triangles) {
            for (int corner = 0; corner < 3; ++corner)
                promise(triangle.vertices[corner] < model.vertices.size(), "corners are vertices");
            promise(triangle.material < model.materials.size(), "a triangle has a material");
        }
        for (const mesh::Vertex& vertex : model.vertices)
            promise(glm::dot(vertex.position, vertex.position) < 1e15F && glm::dot(vertex.normal, vertex.normal) < 2.0F,
                    "vertices are finite");
        for (const mesh::Texture& texture : model.textures)
            promise(texture.texels.size() ==
                        static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height),
                    "a texture has the size of its picture");
        for (const mesh::Material& material : model.materials)
            for (const int texture : {material.colourTexture, material.metallicRoughnessTexture,
                                      material.emissionTexture, material.normalTexture})
                promise(texture < static_cast<int>(model.textures.size()), "textures of materials exist");
    });
}

}  // namespace lumulus::test
