// Densities in bricks show the pictures of dense ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/renderer.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

using glm::dvec3;
using test::Frame;

class SparseDensity : public testing::TestWithParam<scene::DrawMode> {
  protected:
    scene::Scene scene = test::smallScene();

    void SetUp() override {
        scene.clouds[0].procedural = "cumulus";
        scene.clouds[0].resolution = 56;
        scene.clouds[0].extinction = 0.02;
        scene.photonMap.photons = 60000;
        scene.draw.mode = GetParam();
        scene.draw.tolerance = 0.0;
        scene.image = {64, 36, 0.0};
        scene.camera.position = dvec3(200.0, 250.0, 1800.0);
        scene.camera.target = dvec3(0.0, 300.0, 0.0);
    }
    Frame with(scene::DensityStorage storage) {
        scene.preparation.storage = storage;
        return test::render(scene);
    }
};
INSTANTIATE_TEST_SUITE_P(Modes, SparseDensity, testing::Values(scene::DrawMode::march, scene::DrawMode::billboards),
                         [](const auto& mode) {
                             return mode.param == scene::DrawMode::march ? "march" : "billboards";
                         });

struct Difference {
    double bias = 0.0;  ///< of the sums, of that of the first
    double rms = 0.0;   ///< of the mean of the first
};

Difference difference(const Frame& a, const Frame& b, const char* layer) {
    const auto &left = a.image.layers.at(layer), &right = b.image.layers.at(layer);
    double first = 0.0, second = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i) {
        const auto x = static_cast<double>(left[i]), y = static_cast<double>(right[i]);
        first += x;
        second += y;
        squares += (x - y) * (x - y);
    }
    const double count = static_cast<double>(left.size());
    return {second / first - 1.0, std::sqrt(squares / count) / (first / count)};
}

/// Gradient samples lie elsewhere, and so do the leaves of the kD-tree: photons have other noise, and billboards, which
/// stand for leaves, another shape. A march sees the same density.
void expectSame(const Frame& dense, const Frame& sparse) {
    const bool march = SparseDensity::GetParam() == scene::DrawMode::march;
    const Difference through = difference(dense, sparse, "transmittance.G");
    EXPECT_LT(std::abs(through.bias), march ? 1e-5 : 0.02);
    EXPECT_LT(through.rms, march ? 1e-5 : 0.15);
    const Difference seen = difference(dense, sparse, "G");
    EXPECT_LT(std::abs(seen.bias), 0.01);
    EXPECT_LT(seen.rms, march ? 0.15 : 0.2);
    std::printf("transmittance: bias %.1e, rms %.1e; radiance: bias %.1e, rms %.1e\n", through.bias, through.rms,
                seen.bias, seen.rms);
}

TEST_P(SparseDensity, OneCloudIsThatOfTheDenseVolume) {
    const Frame dense = with(scene::DensityStorage::dense), sparse = with(scene::DensityStorage::sparse);
    expectSame(dense, sparse);
}

TEST_P(SparseDensity, SeveralCloudsShareOnePool) {
    scene.clouds.push_back(scene.clouds[0]);
    scene.clouds[1].seed = 7;
    scene.clouds[1].transform[3] = glm::dvec4(300.0, 100.0, -200.0, 1.0);
    scene.clouds.push_back(scene.clouds[0]);
    scene.clouds[2].transform[3] = glm::dvec4(-900.0, 0.0, 300.0, 1.0);
    const Frame dense = with(scene::DensityStorage::dense), sparse = with(scene::DensityStorage::sparse);
    expectSame(dense, sparse);
}

}  // namespace
}  // namespace lumulus
