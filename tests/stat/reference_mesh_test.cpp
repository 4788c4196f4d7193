// Meshes of the reference: their materials in a white furnace, their hits against the renderer's own tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

#include "mesh/bvh/world.h"
#include "reference/tracer.h"
#include "support/gltf_file.h"
#include "support/statistics.h"

namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::GltfFile;
using test::RunningMean;

scene::Scene meshScene(const std::filesystem::path& gltf) {
    scene::Scene scene;
    scene.clouds.clear();
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(1.0);
    scene.meshes.push_back({"", gltf, dvec3(0.0), 0.0, 1.0, {}});
    return scene;
}

/// A square that faces +Z.
GltfFile square(double metallic, double roughness, double colour) {
    GltfFile file = GltfFile::square();
    file.json["materials"] = {{{"pbrMetallicRoughness",
                                {{"baseColorFactor", {colour, colour, colour, 1.0}},
                                 {"metallicFactor", metallic},
                                 {"roughnessFactor", roughness}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    return file;
}

RunningMean radianceOf(const PathTracer& tracer, const Ray& ray, int samples) {
    Random random(5, 0, 0);
    RunningMean mean;
    for (int i = 0; i < samples; ++i) {
        const PathSample sample = tracer.trace(ray, random);
        mean.add(sample.radiance.y + sample.passed.y * tracer.environment().unit().y);
    }
    return mean;
}

TEST(ReferenceMesh, WhiteMaterialsInAWhiteFurnaceCannotBeSeen) {
    const test::TemporaryFolder folder;
    for (const double metallic : {0.0, 1.0}) {
        for (const double roughness : {0.1, 0.5, 1.0}) {
            test::writeAll(folder / "square.glb", square(metallic, roughness, 1.0).bytes());
            const PathTracer tracer(meshScene(folder / "square.glb"), {}, Majorant::local);
            for (const double tilt : {0.0, 60.0, 80.0}) {
                const dvec3 direction(std::sin(glm::radians(tilt)), 0.0, -std::cos(glm::radians(tilt)));
                const RunningMean mean = radianceOf(tracer, {-4.0 * direction, direction}, 20'000);
                EXPECT_NEAR(mean.mean(), 1.0, 0.01 + 4.0 * mean.standardError())
                    << "metallic " << metallic << ", roughness " << roughness << ", " << tilt << " degrees";
            }
        }
    }
}

/// A matte surface sends albedo/π · E · cos, of which the facets above it take their share; a black one with facets of
/// 4 % at normal incidence leaves 1 − 0.04 to the base where it is smooth.
TEST(ReferenceMesh, APlasticSquareInTheSun) {
    const test::TemporaryFolder folder;
    test::writeAll(folder / "square.glb", square(0.0, 0.1, 0.5).bytes());
    scene::Scene scene = meshScene(folder / "square.glb");
    scene.sky.radiance = dvec3(0.0);
    scene.sun.irradiance = dvec3(2.0);
    scene.sun.angularDiameter = 0.0;
    scene.sun.directionTo = glm::normalize(dvec3(1.0, 0.0, 1.0));  // far from the mirror direction
    const PathTracer tracer(scene, {}, Majorant::local);
    const RunningMean mean = radianceOf(tracer, {{0.2, 0.1, 5.0}, {0.0, 0.0, -1.0}}, 20'000);
    const double expected = 0.5 / glm::pi<double>() * 2.0 * std::sqrt(0.5) * 0.96;
    EXPECT_NEAR(mean.mean(), expected, 0.005 * expected + 4.0 * mean.standardError());
    EXPECT_EQ(radianceOf(tracer, {{0.2, 0.1, -5.0}, {0.0, 0.0, 1.0}}, 100).mean(), 0.0) << "the side in shadow";
}

TEST(ReferenceMesh, LightOfItsOwnAndHolesOfAMask) {
    const test::TemporaryFolder folder;
    GltfFile file = square(0.0, 1.0, 0.0);
    file.json["materials"][0]["emissiveFactor"] = {0.25, 0.5, 1.0};
    test::writeAll(folder / "square.glb", file.bytes());
    scene::Scene scene = meshScene(folder / "square.glb");
    scene.sky.radiance = dvec3(0.0);
    const Ray ray{{0.2, 0.1, 5.0}, {0.0, 0.0, -1.0}};
    EXPECT_NEAR(radianceOf(PathTracer(scene, {}, Majorant::local), ray, 10).mean(), 0.5, 1e-12);
    file.json["materials"][0]["alphaMode"] = "MASK";
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.25;
    test::writeAll(folder / "square.glb", file.bytes());
    EXPECT_EQ(radianceOf(PathTracer(scene, {}, Majorant::local), ray, 10).mean(), 0.0);
}

/// Triangles of many sizes in 30 places: Embree and the tree of the renderer meet the same, but for rays that graze an
/// edge, where both round in their own way.
TEST(ReferenceMesh, HitsAreThoseOfTheRenderer) {
    const test::TemporaryFolder folder;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-1.0F, 1.0F), share(0.0F, 1.0F);
    std::vector<float> positions;
    for (int i = 0; i < 1500; ++i) {
        const glm::vec3 middle(place(random), place(random), place(random));
        const float size = 0.4F * std::pow(share(random), 3.0F);
        for (int corner = 0; corner < 3; ++corner)
            for (int axis = 0; axis < 3; ++axis) positions.push_back(middle[axis] + size * place(random));
    }
    GltfFile file = GltfFile::square();
    file.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", file.addFloats(positions, "VEC3", 3)}}}}}}}};
    test::writeAll(folder / "scattered.glb", file.bytes());
    std::string rows = "x,y,z,yaw,scale\n";
    for (int i = 0; i < 30; ++i)
        rows += std::to_string(2000.0F + 6.0F * place(random)) + "," + std::to_string(6.0F * place(random)) + "," +
                std::to_string(6.0F * place(random)) + "," + std::to_string(180.0F * place(random)) + "," +
                std::to_string(0.2F + share(random)) + "\n";
    test::writeAll(folder / "places.csv", rows);
    scene::Scene scene = meshScene(folder / "scattered.glb");
    scene.meshes[0].instances = folder / "places.csv";
    const Meshes meshes(scene);
    const bvh::World world = bvh::buildWorld(*meshes.placed(), [] {});
    int met = 0, different = 0;
    constexpr int rays = 20'000;
    for (int i = 0; i < rays; ++i) {
        const dvec3 from(2000.0F + 8.0F * place(random), 8.0F * place(random), 8.0F * place(random));
        const dvec3 direction = glm::normalize(dvec3(place(random), place(random), place(random)));
        const auto found = meshes.nearest({from, direction}, 1e9, nullptr);
        const shared::MeshHit own =
            bvh::nearest(world, {glm::vec3(from - world.middle), 0.0F, glm::vec3(direction), 1e9F, -1, -1});
        const bool same = found ? own.instance >= 0 && std::abs(found->metres - static_cast<double>(own.distance)) <
                                                           1e-4 * (1.0 + found->metres)
                                : own.instance < 0;
        met += found ? 1 : 0;
        different += same ? 0 : 1;
    }
    EXPECT_GT(met, rays / 10);
    EXPECT_LE(different, 2) << "of " << met << " hits";
}

}  // namespace
}  // namespace lumulus::reference
