#include <array>

#include "scene/key_rows.h"

namespace lumulus::scene {
namespace {

constexpr std::array projections{Projection::perspective, Projection::orthographic, Projection::panorama};
constexpr std::array exposureModes{ExposureMode::stops, ExposureMode::ev100, ExposureMode::automatic};
constexpr std::array toneMaps{ToneMap::filmic, ToneMap::agx, ToneMap::aces, ToneMap::neutral, ToneMap::linear};
constexpr std::array majorants{Majorant::automatic, Majorant::local, Majorant::global};
constexpr std::array drawModes{DrawMode::march, DrawMode::billboards};
constexpr std::array surfaceKinds{SurfaceKind::plane, SurfaceKind::sphere, SurfaceKind::disc};

Cloud& cloudOf(Draft& d) {
    return d.scene.clouds.at(d.entry);
}

Surface& surfaceOf(Draft& d) {
    return d.scene.surfaces.at(d.entry);
}

std::vector<Key> imageAndCameraKeys() {
    return {
        integer("image.width", {1.0, 16384.0}, "1280",
                "Width of the picture in pixels. The picture has at most 33554432 pixels.",
                [](Draft& d, const Value& v) { d.scene.image.width = static_cast<int>(v.integer); }),
        integer("image.height", {1.0, 16384.0}, "720", "Height of the picture in pixels.",
                [](Draft& d, const Value& v) { d.scene.image.height = static_cast<int>(v.integer); }),
        number("image.exposure", {-64.0, 64.0}, "(0.0; given, it changes the default of `exposure_mode`)",
               "Photographic stops, applied before the tone map of PNG files. EXR files stay linear.",
               [](Draft& d, const Value& v) { d.scene.image.exposure = v.number; }),
        choice(
            "image.exposure_mode", {"stops", "ev100", "auto"},
            "(\"auto\" under an atmosphere where no exposure is given, else \"stops\")",
            "What sets the exposure of PNG files and of encoded frames: `stops` alone; `ev100`, the exposure value of "
            "a camera, with radiance × 683 lm/W as cd/m²; `auto`, by the clouds themselves, whose 98th percentile "
            "becomes 0.8. `exposure` adds to each of them.",
            [](Draft& d, const Value& v) { d.scene.image.exposureMode = exposureModes.at(v.choice); }),
        number("image.ev100", {-32.0, 32.0}, "15.0",
               "Exposure value at ISO 100, for `ev100`: white is 1.2 · 2^EV cd/m². 15 is a sunny day, -6 starlight.",
               [](Draft& d, const Value& v) { d.scene.image.ev100 = v.number; }),
        choice(
            "image.tone_map", {"filmic", "agx", "aces", "neutral", "linear"}, "\"filmic\"",
            "Tone map of PNG files and of encoded frames. `neutral` keeps colours, `linear` cuts off at 1. Where the "
            "environment variable OCIO names a configuration of OpenColorIO, its default view takes the place of "
            "all of them.",
            [](Draft& d, const Value& v) { d.scene.image.toneMap = toneMaps.at(v.choice); }),
        other("image.background", Type::boolean, "true",
              "Whether the picture shows the sky and the sun's disc behind the clouds. `false` leaves them out of R, G "
              "and B: the picture is the clouds alone, premultiplied, with their alpha in A and in PNG files.",
              [](Draft& d, const Value& v) { d.scene.image.background = v.boolean; }),
        other("camera.position", Type::vector, "(placed so that the clouds fill the picture)", "Metres.",
              [](Draft& d, const Value& v) { d.scene.camera.position = v.vector; }),
        other("camera.target", Type::vector, "(the middle of the clouds)", "Point that the camera looks at, in metres.",
              [](Draft& d, const Value& v) { d.scene.camera.target = v.vector; }),
        other("camera.up", Type::vector, "[0.0, 1.0, 0.0]",
              "Upward direction of the picture. It must not be parallel to the view.",
              [](Draft& d, const Value& v) { d.scene.camera.up = v.vector; }),
        number("camera.vertical_fov", {0.01, 170.0}, "40.0",
               "Vertical field of view in degrees. An orthographic camera frames the same height at the target's "
               "distance.",
               [](Draft& d, const Value& v) { d.scene.camera.verticalFov = v.number; }),
        choice("camera.projection", {"perspective", "orthographic", "panorama"}, "\"perspective\"",
               "`panorama` shows the whole sphere as longitude by latitude, with the target in the middle.",
               [](Draft& d, const Value& v) { d.scene.camera.projection = projections.at(v.choice); }),
    };
}

std::vector<Key> cloudKeys() {
    return {
        other("cloud.name", Type::text, "(its index: \"0\", \"1\", …)",
              "For messages and `--set cloud.NAME.key`. No two clouds have the same. Letters, digits, `-` and `_`, a "
              "letter first; at most 64 of them, and not the name of a key.",
              [](Draft& d, const Value& v) { cloudOf(d).name = v.text; }),
        other("cloud.vdb", Type::path, "(none: a procedural cloud)",
              "Name of an OpenVDB or NanoVDB file, instead of `procedural`. With #### or %04d in it, each frame has a "
              "file "
              "of its own (docs/sequences.md).",
              [](Draft& d, const Value& v) { cloudOf(d).vdb = (d.folder / v.text).lexically_normal(); }),
        other("cloud.grid", Type::text, "\"\"",
              "Name of the grid, in any case; `density[1]` is the second of that name. Empty means `density`, or else "
              "a grid named as smoke, cloud, extinction or water content, or else the first whose name is not that of "
              "a temperature, velocity or the like. `lumulus info` shows which is taken.",
              [](Draft& d, const Value& v) { cloudOf(d).grid = v.text; }),
        other("cloud.clamp", Type::boolean, "false",
              "Negative, infinite and undefined values of the grid become 0. Without it they are errors, but for "
              "negatives of at most 1 % of the maximum, which become 0 with a warning.",
              [](Draft& d, const Value& v) { cloudOf(d).clamp = v.boolean; }),
        choice("cloud.procedural", {"cumulus", "stratocumulus", "stratus", "cirrus", "sphere", "slab"}, "\"cumulus\"",
               "Kind of a procedural cloud, as for `lumulus cloud`.",
               [](Draft& d, const Value& v) { cloudOf(d).procedural = v.text; }),
        integer("cloud.resolution", {8.0, 1024.0}, "192", "Voxels along the longest side of a procedural cloud.",
                [](Draft& d, const Value& v) { cloudOf(d).resolution = static_cast<int>(v.integer); }),
        integer("cloud.seed", seeds, "1", "Seed of a procedural cloud.",
                [](Draft& d, const Value& v) { cloudOf(d).seed = static_cast<std::uint64_t>(v.integer); }),
        other(
            "cloud.transform", Type::matrix, "[[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]",
            "Rows of an invertible matrix that acts on columns (x, y, z, 1), after the grid's own transform. The last "
            "column is a shift in metres. A fourth row, if given, is [0, 0, 0, 1].",
            [](Draft& d, const Value& v) { cloudOf(d).transform = v.matrix; }),
        other("cloud.instances", Type::path, "(none: one cloud, where it is)",
              "Name of a CSV file of places, a cloud for each row: the first line is `x,y,z,yaw,scale,extinction`, "
              "where all after `z` may be left out. Metres; degrees clockwise seen from above; factors. The cloud is "
              "scaled and rotated about the origin after its `transform`, and then moved. The rows of the cloud NAME "
              "are called NAME[0], NAME[1] and so on.",
              [](Draft& d, const Value& v) { cloudOf(d).instances = (d.folder / v.text).lexically_normal(); }),
        number("cloud.density_scale", {0.0, 1e6}, "1.0", "Factor for the values of the grid.",
               [](Draft& d, const Value& v) { cloudOf(d).densityScale = v.number; }),
        number("cloud.extinction", {0.0, 1e6}, "0.08",
               "Extinction at density 1, 1/m: the extinction coefficient is extinction · density_scale · value.",
               [](Draft& d, const Value& v) { cloudOf(d).extinction = v.number; }),
        rgb("cloud.albedo", unit, "1.0", "Single-scattering albedo: the share of the extinction that is scattering.",
            [](Draft& d, const Value& v) { cloudOf(d).albedo = v.vector; }),
    };
}

std::vector<Key> preparationKeys() {
    return {
        integer("preparation.samples", {1.0, 1e8}, "20000",
                "Number of samples of the density's gradient by which the cloud is divided into leaves.",
                [](Draft& d, const Value& v) { d.scene.preparation.samples = static_cast<int>(v.integer); }),
        number("preparation.density_threshold", unit, "0.1",
               "Share of the largest density. A leaf whose densities differ by less is not split further.",
               [](Draft& d, const Value& v) { d.scene.preparation.densityThreshold = v.number; }),
        number("preparation.influence_radius", {0.0, 1e9, true}, "(from the mean distance of samples)",
               "Distance in metres. Space farther from every sample is split off.",
               [](Draft& d, const Value& v) { d.scene.preparation.influenceRadius = v.number; }),
        integer("preparation.max_leaves", {1.0, 16777216.0}, "32768", "Largest number of leaves.",
                [](Draft& d, const Value& v) { d.scene.preparation.maxLeaves = static_cast<int>(v.integer); }),
        number("preparation.memory_budget", {1.0, 1048576.0}, "512.0",
               "MiB for the densities of all clouds on the GPU. What needs more is stored at coarser levels where the "
               "picture shows it smallest, or averaged to larger voxels.",
               [](Draft& d, const Value& v) { d.scene.preparation.memoryBudget = v.number; }),
    };
}

std::vector<Key> photonMapAndDrawKeys() {
    return {
        integer("photon_map.photons", {1.0, 1099511627776.0}, "(2000000; 6000000 where a cloud has flat voxels)",
                "Number of photons in all generations together.",
                [](Draft& d, const Value& v) {
                    d.scene.photonMap.photons = v.integer;
                    d.scene.photonMap.photonsGiven = true;
                }),
        integer("photon_map.generations", {1.0, 4096.0}, "20", "Number of generations of photons in the map.",
                [](Draft& d, const Value& v) { d.scene.photonMap.generations = static_cast<int>(v.integer); }),
        integer("photon_map.first_generation", {0.0, 4294963200.0}, "0",
                "Index of the first generation. Another index gives an independent picture with the same seed.",
                [](Draft& d, const Value& v) { d.scene.photonMap.firstGeneration = v.integer; }),
        integer("photon_map.bands", {1.0, 8.0}, "(4; 8 where a cloud has flat voxels, unless `forward_cut` is given)",
                "Bands of spherical harmonics in a collector, which has bands² coefficients.",
                [](Draft& d, const Value& v) {
                    d.scene.photonMap.bands = static_cast<int>(v.integer);
                    d.scene.photonMap.directionsGiven = true;
                }),
        number("photon_map.forward_cut", {0.0, 90.0},
               "(15.0; 6.0 where a cloud has flat voxels, unless `bands` are given)",
               "Angle in degrees. Scattering by less is treated as unscattered light. 0 means no forward cut.",
               [](Draft& d, const Value& v) {
                   d.scene.photonMap.forwardCut = v.number;
                   d.scene.photonMap.directionsGiven = true;
               }),
        choice(
            "photon_map.majorant", {"auto", "local", "global"}, "\"auto\"",
            "Majorant of the photon walk: one for the cloud (`global`) or a grid (`local`). `auto` takes the one with "
            "fewer steps.",
            [](Draft& d, const Value& v) { d.scene.photonMap.majorant = majorants.at(v.choice); }),
        number("photon_map.memory_budget", {1.0, 1048576.0}, "1024.0",
               "Memory on the GPU for the light of collectors, MiB. A larger map is refused.",
               [](Draft& d, const Value& v) { d.scene.photonMap.memoryBudget = v.number; }),
        integer("photon_map.seed", seeds, "1", "Seed of the photons' random numbers.",
                [](Draft& d, const Value& v) { d.scene.photonMap.seed = static_cast<std::uint64_t>(v.integer); }),
        other("photon_map.transfer", Type::boolean, "false",
              "Whether a frame of `render --frames` goes on with the light of the frame before it, carried along the "
              "motion of the clouds: fewer photons a frame, and less flicker.",
              [](Draft& d, const Value& v) { d.scene.photonMap.transfer = v.boolean; }),
        integer(
            "photon_map.transfer_frames", {0.0, 64.0}, "0",
            "Frames that the light of a frame is the mean of, with `transfer`. 0: 8 where the motion of all clouds is "
            "known, else 4.",
            [](Draft& d, const Value& v) { d.scene.photonMap.transferFrames = static_cast<int>(v.integer); }),
        choice("draw.mode", {"march", "billboards"}, "\"march\"",
               "How a view is drawn: by a ray march or by billboards, which are faster and less exact.",
               [](Draft& d, const Value& v) { d.scene.draw.mode = drawModes.at(v.choice); }),
        number("draw.tolerance", {0.0, 1.0}, "0.2",
               "Tolerance of sparse sampling, relative to the surroundings. Where voxels are larger than pixels, every "
               "fourth pixel of every fourth row is drawn. A block between them is interpolated if the second "
               "differences of light, transmittance and depth are below the tolerance; other blocks are refined. "
               "0 draws every pixel.",
               [](Draft& d, const Value& v) { d.scene.draw.tolerance = v.number; }),
    };
}

std::vector<Key> surfaceKeys() {
    return {
        choice("surface.kind", {"plane", "sphere", "disc"}, "\"plane\"", "Shape of the surface. A plane is infinite.",
               [](Draft& d, const Value& v) { surfaceOf(d).kind = surfaceKinds.at(v.choice); }),
        other("surface.position", Type::vector, "[0.0, 0.0, 0.0]",
              "A point of the plane, or the center of a sphere or disc, in metres.",
              [](Draft& d, const Value& v) { surfaceOf(d).position = v.vector; }),
        other("surface.normal", Type::vector, "[0.0, 1.0, 0.0]", "Normal of a plane or disc, of any length.",
              [](Draft& d, const Value& v) { surfaceOf(d).normal = v.vector; }),
        number("surface.radius", {0.0, 1e9, true}, "100.0", "Radius of a sphere or disc in metres.",
               [](Draft& d, const Value& v) { surfaceOf(d).radius = v.number; }),
        rgb("surface.albedo", unit, "0.5", "Share of the light that is reflected, equally in all directions (Lambert).",
            [](Draft& d, const Value& v) { surfaceOf(d).albedo = v.vector; }),
        rgb("surface.emission", light, "0.0", "Radiance emitted on both sides, W/(m² sr) per channel.",
            [](Draft& d, const Value& v) { surfaceOf(d).emission = v.vector; }),
    };
}

}  // namespace

const std::vector<Key>& schema() {
    static const std::vector<Key> all = [] {
        std::vector<Key> keys;
        for (const auto& part : {imageAndCameraKeys(),
                                 timeKeys(),
                                 sunAndSkyKeys(),
                                 atmosphereKeys(),
                                 mapKeys(),
                                 groundKeys(),
                                 cloudKeys(),
                                 sequenceKeys(),
                                 phaseKeys(),
                                 fieldKeys(),
                                 fieldPhaseKeys(),
                                 preparationKeys(),
                                 storageKeys(),
                                 detailKeys(),
                                 photonMapAndDrawKeys(),
                                 fogKeys(),
                                 mediumKeys(),
                                 surfaceKeys(),
                                 lampKeys(),
                                 meshKeys()}) {
            keys.insert(keys.end(), part.begin(), part.end());
        }
        return keys;
    }();
    return all;
}

}  // namespace lumulus::scene
