// Densities that one renderer gives another one, on a device of its own, as the service does where one of them changes.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "render/renderer.h"
#include "render/shown_densities.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

RendererOptions withRing() {
    RendererOptions options;
    options.keepRing = true;
    return options;
}

/// Three clouds of two fields.
scene::Scene threeClouds() {
    scene::Scene scene = test::smallScene();
    scene.image = {64, 24, 0.0};
    scene.camera.position = glm::dvec3(0.0, 100.0, 1200.0);
    scene.camera.target = glm::dvec3(0.0, 100.0, 0.0);
    scene.camera.verticalFov = 20.0;
    scene.photonMap.photons = 20000;
    scene.clouds.resize(3, scene.clouds[0]);
    for (int i = 0; i < 3; ++i) scene.clouds[static_cast<std::size_t>(i)].transform[3].x = 250.0 * (i - 1);
    scene.clouds[1].procedural = "cumulus";
    scene.clouds[1].resolution = 37;
    for (int axis = 0; axis < 3; ++axis) scene.clouds[1].transform[axis][axis] = 0.15;
    return scene;
}

LayeredImage pictureOf(Renderer& renderer) {
    for (int i = 0; i < renderer.generationsWanted(); ++i) renderer.traceGeneration();
    return renderer.draw();
}

/// Copies of what `shown` has of the next scene, read in pieces of at least so many bytes.
DensityCopies copiesOf(const ShownDensities& shown, const scene::Scene& next, std::uint64_t piece, int& pieces) {
    DensityCopies copies;
    for (pieces = 1; !shown.copy(next, copies, piece); ++pieces) {
    }
    return copies;
}

std::vector<bool> preparedAnew(const Renderer& renderer) {
    std::vector<bool> anew;
    for (const AssetSummary& asset : renderer.statistics().assets) anew.push_back(asset.upload + asset.tree > 0.0);
    return anew;
}

/// Makes `first`, then `next` with what it has of it, and compares that with `next` by itself. Returns which assets
/// were prepared anew.
std::vector<bool> swapped(const scene::Scene& first, const scene::Scene& next, std::uint64_t piece = 1U << 30U,
                          int morePieces = 0) {
    std::optional<ShownDensities> before(std::in_place);
    auto shown = before->makeRenderer(first, withRing(), {});
    int pieces = 0;
    DensityCopies copies = copiesOf(*before, next, piece, pieces);
    EXPECT_GT(pieces, morePieces);
    shown.reset();  // copies need neither device nor renderer
    before.reset();
    ShownDensities densities;
    const auto renderer = densities.makeRenderer(next, withRing(), std::move(copies));
    const std::vector<bool> anew = preparedAnew(*renderer);
    Renderer alone(next, withRing());
    const LayeredImage image = pictureOf(*renderer), wanted = pictureOf(alone);
    EXPECT_EQ(image.layers, wanted.layers);
    EXPECT_EQ(renderer->statistics().warnings, alone.statistics().warnings);
    EXPECT_EQ(renderer->bounds().outline, alone.bounds().outline);
    EXPECT_EQ(renderer->statistics().clouds.at(2).meanThickness, alone.statistics().clouds.at(2).meanThickness);

    // and once more: what came as a copy is given away as well
    ShownDensities third;
    const auto again = third.makeRenderer(next, withRing(), copiesOf(densities, next, piece, pieces));
    EXPECT_EQ(preparedAnew(*again), std::vector<bool>(anew.size(), false));
    EXPECT_EQ(pictureOf(*again).layers, wanted.layers);
    return anew;
}

TEST(ShownDensities, OnlyTheOneThatHasChangedIsPrepared) {
    const scene::Scene first = threeClouds();
    scene::Scene next = first;
    next.clouds[1].seed = 2;
    EXPECT_EQ(swapped(first, next, 1, 10), (std::vector<bool>{false, true})) << "read slice by slice";
    EXPECT_EQ(swapped(first, first), (std::vector<bool>{false, false}));
}

TEST(ShownDensities, WhatWouldBePreparedInAnotherWayIsLoaded) {
    const scene::Scene first = threeClouds();
    scene::Scene next = first;
    next.clouds[1].seed = 2;
    next.preparation.maxLeaves = 100;
    EXPECT_EQ(swapped(first, next), (std::vector<bool>{true, true}));
    next = first;
    next.clouds[0].extinction *= 3.0;  // leaves are split until they are thin
    EXPECT_EQ(swapped(first, next), (std::vector<bool>{true, true}));
    next = first;
    next.clouds[0] = first.clouds[1];  // the first cloud of a field gives its messages their names
    next.clouds[0].transform = first.clouds[0].transform;
    swapped(first, next);
}

TEST(ShownDensities, BytesOfCopiesAreKnown) {
    const scene::Scene first = threeClouds();
    ShownDensities shown;
    const auto renderer = shown.makeRenderer(first, withRing(), {});
    scene::Scene next = first;
    next.clouds[1].seed = 2;
    EXPECT_GT(shown.copyBytes(first), shown.copyBytes(next));
    EXPECT_GT(shown.copyBytes(next), 18U * 18U * 18U);
    for (scene::Cloud& cloud : next.clouds) cloud.seed = 9;
    for (scene::Cloud& cloud : next.clouds) cloud.resolution = 20;
    EXPECT_EQ(shown.copyBytes(next), 0U);
}

/// Bricks lie as one camera sees them: they are loaded.
TEST(ShownDensities, FieldsInBricksAreNotCopied) {
    scene::Scene scene = threeClouds();
    scene.preparation.storage = scene::DensityStorage::sparse;
    EXPECT_EQ(ShownDensities().copyBytes(scene), 0U);
    ShownDensities shown;
    const auto renderer = shown.makeRenderer(scene, withRing(), {});
    EXPECT_EQ(shown.copyBytes(scene), 0U);
    DensityCopies copies;
    EXPECT_TRUE(shown.copy(scene, copies, 1));
    EXPECT_TRUE(copies.empty());
}

}  // namespace
}  // namespace lumulus
