#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace lumulus::test {

/// A .glb file in the making: accessors put their values into its buffer.
class GltfFile {
  public:
    nlohmann::json json = {
        {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};

    /// Adds an accessor of these values; its number.
    template <class Value>
    int add(const std::vector<Value>& values, int componentType, const char* type, std::size_t count) {
        const std::size_t offset = data_.size(), bytes = values.size() * sizeof(Value);
        data_.resize(offset + (bytes + 3) / 4 * 4);
        std::memcpy(data_.data() + offset, values.data(), bytes);
        json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
        json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", componentType},
                                     {"type", type},
                                     {"count", count}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }
    int addFloats(const std::vector<float>& values, const char* type, std::size_t each) {
        return add(values, 5126, type, values.size() / each);
    }

    std::string bytes() const {
        nlohmann::json whole = json;
        whole["buffers"] = {{{"byteLength", data_.size()}}};
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string file = "glTF" + word(2) + word(28 + text.size() + data_.size());
        file += word(text.size()) + "JSON" + text + word(data_.size()) + std::string("BIN\0", 4) + data_;
        return file;
    }

    /// A square of 2 m about the origin that faces +Z, as two triangles.
    static GltfFile square() {
        GltfFile file;
        const int positions = file.addFloats({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3", 3);
        const int uv = file.addFloats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
        const int indices = file.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 6);
        file.json["meshes"] = {
            {{"primitives", {{{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv}}}, {"indices", indices}}}}}};
        return file;
    }

  private:
    static std::string word(std::size_t value) {
        const auto bits = static_cast<std::uint32_t>(value);
        return {reinterpret_cast<const char*>(&bits), sizeof(bits)};
    }
    std::string data_;
};

}  // namespace lumulus::test
