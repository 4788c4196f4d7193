#include "mesh/gltf_material.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "mesh/accessor.h"
#include "mesh/gltf_file.h"
#include "mesh/picture.h"

namespace lumulus::mesh {
namespace {

constexpr const char* exportAgain = "export it again";
constexpr double brightest = 1e9;  ///< W/(m² sr)

Wrap wrapOf(int wrap) {
    if (wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
    return wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
}

class Materials {
  public:
    Materials(const std::filesystem::path& file, const tinygltf::Model& gltf, Model& model)
        : file_(file), gltf_(gltf), model_(model) {}

    Material materialOf(const tinygltf::Material& from, std::size_t index) {
        name_ = fmt::format("material {}", index);
        const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
        Material material;
        material.colour = rgb(pbr.baseColorFactor, 1.0);
        material.alpha = pbr.baseColorFactor.size() == 4 ? share(pbr.baseColorFactor[3]) : 1.0F;
        material.metallic = share(pbr.metallicFactor);
        material.roughness = share(pbr.roughnessFactor);
        material.emission = rgb(from.emissiveFactor, brightest) * strength(from);
        if (from.alphaMode == "MASK") material.alphaCutoff = share(from.alphaCutoff);
        if (from.alphaMode == "BLEND") material.alphaCutoff = 0.5F;
        material.colourTexture = texture(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord);
        material.metallicRoughnessTexture =
            texture(pbr.metallicRoughnessTexture.index, pbr.metallicRoughnessTexture.texCoord);
        material.emissionTexture = texture(from.emissiveTexture.index, from.emissiveTexture.texCoord);
        material.normalTexture = texture(from.normalTexture.index, from.normalTexture.texCoord);
        material.normalScale = static_cast<float>(within(from.normalTexture.scale, -100.0, 100.0));
        return material;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { failGltf(file_, name_ + " " + what, exportAgain); }

    double within(double value, double low, double high) const {
        if (!(value >= low && value <= high)) fail(fmt::format("has {}, not from {:g} to {:g}", value, low, high));
        return value;
    }
    float share(double value) const { return static_cast<float>(within(value, 0.0, 1.0)); }

    glm::vec3 rgb(const std::vector<double>& values, double most) const {
        if (values.size() < 3) fail("has a colour without three values");
        return {within(values[0], 0.0, most), within(values[1], 0.0, most), within(values[2], 0.0, most)};
    }

    /// KHR_materials_emissive_strength.
    float strength(const tinygltf::Material& from) const {
        const auto found = from.extensions.find("KHR_materials_emissive_strength");
        if (found == from.extensions.end() || !found->second.Has("emissiveStrength")) return 1.0F;
        const tinygltf::Value& value = found->second.Get("emissiveStrength");
        return value.IsNumber() ? static_cast<float>(within(value.GetNumberAsDouble(), 0.0, brightest)) : 1.0F;
    }

    /// The texture of this number, which is decoded where it is new; −1 for none.
    int texture(int index, int coordinates) {
        if (index < 0) return -1;
        if (coordinates != 0) fail("uses a second set of texture coordinates, which is not read");
        const auto known = known_.find(index);
        if (known != known_.end()) return known->second;
        if (static_cast<std::size_t>(index) >= gltf_.textures.size()) fail(fmt::format("has no texture {}", index));
        const tinygltf::Texture& from = gltf_.textures[static_cast<std::size_t>(index)];
        if (from.source < 0 || static_cast<std::size_t>(from.source) >= gltf_.images.size())
            fail(fmt::format("has no picture for texture {}", index));
        const tinygltf::Image& image = gltf_.images[static_cast<std::size_t>(from.source)];
        Texture texture = decodePicture(file_, fmt::format("image {}", from.source),
                                        image.bufferView < 0 ? std::span<const unsigned char>(image.image)
                                                             : viewOf(file_, gltf_, image.bufferView));
        texels_ += texture.texels.size();
        if (texels_ > mostTexels) fail(fmt::format("has textures of more than {} pixels in all", mostTexels));
        if (from.sampler >= 0 && static_cast<std::size_t>(from.sampler) < gltf_.samplers.size()) {
            texture.wrapU = wrapOf(gltf_.samplers[static_cast<std::size_t>(from.sampler)].wrapS);
            texture.wrapV = wrapOf(gltf_.samplers[static_cast<std::size_t>(from.sampler)].wrapT);
        }
        model_.textures.push_back(std::move(texture));
        return known_[index] = static_cast<int>(model_.textures.size()) - 1;
    }

    const std::filesystem::path& file_;
    const tinygltf::Model& gltf_;
    Model& model_;
    std::string name_;
    std::map<int, int> known_;
    std::size_t texels_ = 0;
};

}  // namespace

void addMaterials(const std::filesystem::path& file, const tinygltf::Model& gltf, Model& model) {
    Materials materials(file, gltf, model);
    for (std::size_t i = 0; i < gltf.materials.size(); ++i)
        model.materials.push_back(materials.materialOf(gltf.materials[i], i));
    model.materials.emplace_back();
}

}  // namespace lumulus::mesh
