// Interface structs of drawing. Positions are metres relative to the eye: a cloud may lie 1e7 m from the origin.
#ifndef LUMULUS_SHARED_DRAW_H
#define LUMULUS_SHARED_DRAW_H

#include "shared/environment.h"
#include "shared/instance.h"
#include "shared/prelude.h"

SHARED_BEGIN

const int PROJECTION_PERSPECTIVE = 0;
const int PROJECTION_ORTHOGRAPHIC = 1;
const int PROJECTION_PANORAMA = 2;

/// Edge of a tile of pixels that share a list of billboards.
const int TILE_EDGE = 8;
/// Depth where there is no cloud [m]: finite, so that no infinity leaves a pass.
const float FAR_DEPTH = 1.0e10F;

struct ViewParams {
    vec3 right;
    vec3 up;
    vec3 forward;     // to the middle of the picture; longer than 1 where the frustum is off axis
    vec2 halfExtent;  // tangents of the half angles (perspective) or half sizes in metres (orthographic)
    ivec2 size;       // of the whole picture, pixels
    int projection;
};

/// The sun's light. Its disc is drawn after all else (frame/sun_cover.h).
struct LightParams {
    vec3 sunTravel;  // unit vector along which sunlight travels
};

/// Points at every `spacing`th pixel of every `spacing`th row of the whole picture; those that a tile needs.
struct SamplingGrid {
    ivec2 first;  // point
    ivec2 size;
    int spacing;
    float tolerance;       // of second differences between points, against the brightest of them
    float depthTolerance;  // the same of distances [m]
};

struct DrawParams {
    ViewParams view;
    LightParams light;
    EnvironmentParams environment;
    AtlasParams atlas;
    SamplingGrid sampling;
    int instances;
    int tilesAcross;
    int samples;           // rays a pixel, along each side: a grid of them where pixels are larger than voxels
    float eyeAboveGround;  // metres; unused where there is no ground
    mat3 skyAxes;          // from the frame of skyReturn to the world
};

/// How fine a tile of a picture of several clouds is. In the lower bits: points may lie as far apart as they do, two
/// pixels, or one; above them: rays of each pixel along a side.
const uint ANY_DETAIL = 0U;
const uint DETAIL_OF_SQUARES = 1U;
const uint DETAIL_OF_PIXELS = 2U;
const uint DETAIL_RAYS_SHIFT = 2U;

/// Which pixels a dispatch draws: a rectangle of them; a rectangle of sampling points; of a rectangle the pixels in
/// listed squares of two by two; or, of a rectangle of every second pixel of every second row, those in listed blocks
/// (four by four pixels, from a sampling point to the next ones). In squares and blocks the first pixel is known and
/// left out.
const int DRAW_PIXELS = 0;
const int DRAW_SPARSE = 1;
const int DRAW_SQUARES = 2;
const int DRAW_REFINED = 3;
/// Squares or blocks of which a workgroup (16×4 invocations) draws three pixels each.
const int LISTED_GROUP = 21;

struct DrawPush {
    int what;
    ivec2 first;
    ivec2 count;
};

/// Pixels that are interpolated, and blocks from sampling point to sampling point that are looked at for them.
struct InterpolatePush {
    ivec2 first;  // pixel
    ivec2 count;
    ivec2 firstBlock;
    ivec2 blocks;
};

/// Texels in a row of a list that is an image.
const int LIST_WIDTH = 4096;

/// A sphere that stands for a leaf. Two texels of an image: centre and radius; share and instance.
struct Billboard {
    vec3 centre;
    float radius;
    float share;     // of the cloud's density
    float instance;  // its number
};
/// Volume of billboards against what their leaves fill: neighbours overlap, and no holes show.
const float BILLBOARD_OVERLAP = 2.75F;

/// What a drawing pass leaves of one pixel: three texels of four floats for whoever loads it (shaders/lib/pixel.glsl).
struct Pixel {
    vec3 cloud;  // without the sky
    float transmittance;
    float alpha;
    float depth;
    float front;
    vec3 radiance;  // with the sky
    vec2 unused;    // never stored
};
const int PIXEL_TEXELS = 3;

/// Grid of optical depth towards the sun, its third axis along the light.
struct ShadowVolumePush {
    mat3 gridToVoxel;  // per texel
    vec3 originVoxel;  // voxel coordinates of the middle of texel (0,0,0)
    vec3 inverseSize;  // of the density volume
    ivec3 grid;
    float step;    // optical depth of one texel's length at density 1
    int firstRow;  // of columns that are filled now
};

/// What the rays find in billboards.
struct BillboardMeanPush {
    mat3 worldToVoxel;  // of directions: voxels per metre
    vec3 inverseSize;   // of the density volume
    uint spheres;
};

/// The grid on which collectors' radiance is smoothed.
struct LightFieldPush {
    ivec3 size;  // voxels
    ivec3 grid;  // cells
    int edge;    // of a cell, voxels
    vec3 eye;    // voxel coordinates
    mat3 voxelToWorld;
    uint occupied;        // cells with density, the first of the list
    uint lit;             // cells of the list
    uint firstCollector;  // of the instance, among those of all
};

/// Mass of each cell.
struct LightMassPush {
    ivec3 size;        // voxels
    ivec3 grid;        // cells
    int edge;          // of a cell, voxels
    vec3 perMajorant;  // 1 / edges of a cell of the majorants [1/voxels]
    ivec3 majorantCells;
};

/// What photons counted in its cells, against what their collectors have there.
struct LightCountsPush {
    ivec3 size;  // voxels
    ivec3 grid;  // cells
    ivec3 estimatorCells;
    int estimatorAcross;  // cells of the estimates along an edge of a cell
    uint estimatorBase;
    float estimatorScale;  // counts → W
    float massScale;       // ∫ normalised density [voxels] → ∫ σt' dV [m²]
    float photon;          // mean luminance of a photon [W]
    float moment;          // of the phase function, of band 1
    float thickness;  // ∫ normalised density [voxels] → edge of a cell in transport mean free paths, on average in it
    uint occupied;    // cells with density, the first of the list
    uint firstCollector;  // of the instance, among those of all
};

#ifdef __cplusplus
// Scalar layout, as SPIR-V has it; tests/unit/shared_layout_test.cpp compares every member.
static_assert(sizeof(ViewParams) == 56 && offsetof(ViewParams, projection) == 52);
static_assert(sizeof(LightParams) == 12);
static_assert(sizeof(SamplingGrid) == 28 && offsetof(SamplingGrid, depthTolerance) == 24);
static_assert(sizeof(DrawParams) == 196 && offsetof(DrawParams, eyeAboveGround) == 156);
static_assert(sizeof(DrawPush) == 20 && offsetof(DrawPush, count) == 12);
static_assert(sizeof(InterpolatePush) == 32 && offsetof(InterpolatePush, blocks) == 24);
static_assert(sizeof(Pixel) == 16 * PIXEL_TEXELS && offsetof(Pixel, unused) == 40);
static_assert(sizeof(ShadowVolumePush) == 80 && offsetof(ShadowVolumePush, firstRow) == 76);
static_assert(sizeof(BillboardMeanPush) == 52 && offsetof(BillboardMeanPush, spheres) == 48);
static_assert(sizeof(LightFieldPush) == 88 && offsetof(LightFieldPush, firstCollector) == 84);
static_assert(sizeof(LightCountsPush) == 72 && offsetof(LightCountsPush, firstCollector) == 68);
#endif

SHARED_END

#endif
