#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/load.h"
#include "support/rico.h"
#include "view/camera.h"
#include "volume/load.h"
#include "volume/place_clouds.h"

// Every scene that ships loads, and what is meant for measuring shows enough of its cloud.
namespace lumulus {
namespace {

const std::filesystem::path folder = std::filesystem::path(LUMULUS_SOURCE_DIR) / "configs" / "scenes";

std::vector<std::filesystem::path> shipped() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

/// The scene; where its data does not come with the sources, with the data of the tests, or else with a procedural
/// cloud in its place.
scene::Scene load(const std::filesystem::path& file) {
    if (file.stem() != "disney-cloud") return scene::loadScene(file);
    const std::optional<std::filesystem::path> data = test::findTestData("wdas_cloud_sixteenth.vdb");
    if (!data) std::cout << "no wdas_cloud_sixteenth.vdb: a procedural cloud stands in\n";
    const std::vector<std::string> overrides{data ? "cloud.0.vdb=" + data->string() : "cloud.0.procedural=cumulus"};
    return scene::loadScene(file, overrides);
}

/// Optical thickness of one cloud along the ray, by steps of half a voxel through the nearest voxels.
double opticalThickness(const vdb::PlacedVolume& cloud, double extinction, const Ray& ray) {
    const vdb::Volume& volume = *cloud.volume;
    const glm::dmat3 toVoxel = glm::inverse(cloud.toWorld.linear);
    const glm::dvec3 origin = toVoxel * (ray.origin - cloud.toWorld.translation);
    const glm::dvec3 direction = toVoxel * ray.direction;
    const double step = 0.5 / glm::length(direction);
    const double length = glm::length(origin) + 2.0 * glm::length(glm::dvec3(volume.size));  // voxels, beyond the box
    double sum = 0.0;
    for (double t = 0.0; t * glm::length(direction) < length; t += step) {
        const glm::ivec3 voxel = glm::ivec3(glm::floor(origin + t * direction));
        if (glm::any(glm::lessThan(voxel, glm::ivec3(0)))) continue;
        if (glm::any(glm::greaterThanEqual(voxel, volume.size))) continue;
        sum += static_cast<double>(volume.density[volume.index(voxel.x, voxel.y, voxel.z)]) * step;
    }
    return extinction * sum;
}

/// The share of a coarse picture where the transmittance is below .999.
double cloudShare(scene::Scene scene) {
    for (scene::Cloud& cloud : scene.clouds) cloud.resolution = 64;
    scene.image.height = 24 * scene.image.height / scene.image.width;
    scene.image.width = 24;
    const CloudVolumes loaded = loadClouds(scene);
    const std::vector<vdb::PlacedVolume> clouds = loaded.placed();
    const Camera camera = makeCamera(scene.camera, scene.image, boundsOf(clouds));
    int seen = 0;
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
            double thickness = 0.0;
            for (std::size_t i = 0; i < clouds.size(); ++i) {
                const double extinction = scene.clouds[i].extinction * scene.clouds[i].densityScale;
                thickness += opticalThickness(clouds[i], extinction, camera.ray(x + 0.5, y + 0.5));
            }
            if (thickness > 1e-3) ++seen;
        }
    }
    return static_cast<double>(seen) / (camera.width * camera.height);
}

TEST(ShippedScenes, AreTheOnesThatTheDocumentsName) {
    std::set<std::string> names;
    for (const auto& file : shipped()) names.insert(file.stem().string());
    for (const char* name :
         {"cumulus", "cumulus-side-lit", "cumulus-back-lit", "cumulus-front-lit", "cumulus-low-sun", "disney-cloud",
          "cirrus", "stratus", "furnace", "smoke", "two-clouds", "sky-noon", "sky-sunset"}) {
        EXPECT_TRUE(names.contains(name)) << name;
    }
}

TEST(ShippedScenes, AllLoad) {
    for (const auto& file : shipped()) {
        const scene::Scene scene = load(file);
        if (!scene.lamps.empty() || !scene.meshes.empty()) continue;  // with clouds of any kind, or none
        const std::size_t single = file.stem() == "two-clouds" ? 2 : 1;
        EXPECT_EQ(scene.clouds.size(), scene.fields.empty() ? single : 0) << file;
        EXPECT_EQ(scene.fields.empty(), !file.stem().string().starts_with("field-")) << file;
    }
}

TEST(ShippedScenes, FieldsAreOfManyClouds) {
    for (const auto& file : shipped()) {
        scene::Scene scene = load(file);
        if (scene.fields.empty()) continue;
        scene.fields[0].resolution = 32;
        const std::size_t clouds = placeClouds(scene).clouds.size();
        EXPECT_GE(clouds, 10U) << file;
        EXPECT_LE(clouds, 256U) << file;
    }
}

TEST(ShippedScenes, ShowTheCloudInThreeTenthsOfThePicture) {
    for (const auto& file : shipped()) {
        const scene::Scene scene = load(file);
        if (!scene.fields.empty() || !scene.lamps.empty()) continue;
        // those of the sky show that too
        EXPECT_GE(cloudShare(scene), file.stem().string().starts_with("sky-") ? 0.08 : 0.3) << file;
    }
}

TEST(ShippedScenes, SmokeIsDarkAndTheFurnaceWhite) {
    EXPECT_EQ(scene::loadScene(folder / "smoke.toml").clouds[0].albedo, glm::dvec3(0.9));
    EXPECT_EQ(scene::loadScene(folder / "furnace.toml").clouds[0].albedo, glm::dvec3(1.0));
    EXPECT_EQ(scene::loadScene(folder / "furnace.toml").sun.irradiance, glm::dvec3(0.0));
}

}  // namespace
}  // namespace lumulus
