// Every interface struct of shaders/shared lies in C++ as in SPIR-V, as does one of the test shaders that has it all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "gpu/reflection.h"
#include "gpu/shaders/interface.h"
#include "shared/cloud.h"
#include "shared/draw.h"
#include "shared/fog.h"
#include "shared/fog_layers.h"
#include "shared/frame.h"
#include "shared/ground.h"
#include "shared/lit_fog.h"
#include "shared/mesh.h"
#include "shared/photon.h"
#include "shared/sky_view.h"
#include "shared/world.h"
#include "support/struct_layout.h"

namespace lumulus::test {

inline void PrintTo(const MemberLayout& member, std::ostream* out) {
    *out << member.name << " at " << member.offset << ", " << member.bytes << " bytes";
}

namespace {

namespace spirv {
#include "spirv/cloud/block_majorant.comp.h"
#include "spirv/cloud/join_index.comp.h"
#include "spirv/cloud/leaf_statistics.comp.h"
#include "spirv/cloud/sample.comp.h"
#include "spirv/draw/billboard_mean.comp.h"
#include "spirv/draw/billboards.comp.h"
#include "spirv/draw/interpolate.comp.h"
#include "spirv/draw/march.comp.h"
#include "spirv/fog/chain_fetch.comp.h"
#include "spirv/fog/exact.comp.h"
#include "spirv/fog/join.comp.h"
#include "spirv/fog/lit.comp.h"
#include "spirv/fog/lit_join.comp.h"
#include "spirv/fog/margin.comp.h"
#include "spirv/fog/masked_prepare.comp.h"
#include "spirv/fog/scatter_down.comp.h"
#include "spirv/fog/scatter_prepare.comp.h"
#include "spirv/fog/split.comp.h"
#include "spirv/frame/background.comp.h"
#include "spirv/frame/read_band.comp.h"
#include "spirv/frame/sky.comp.h"
#include "spirv/frame/sky_fog.comp.h"
#include "spirv/frame/sky_map.comp.h"
#include "spirv/frame/sun_pixels.comp.h"
#include "spirv/gpu/shaders/layout.comp.h"
#include "spirv/light/light_cells.comp.h"
#include "spirv/light/light_counts.comp.h"
#include "spirv/light/light_mass.comp.h"
#include "spirv/light/shadow_volume.comp.h"
#include "spirv/light/shared_shadow.comp.h"
#include "spirv/mesh/rays.comp.h"
#include "spirv/mesh/shade_volume.comp.h"
#include "spirv/photon/accumulate.comp.h"
#include "spirv/photon/gather.comp.h"
#include "spirv/photon/ground_counts.comp.h"
#include "spirv/photon/reconstruct.comp.h"
#include "spirv/photon/trace.comp.h"
#include "spirv/photon/trace_world.comp.h"
}  // namespace spirv

using namespace shared;  // NOLINT: the structs under test

// MEMBERS(Struct, a, b, …): a MemberLayout for each member.
#define PARENTHESES ()
#define EXPAND(...) EXPAND3(EXPAND3(EXPAND3(EXPAND3(__VA_ARGS__))))
#define EXPAND3(...) EXPAND2(EXPAND2(EXPAND2(EXPAND2(__VA_ARGS__))))
#define EXPAND2(...) EXPAND1(EXPAND1(EXPAND1(EXPAND1(__VA_ARGS__))))
#define EXPAND1(...) __VA_ARGS__
#define MEMBERS(type, ...) EXPAND(MEMBER_STEP(type, __VA_ARGS__))
#define MEMBER_STEP(type, member, ...)            \
    MemberLayout{#member, offsetof(type, member), \
                 sizeof(type::member)} __VA_OPT__(, MEMBER_AGAIN PARENTHESES(type, __VA_ARGS__))
#define MEMBER_AGAIN() MEMBER_STEP

#define EXPECT_LAYOUT(shader, type, ...)                                               \
    do {                                                                               \
        const StructLayout layout = structLayout(spirv::shader, #type);                \
        EXPECT_EQ(layout.bytes, sizeof(type));                                         \
        EXPECT_THAT(layout.members, testing::ElementsAre(MEMBERS(type, __VA_ARGS__))); \
    } while (false)

/// A push-constant block holds the struct and is as large, but for the padding after its last member.
#define EXPECT_PUSH(shader, type, ...)        \
    EXPECT_LAYOUT(shader, type, __VA_ARGS__); \
    EXPECT_EQ(roundedUp(gpu::reflect(spirv::shader).pushBytes, alignof(type)), sizeof(type)) << #type

std::uint64_t roundedUp(std::uint64_t bytes, std::uint64_t alignment) {
    return (bytes + alignment - 1) / alignment * alignment;
}

TEST(StructLayout, EveryKindOfMember) {
    EXPECT_LAYOUT(layout_comp, Outer, first, position, total, inner, rotation, cell, last);
    EXPECT_LAYOUT(layout_comp, Inner, direction, weight, pair);
}

TEST(StructLayout, BlockEndsWithItsArrayOfUnknownLength) {
    EXPECT_THAT(structLayout(spirv::layout_comp, "Records").members,
                testing::ElementsAre(MemberLayout{"count", 0, 4}, MemberLayout{"records", 8, 0}));
}

TEST(StructLayout, UnknownNameIsRefused) {
    EXPECT_THROW(structLayout(spirv::layout_comp, "Nobody"), std::logic_error);
}

TEST(SharedLayout, Cloud) {
    EXPECT_LAYOUT(leaf_statistics_comp, LeafBox, lower, upper);
    EXPECT_LAYOUT(leaf_statistics_comp, LeafStatistics, majorant, mass, moment, occupied);
    EXPECT_PUSH(leaf_statistics_comp, LeafPush, size, leaves);
    EXPECT_PUSH(join_index_comp, CopyIndexPush, count, first);
    EXPECT_PUSH(block_majorant_comp, BlockPush, size, blocks, gradientToMetres);
    EXPECT_PUSH(sample_comp, SamplePush, gradientToMetres, size, blocks, samples, seed);
}

TEST(SharedLayout, Photon) {
    EXPECT_LAYOUT(trace_comp, TraceParams, worldToCells, size, cells, cellSize, extinction, scatterShare, albedo,
                  straightWeight, scatterFraction, asymmetry, sunDirection, sunCone, faceArea, faceSize, sunThrough,
                  sunPower, skyPower, sunPhotons, photons, generation, stream, collectors, invocations, recordCapacity,
                  stepLimit, collisionLimit, estimatorBase, estimatorEdge, estimatorCells, axisBase, air, skyAxes);
    EXPECT_LAYOUT(trace_comp, AirPlace, across, up, origin);
    EXPECT_LAYOUT(trace_comp, SkyCell, keep, other, low, high);
    EXPECT_LAYOUT(trace_comp, TraceState, cell, offset, direction, weight, depth, photon, draws, collisions,
                  scatterings, alive);
    EXPECT_LAYOUT(trace_comp, PhotonRecord, collector, direction, power);
    EXPECT_LAYOUT(trace_comp, TraceCounters, events, nulls, absorbed, escaped, lost, records, reflected,
                  transmittedDiffuse, transmittedDirect, pending, unused);
    EXPECT_LAYOUT(trace_comp, GroundParams, cellsToWorld, origin, extent, cells, albedo, open, sky, countBase);
    EXPECT_PUSH(ground_counts_comp, GroundCountsPush, base, count, unit);
    EXPECT_PUSH(gather_comp, GatherPush, collectors, invocations, recordCapacity);
    EXPECT_PUSH(accumulate_comp, AccumulatePush, coefficients, shift, keepSlots);
    EXPECT_PUSH(reconstruct_comp, ReconstructPush, collectors, scale, eye, voxelToWorld, sunDirection, axisBase,
                angleScale);
}

TEST(SharedLayout, Mesh) {
    EXPECT_LAYOUT(rays_comp, MeshNode, lower0, upper0, lower1, upper1, child0, child1, count0, count1);
    EXPECT_LAYOUT(rays_comp, MeshTriangle, corner, edge1, edge2);
    EXPECT_LAYOUT(rays_comp, MeshInstance, toModel, shift, root, firstTriangle, number);
    EXPECT_LAYOUT(rays_comp, MeshRay, origin, least, direction, most, fromInstance, fromTriangle);
    EXPECT_LAYOUT(rays_comp, MeshHit, distance, instance, triangle, place);
    EXPECT_LAYOUT(march_comp, MeshPixel, radiance, distance, edge);
    EXPECT_PUSH(rays_comp, MeshPush, rays, anyHit);
    EXPECT_PUSH(shade_volume_comp, MeshVolumePush, toMap, origin, size);
    EXPECT_LAYOUT(trace_comp, MeshShadeParams, toMap, size);
}

TEST(SharedLayout, Draw) {
    EXPECT_LAYOUT(billboards_comp, ViewParams, right, up, forward, halfExtent, size, projection);
    EXPECT_LAYOUT(billboards_comp, LightParams, sunTravel);
    EXPECT_LAYOUT(billboards_comp, EnvironmentParams, radiance);
    EXPECT_LAYOUT(billboards_comp, AtlasParams, density, light, shadow);
    EXPECT_LAYOUT(billboards_comp, InstanceParams, worldToVoxel, eyeVoxel, size, cells, cellSize, extinction,
                  voxelLength, radianceScale, voxelToShadow, shadowOffset, sunIrradiance, albedo, extinctionScale,
                  scatterShare, angleScale, tauMaximum, phaseTable, densityOrigin, lightOrigin, shadowOrigin,
                  cellOrigin, lightSize, shadowSize, firstBrick, air, airTexel);
    EXPECT_LAYOUT(billboards_comp, SamplingGrid, first, size, spacing, tolerance, depthTolerance);
    EXPECT_LAYOUT(billboards_comp, DrawParams, view, light, environment, atlas, sampling, instances, tilesAcross,
                  samples, eyeAboveGround, skyAxes);
    EXPECT_PUSH(billboards_comp, DrawPush, what, first, count);
    EXPECT_PUSH(interpolate_comp, InterpolatePush, first, count, firstBlock, blocks);
    EXPECT_LAYOUT(billboards_comp, Pixel, cloud, transmittance, alpha, depth, front, radiance, unused);
    EXPECT_LAYOUT(trace_world_comp, MergedGridParams, bricks, instances, edge, largestWeight, entryCells, entryEdge,
                  starts);

    EXPECT_PUSH(shared_shadow_comp, SharedShadowPush, size, origin, first, occluders);
    EXPECT_PUSH(shadow_volume_comp, ShadowVolumePush, gridToVoxel, originVoxel, inverseSize, grid, step, firstRow);
    EXPECT_PUSH(light_mass_comp, LightMassPush, size, grid, edge, perMajorant, majorantCells);
    EXPECT_PUSH(light_cells_comp, LightFieldPush, size, grid, edge, eye, voxelToWorld, occupied, lit, firstCollector);
    EXPECT_PUSH(light_counts_comp, LightCountsPush, size, grid, estimatorCells, estimatorAcross, estimatorBase,
                estimatorScale, massScale, photon, moment, thickness, occupied, firstCollector);
    EXPECT_PUSH(billboard_mean_comp, BillboardMeanPush, worldToVoxel, inverseSize, spheres);
}

TEST(SharedLayout, Fog) {
    EXPECT_LAYOUT(scatter_prepare_comp, FogMedium, kind, scattering, absorption, emission, g, axis, falloff, eyeHeight,
                  center, radius, halfSize, aboveBottom, belowTop, thickness, bounded);
    EXPECT_PUSH(scatter_prepare_comp, FogPush, view, pixelsPerRadian, skyDistance, media, last);
    EXPECT_PUSH(scatter_down_comp, LevelPush, finerOffset, finerSize, coarserOffset, coarserSize, finerExtent,
                inverseImage, level, last, levelScale);
    EXPECT_PUSH(masked_prepare_comp, SeparationPush, size, strength, luminance, spread);
    EXPECT_PUSH(chain_fetch_comp, FetchPush, size, inverseImage, last, levelScale, depthLookups, separationLevel);
    EXPECT_PUSH(exact_comp, ExactPush, size, firstRow, rows);
    EXPECT_LAYOUT(split_comp, LayerSummary, clouded, lit, farthest);
    EXPECT_PUSH(split_comp, FogSplitPush, size, sky);
    EXPECT_PUSH(join_comp, FogJoinPush, first, size, clouded, lit);
    EXPECT_LAYOUT(lit_comp, LitFogParams, view, first, toSun, sunIrradiance, sunAcross, eyeHeight, height, levels,
                  media, aboveGround, casters, inverseShadows, sky, airMedia, aboveTop, planetHeight, up, changeSize,
                  changeNear, changeFar, meshes);
    EXPECT_LAYOUT(lit_comp, LitFogSummary, more, less, farthest);
    EXPECT_PUSH(lit_join_comp, FogSpreadPush, view, skyDistance, media, sign_, margin);
    EXPECT_PUSH(margin_comp, FogMarginPush, margin);
}

TEST(SharedLayout, Frame) {
    EXPECT_LAYOUT(sun_pixels_comp, SunPixel, pixel, radiance);
    EXPECT_PUSH(sun_pixels_comp, SunPixelsPush, count);
    EXPECT_PUSH(background_comp, BackgroundPush, size, withoutFirst, withoutSize, radiance);
    EXPECT_LAYOUT(sky_comp, SkyViewParams, up, sunAcross, toSun, height, planetHeight, horizon, highest,
                  horizonDistance, asymmetry);
    EXPECT_LAYOUT(sky_comp, SkyPassParams, view, sky, first, pixelAngle, nearest, farthest, moon);
    EXPECT_LAYOUT(sky_fog_comp, SkyFogParams, sky, aboveFog);
    EXPECT_LAYOUT(sky_map_comp, SkyMapParams, view, toMap, size, first, samples);
    EXPECT_PUSH(read_band_comp, BandPush, first, size);
}

}  // namespace
}  // namespace lumulus::test
