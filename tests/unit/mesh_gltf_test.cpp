// Reading of glTF files: what a file holds, and what is wrong with bad ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "base/png.h"
#include "mesh/gltf.h"
#include "mesh/placed.h"
#include "support/gltf_file.h"

namespace lumulus::test {
namespace {

using testing::HasSubstr;

mesh::Model load(const std::string& bytes, const char* name = "mesh.glb") {
    const TemporaryFolder folder;
    writeAll(folder / name, bytes);
    return mesh::loadGltf(folder / name);
}

TEST(Gltf, ASquareHasItsTriangles) {
    const mesh::Model model = load(GltfFile::square().bytes());
    ASSERT_EQ(model.triangles.size(), 2U);
    ASSERT_EQ(model.vertices.size(), 6U) << "without normals each triangle has corners of its own";
    for (const mesh::Vertex& vertex : model.vertices) EXPECT_EQ(vertex.normal, glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(model.vertices[1].position, glm::vec3(1.0F, -1.0F, 0.0F));
    EXPECT_EQ(model.vertices[1].uv, glm::vec2(1.0F, 1.0F));
    ASSERT_EQ(model.materials.size(), 1U) << "that of triangles without a material";
    EXPECT_EQ(model.triangles[0].material, 0U);
}

TEST(Gltf, NodesMoveWhatIsBelowThem) {
    GltfFile file = GltfFile::square();
    // a quarter turn about y, then ten metres along x; below it twice the size
    file.json["nodes"] = {
        {{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0.70710678, 0, 0.70710678}}},
        {{"mesh", 0}, {"scale", {2, 2, 2}}}};
    const mesh::Model model = load(file.bytes());
    const glm::vec3 corner = model.vertices[1].position;  // of (1, −1, 0)
    EXPECT_NEAR(corner.x, 10.0F, 1e-5F);
    EXPECT_NEAR(corner.y, -2.0F, 1e-5F);
    EXPECT_NEAR(corner.z, -2.0F, 1e-5F);
    EXPECT_NEAR(model.vertices[1].normal.x, 1.0F, 1e-6F);
}

TEST(Gltf, IndicesOfAllTypesAndStripsAndFans) {
    for (const int mode : {4, 5, 6}) {
        for (const int type : {5121, 5123, 5125}) {
            GltfFile file = GltfFile::square();
            const std::vector<std::uint32_t> indices = mode == 4   ? std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}
                                                       : mode == 5 ? std::vector<std::uint32_t>{0, 1, 3, 2}
                                                                   : std::vector<std::uint32_t>{0, 1, 2, 3};
            int accessor = 0;
            if (type == 5121)
                accessor =
                    file.add(std::vector<std::uint8_t>(indices.begin(), indices.end()), type, "SCALAR", indices.size());
            else if (type == 5123)
                accessor = file.add(std::vector<std::uint16_t>(indices.begin(), indices.end()), type, "SCALAR",
                                    indices.size());
            else
                accessor = file.add(indices, type, "SCALAR", indices.size());
            file.json["meshes"][0]["primitives"][0]["indices"] = accessor;
            file.json["meshes"][0]["primitives"][0]["mode"] = mode;
            const mesh::Model model = load(file.bytes());
            ASSERT_EQ(model.triangles.size(), 2U) << mode << ' ' << type;
            for (const mesh::Vertex& vertex : model.vertices)
                EXPECT_EQ(vertex.normal.z, 1.0F) << "the same side, mode " << mode;
        }
    }
}

TEST(Gltf, MaterialsAndPictures) {
    const std::vector<std::byte> png = encodePng(2, 1, std::vector<std::uint8_t>{255, 0, 0, 0, 0, 255});
    GltfFile file = GltfFile::square();
    file.add(std::vector<std::byte>(png), 5121, "SCALAR", png.size());
    file.json["images"] = {{{"bufferView", file.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}}};
    file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.json["materials"] = {{{"alphaMode", "MASK"},
                               {"alphaCutoff", 0.25},
                               {"emissiveFactor", {0.5, 0.25, 0}},
                               {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}},
                               {"pbrMetallicRoughness",
                                {{"baseColorFactor", {0.5, 0.6, 0.7, 0.8}},
                                 {"baseColorTexture", {{"index", 0}}},
                                 {"metallicFactor", 0.1},
                                 {"roughnessFactor", 0.2}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    const mesh::Model model = load(file.bytes());
    ASSERT_EQ(model.textures.size(), 1U);
    const mesh::Texture& texture = model.textures[0];
    EXPECT_EQ(texture.width, 2);
    EXPECT_EQ(texture.height, 1);
    EXPECT_EQ(texture.texels[1], (std::array<std::uint8_t, 4>{0, 0, 255, 255}));
    EXPECT_EQ(texture.wrapU, mesh::Wrap::clamp);
    EXPECT_EQ(texture.wrapV, mesh::Wrap::mirror);
    const mesh::Material& material = model.materials[0];
    EXPECT_EQ(material.colour, glm::vec3(0.5F, 0.6F, 0.7F));
    EXPECT_EQ(material.alphaCutoff, 0.25F);
    EXPECT_EQ(material.emission, glm::vec3(4.0F, 2.0F, 0.0F));
    EXPECT_EQ(material.metallic, 0.1F);
    EXPECT_EQ(material.roughness, 0.2F);
    EXPECT_EQ(material.colourTexture, 0);
    EXPECT_EQ(material.normalTexture, -1);
}

struct BadFile {
    const char* name;
    std::function<void(GltfFile&)> spoil;
    const char* message;
};

std::ostream& operator<<(std::ostream& out, const BadFile& bad) {
    return out << bad.name;
}

class BadGltf : public testing::TestWithParam<BadFile> {};

TEST_P(BadGltf, IsRefusedInOneLineThatNamesTheFile) {
    GltfFile file = GltfFile::square();
    GetParam().spoil(file);
    try {
        load(file.bytes());
        FAIL() << "was read";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
        EXPECT_THAT(error.what(), HasSubstr("mesh.glb"));
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
}

const BadFile badFiles[] = {
    {"Cycle",
     [](GltfFile& f) {
         f.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
     },
     "node 0 is below itself"},
    {"TwoParents",
     [](GltfFile& f) {
         f.json["nodes"] = {{{"children", {1, 2}}}, {{"children", {3}}}, {{"children", {3}}}, {{"mesh", 0}}};
     },
     "node 3 is below itself, or below two nodes"},
    {"NoNode", [](GltfFile& f) { f.json["scenes"][0]["nodes"] = {7}; }, "there is no node 7"},
    {"NoMesh", [](GltfFile& f) { f.json["nodes"][0]["mesh"] = 5; }, "there is no mesh 5"},
    {"NoTriangle", [](GltfFile& f) { f.json["meshes"][0]["primitives"][0]["mode"] = 0; }, "it has no triangle"},
    {"AccessorBeyond", [](GltfFile& f) { f.json["accessors"][0]["count"] = 5; }, "accessor 0 has 5 elements"},
    {"HugeCount", [](GltfFile& f) { f.json["accessors"][0]["count"] = 4000000000000LL; }, "accessor 0"},
    {"ViewBeyond", [](GltfFile& f) { f.json["bufferViews"][0]["byteLength"] = 1000000; }, "buffer view 0"},
    {"OffsetBeyond", [](GltfFile& f) { f.json["accessors"][0]["byteOffset"] = 48; }, "accessor 0"},
    {"NoAccessor", [](GltfFile& f) { f.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9; }, "accessor"},
    {"IndexBeyond",
     [](GltfFile& f) {
         f.json["meshes"][0]["primitives"][0]["indices"] =
             f.add(std::vector<std::uint16_t>{0, 1, 4}, 5123, "SCALAR", 3);
     },
     "has index 4, but 4 vertices"},
    {"NanVertex",
     [](GltfFile& f) {
         f.json["meshes"][0]["primitives"][0]["attributes"] = {
             {"POSITION", f.addFloats({0, 0, NAN, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3)}};
     },
     "not finite"},
    {"FarVertex",
     [](GltfFile& f) {
         f.json["nodes"][0]["translation"] = {1e9, 0, 0};
     },
     "farther than 1e7 m"},
    {"HugeTransform",
     [](GltfFile& f) {
         f.json["nodes"] = {{{"children", {1}}, {"scale", {1e300, 1, 1}}}, {{"mesh", 0}, {"scale", {1e300, 1, 1}}}};
     },
     "no finite transform"},
    {"Sparse",
     [](GltfFile& f) {
         f.json["accessors"][0]["sparse"] = {
             {"count", 1}, {"indices", {{"bufferView", 2}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}};
     },
     "sparse"},
    {"NoMaterial", [](GltfFile& f) { f.json["meshes"][0]["primitives"][0]["material"] = 3; }, "no material 3"},
    {"Extension", [](GltfFile& f) { f.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
     "KHR_draco_mesh_compression"},
    {"NoPicture",
     [](GltfFile& f) {
         f.json["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
         f.json["textures"] = {{{"source", 0}}};
         f.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
     },
     "image 0 is no PNG or JPEG"},
    {"EmptyPicture",
     [](GltfFile& f) {
         // a PNG of 0 × 0 pixels
         const std::vector<std::uint8_t> png{0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0, 13, 'I', 'H', 'D', 'R', 0,
                                             0,    0,   0,   0,   0,  0,  0,  8,  2, 0, 0, 0,  0,   0,   0,   0};
         f.add(png, 5121, "SCALAR", png.size());
         f.json["images"] = {{{"bufferView", f.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}}};
         f.json["textures"] = {{{"source", 0}}};
         f.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
     },
     "image 0 cannot be read as PNG"},
    {"OutsideFolder",
     [](GltfFile& f) {
         f.json["images"] = {{{"uri", "../secret.png"}}};
     },
     "lies outside of its folder"},
};

INSTANTIATE_TEST_SUITE_P(All, BadGltf, testing::ValuesIn(badFiles),
                         [](const testing::TestParamInfo<BadFile>& of) { return of.param.name; });

TEST(Gltf, WhatIsNoGltfIsRefused) {
    const std::string square = GltfFile::square().bytes();
    EXPECT_THROW(load(""), InputError);
    EXPECT_THROW(load("glTF"), InputError);
    EXPECT_THROW(load(square.substr(0, square.size() / 2)), InputError);
    EXPECT_THROW(load(std::string(100000, '['), "mesh.gltf"), InputError) << "deep nesting must not end the program";
    EXPECT_THROW(mesh::loadGltf("/nowhere/mesh.glb"), InputError);
}

TEST(Gltf, InstancesShareAModelAndAreCounted) {
    const TemporaryFolder folder;
    writeAll(folder / "mesh.glb", GltfFile::square().bytes());
    writeAll(folder / "places.csv", "x,y,z,yaw,scale\n0,0,0,0,1\n5,0,0,90,2\n");
    scene::Scene scene;
    scene.meshes.push_back({"", folder / "mesh.glb", {0, 0, 1}, 0.0, 1.0, folder / "places.csv"});
    scene.meshes.push_back({"", folder / "mesh.glb", {0, 9, 0}, 0.0, 3.0, {}});
    const mesh::Placed placed = mesh::loadMeshes(scene);
    EXPECT_EQ(placed.models.size(), 1U);
    ASSERT_EQ(placed.instances.size(), 3U);
    // the mesh lies 1 m south of its row's place; a quarter turn clockwise seen from above takes south to west
    const glm::dvec3 second(placed.instances[1].toWorld[3]);
    EXPECT_NEAR(second.x, 3.0, 1e-12);
    EXPECT_NEAR(second.z, 0.0, 1e-12);
    std::string rows = "x,y,z\n";
    for (int i = 0; i < 65536; ++i) rows += "1,2,3\n";
    writeAll(folder / "places.csv", rows);
    EXPECT_THROW(mesh::loadMeshes(scene), InputError);
}

}  // namespace
}  // namespace lumulus::test
