#include "mesh/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <utility>

#include "base/error.h"
#include "mesh/accessor.h"
#include "mesh/gltf_file.h"
#include "mesh/gltf_material.h"

namespace lumulus::mesh {
namespace {

constexpr const char* exportAgain = "export it again";
constexpr int deepestNode = 256;
constexpr float farthest = 1e7F;  ///< of a vertex from the file's origin, metres

glm::dmat4 transformOf(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
    glm::dmat4 result(1.0);
    if (node.translation.size() == 3) result[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1.0);
    if (node.rotation.size() == 4)
        result *= glm::mat4_cast(glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]));
    if (node.scale.size() == 3)
        for (int axis = 0; axis < 3; ++axis) result[axis] *= node.scale[static_cast<std::size_t>(axis)];
    return result;
}

/// The corners of the triangles of a primitive, three by three.
std::vector<std::uint32_t> cornersOf(const std::vector<std::uint32_t>& indices, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return {indices.begin(), indices.end() - std::ptrdiff_t(indices.size() % 3)};
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 2; i < indices.size(); ++i) {
        const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN, odd = i % 2 != 0;
        corners.push_back(fan ? indices[0] : indices[odd ? i - 1 : i - 2]);
        corners.push_back(fan ? indices[i - 1] : indices[odd ? i - 2 : i - 1]);
        corners.push_back(indices[i]);
    }
    return corners;
}

/// Makes one model of the nodes of a file.
class Loader {
  public:
    explicit Loader(const std::filesystem::path& file) : file_(file), gltf_(readGltf(file)) {}

    Model load() {
        for (const std::string& name : gltf_.extensionsRequired)
            fail(fmt::format("it needs the extension {}, which is not read", name), "export it without");
        addMaterials(file_, gltf_, model_);
        visited_.resize(gltf_.nodes.size());
        for (const int root : roots()) addNode(root, glm::dmat4(1.0), 0);
        if (model_.triangles.empty()) fail("it has no triangle", "give a file with a mesh of triangles");
        return std::move(model_);
    }

  private:
    [[noreturn]] void fail(const std::string& what, const std::string& mend = exportAgain) const {
        failGltf(file_, what, mend);
    }

    std::vector<int> roots() const {
        const int scene = gltf_.defaultScene < 0 ? 0 : gltf_.defaultScene;
        if (static_cast<std::size_t>(scene) < gltf_.scenes.size())
            return gltf_.scenes[static_cast<std::size_t>(scene)].nodes;
        if (!gltf_.scenes.empty()) fail(fmt::format("there is no scene {}", scene));
        std::vector<bool> isChild(gltf_.nodes.size());
        for (const tinygltf::Node& node : gltf_.nodes)
            for (const int child : node.children)
                if (child >= 0 && static_cast<std::size_t>(child) < isChild.size())
                    isChild[static_cast<std::size_t>(child)] = true;
        std::vector<int> all;
        for (std::size_t i = 0; i < isChild.size(); ++i)
            if (!isChild[i]) all.push_back(static_cast<int>(i));
        return all;
    }

    void addNode(int index, const glm::dmat4& parent, int depth) {
        if (index < 0 || static_cast<std::size_t>(index) >= gltf_.nodes.size())
            fail(fmt::format("there is no node {}", index));
        if (visited_[static_cast<std::size_t>(index)])
            fail(fmt::format("node {} is below itself, or below two nodes", index), "give each node one parent");
        visited_[static_cast<std::size_t>(index)] = true;
        if (depth > deepestNode) fail("its nodes are nested more than 256 deep");
        const tinygltf::Node& node = gltf_.nodes[static_cast<std::size_t>(index)];
        const glm::dmat4 transform = parent * transformOf(node);
        for (int i = 0; i < 16; ++i)
            if (!std::isfinite(transform[i / 4][i % 4])) fail(fmt::format("node {} has no finite transform", index));
        if (node.mesh >= 0) {
            if (static_cast<std::size_t>(node.mesh) >= gltf_.meshes.size())
                fail(fmt::format("node {}: there is no mesh {}", index, node.mesh));
            for (const tinygltf::Primitive& primitive : gltf_.meshes[static_cast<std::size_t>(node.mesh)].primitives)
                addPrimitive(primitive, transform, fmt::format("mesh {}", node.mesh));
        }
        for (const int child : node.children) addNode(child, transform, depth + 1);
    }

    void addPrimitive(const tinygltf::Primitive& primitive, const glm::dmat4& transform, const std::string& where) {
        const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
            mode != TINYGLTF_MODE_TRIANGLE_FAN)
            return;  // points and lines
        const auto positions = primitive.attributes.find("POSITION");
        if (positions == primitive.attributes.end()) return;
        if (primitive.material >= 0 && static_cast<std::size_t>(primitive.material) >= gltf_.materials.size())
            fail(fmt::format("{}: there is no material {}", where, primitive.material));
        const std::vector<Vertex> vertices = verticesOf(primitive, positions->second, transform, where);
        const std::vector<std::uint32_t> corners = cornersOf(indicesOf(primitive, vertices.size(), where), mode);
        if (corners.size() / 3 > mostTriangles - model_.triangles.size())
            fail(fmt::format("it has more than {} triangles", mostTriangles), "give a simpler mesh");
        const auto material = static_cast<std::uint32_t>(primitive.material < 0 ? gltf_.materials.size()
                                                                                : std::size_t(primitive.material));
        const bool flat = !primitive.attributes.contains("NORMAL");
        flat ? addFlat(vertices, corners, material) : addSmooth(vertices, corners, material);
    }

    std::vector<std::uint32_t> indicesOf(const tinygltf::Primitive& primitive, std::size_t vertices,
                                         const std::string& where) const {
        std::vector<std::uint32_t> indices;
        if (primitive.indices < 0) {
            indices.resize(vertices);
            for (std::size_t i = 0; i < vertices; ++i) indices[i] = static_cast<std::uint32_t>(i);
            return indices;
        }
        const Accessor accessor(file_, gltf_, primitive.indices, 1);
        if (!accessor.isIndex()) fail(fmt::format("{} has indices that are no unsigned integers", where));
        if (accessor.count() > 3 * mostTriangles + 2)
            fail(fmt::format("it has more than {} triangles", mostTriangles), "give a simpler mesh");
        indices.resize(accessor.count());
        for (std::size_t i = 0; i < indices.size(); ++i) {
            indices[i] = accessor.index(i);
            if (indices[i] >= vertices)
                fail(fmt::format("{} has index {}, but {} vertices", where, indices[i], vertices));
        }
        return indices;
    }

    std::optional<Accessor> attribute(const tinygltf::Primitive& primitive, const char* name, int components,
                                      std::size_t count, const std::string& where) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return std::nullopt;
        Accessor accessor(file_, gltf_, found->second, components);
        if (accessor.count() != count) fail(fmt::format("{} has another number of {} than of POSITION", where, name));
        return accessor;
    }

    std::vector<Vertex> verticesOf(const tinygltf::Primitive& primitive, int positions, const glm::dmat4& transform,
                                   const std::string& where) const {
        const Accessor position(file_, gltf_, positions, 3);
        if (!position.isFloat()) fail(fmt::format("{} has positions that are no floats", where));
        if (position.count() > 3 * mostTriangles)
            fail(fmt::format("it has more than {} triangles", mostTriangles), "give a simpler mesh");
        const std::optional<Accessor> normal = attribute(primitive, "NORMAL", 3, position.count(), where),
                                      uv = attribute(primitive, "TEXCOORD_0", 2, position.count(), where);
        const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(transform)));
        std::vector<Vertex> vertices(position.count());
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const auto vector = [i](const Accessor& from) {
                return glm::dvec3(from.number(i, 0), from.number(i, 1), from.number(i, 2));
            };
            Vertex& vertex = vertices[i];
            vertex.position = glm::vec3(transform * glm::dvec4(vector(position), 1.0));
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(vertex.position[axis]) <= farthest))
                    fail(fmt::format("{} has a vertex that is not finite or farther than 1e7 m", where));
            if (uv) vertex.uv = {uv->number(i, 0), uv->number(i, 1)};
            if (!std::isfinite(vertex.uv.x) || !std::isfinite(vertex.uv.y)) vertex.uv = glm::vec2(0.0F);
            if (!normal) continue;
            const glm::dvec3 turned = turn * vector(*normal);
            const double length = glm::length(turned);
            if (std::isfinite(length) && length > 0.0) vertex.normal = glm::vec3(turned / length);
        }
        return vertices;
    }

    static glm::vec3 faceNormal(const Vertex& a, const Vertex& b, const Vertex& c) {
        const glm::dvec3 cross = glm::cross(glm::dvec3(b.position) - glm::dvec3(a.position),
                                            glm::dvec3(c.position) - glm::dvec3(a.position));
        const double length = glm::length(cross);
        return length > 0.0 ? glm::vec3(cross / length) : glm::vec3(0.0F, 1.0F, 0.0F);
    }

    void addFlat(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& corners,
                 std::uint32_t material) {
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const auto first = static_cast<std::uint32_t>(model_.vertices.size());
            const glm::vec3 normal =
                faceNormal(vertices[corners[i]], vertices[corners[i + 1]], vertices[corners[i + 2]]);
            for (std::size_t corner = 0; corner < 3; ++corner) {
                model_.vertices.push_back(vertices[corners[i + corner]]);
                model_.vertices.back().normal = normal;
            }
            model_.triangles.push_back({{first, first + 1, first + 2}, material});
        }
    }

    void addSmooth(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& corners,
                   std::uint32_t material) {
        const auto first = static_cast<std::uint32_t>(model_.vertices.size());
        model_.vertices.insert(model_.vertices.end(), vertices.begin(), vertices.end());
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const glm::uvec3 of(corners[i], corners[i + 1], corners[i + 2]);
            for (int corner = 0; corner < 3; ++corner) {
                Vertex& vertex = model_.vertices[first + of[corner]];
                if (vertex.normal == glm::vec3(0.0F))
                    vertex.normal = faceNormal(vertices[of.x], vertices[of.y], vertices[of.z]);
            }
            model_.triangles.push_back({of + first, material});
        }
    }

    const std::filesystem::path& file_;
    tinygltf::Model gltf_;
    Model model_;
    std::vector<bool> visited_;
};

}  // namespace

Model loadGltf(const std::filesystem::path& file) {
    return Loader(file).load();
}

}  // namespace lumulus::mesh
