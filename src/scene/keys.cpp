#include <array>

#include "scene/key_rows.h"

namespace lumulus::scene {
namespace {

constexpr double koschmieder = 3.912;  // −ln(0.02): optical depth at the visibility (Koschmieder 1924)

constexpr std::array projections{Projection::perspective, Projection::orthographic, Projection::panorama};
constexpr std::array exposureModes{ExposureMode::stops, ExposureMode::ev100, ExposureMode::automatic};
constexpr std::array toneMaps{ToneMap::filmic, ToneMap::agx, ToneMap::aces, ToneMap::neutral, ToneMap::linear};
constexpr std::array majorants{Majorant::automatic, Majorant::local, Majorant::global};
constexpr std::array drawModes{DrawMode::march, DrawMode::billboards};
constexpr std::array fogFilters{FogFilter::scatter, FogFilter::masked, FogFilter::naive, FogFilter::gather};
constexpr std::array fogFetches{FogFetch::bilinear, FogFetch::linearBicubic, FogFetch::cubicBicubic};
constexpr std::array fogDepths{FogDepth::distance, FogDepth::planar, FogDepth::zbuffer};
constexpr std::array mediumKinds{MediumKind::homogeneous, MediumKind::exponential, MediumKind::sphere};
constexpr std::array surfaceKinds{SurfaceKind::plane, SurfaceKind::sphere, SurfaceKind::disc};

Cloud& cloudOf(Draft& d) {
    return d.scene.clouds.at(d.entry);
}

FogMedium& mediumOf(Draft& d) {
    return d.scene.fog.media.at(d.entry);
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
        number("image.exposure", {-64.0, 64.0}, "0.0",
               "Photographic stops, applied before the tone map of PNG files. EXR files stay linear.",
               [](Draft& d, const Value& v) { d.scene.image.exposure = v.number; }),
        choice(
            "image.exposure_mode", {"stops", "ev100", "auto"}, "\"stops\"",
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
              "Name of an OpenVDB or NanoVDB file, instead of `procedural`.",
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
        choice("cloud.procedural", {"cumulus", "stratus", "cirrus", "sphere", "slab"}, "\"cumulus\"",
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
        number(
            "preparation.memory_budget", {1.0, 1048576.0}, "512.0",
            "MiB for the density volumes of all clouds on the GPU. Grids that need more are averaged to larger voxels.",
            [](Draft& d, const Value& v) { d.scene.preparation.memoryBudget = v.number; }),
    };
}

std::vector<Key> photonMapAndDrawKeys() {
    return {
        integer("photon_map.photons", {1.0, 1099511627776.0}, "2000000",
                "Number of photons in all generations together.",
                [](Draft& d, const Value& v) { d.scene.photonMap.photons = v.integer; }),
        integer("photon_map.generations", {1.0, 4096.0}, "20", "Number of generations of photons in the map.",
                [](Draft& d, const Value& v) { d.scene.photonMap.generations = static_cast<int>(v.integer); }),
        integer("photon_map.first_generation", {0.0, 4294963200.0}, "0",
                "Index of the first generation. Another index gives an independent picture with the same seed.",
                [](Draft& d, const Value& v) { d.scene.photonMap.firstGeneration = v.integer; }),
        integer("photon_map.bands", {1.0, 8.0}, "4",
                "Bands of spherical harmonics in a collector, which has bands² coefficients.",
                [](Draft& d, const Value& v) { d.scene.photonMap.bands = static_cast<int>(v.integer); }),
        number("photon_map.forward_cut", {0.0, 90.0}, "15.0",
               "Angle in degrees. Scattering by less is treated as unscattered light. 0 means no forward cut.",
               [](Draft& d, const Value& v) { d.scene.photonMap.forwardCut = v.number; }),
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

std::vector<Key> fogKeys() {
    return {
        choice("fog.filter", {"scatter", "masked", "naive", "gather"}, "\"scatter\"",
               "How scattered light is spread over the picture: `scatter` conserves energy, `masked` (Elek 2013, Iser "
               "2017) and `naive` gather from blurred copies, `gather` is the exact and slow reference.",
               [](Draft& d, const Value& v) { d.scene.fog.filter = fogFilters.at(v.choice); }),
        integer("fog.filter_size", {2.0, 6.0}, "4", "Width in taps of the filter between two levels: 2, 4 or 6.",
                [](Draft& d, const Value& v) { d.scene.fog.filterSize = static_cast<int>(v.integer); }),
        choice("fog.fetch", {"bilinear", "linear-bicubic", "cubic-bicubic"}, "\"linear-bicubic\"",
               "Interpolation between the pixels of a level. `scatter` has linear and cubic interpolation only.",
               [](Draft& d, const Value& v) { d.scene.fog.fetch = fogFetches.at(v.choice); }),
        integer("fog.depth_lookups", {0.0, 4.0}, "2",
                "For `masked`: number of corrections of the level by the blurred distance at the level before.",
                [](Draft& d, const Value& v) { d.scene.fog.depthLookups = static_cast<int>(v.integer); }),
        number(
            "fog.sky_distance", {0.0, 1e9, true}, "100000.0",
            "Distance in metres at which the fog ends. The sky and everything farther is seen through this much fog.",
            [](Draft& d, const Value& v) { d.scene.fog.skyDistance = v.number; }),
        other("fog.inscattering", Type::boolean, "true",
              "For `lumulus reference`: with `false` the fog scatters only the light of surfaces and clouds, as the "
              "filter "
              "does, and no light straight from sun or sky.",
              [](Draft& d, const Value& v) { d.scene.fog.inscattering = v.boolean; }),
        choice("fog.depth", {"distance", "planar", "zbuffer"}, "\"distance\"",
               "Meaning of the depth for `lumulus composite`: metres along the ray, metres along the view's axis, or a "
               "z-buffer from 0 at `near` to 1 at `far`.",
               [](Draft& d, const Value& v) { d.scene.fog.depth = fogDepths.at(v.choice); }),
        number("fog.near", {0.0, 1e9, true}, "0.1",
               "Distance in metres where the z-buffer is 0. In a reversed z-buffer it is beyond `far`.",
               [](Draft& d, const Value& v) { d.scene.fog.near = v.number; }),
        number("fog.far", {0.0, 1e9, true}, "1000.0", "Distance in metres where the z-buffer is 1.",
               [](Draft& d, const Value& v) { d.scene.fog.far = v.number; }),
        number("fog.separation.strength", unit, "1.0",
               "For `masked`: share of the light of bright near pixels that is filtered separately. 0 means none.",
               [](Draft& d, const Value& v) { d.scene.fog.separation = v.number; }),
        number("fog.separation.luminance", {0.0, 1e9, true}, "3.0",
               "Luminance in W/(m² sr) above which scattered light is separated. All of it is separated at twice that.",
               [](Draft& d, const Value& v) { d.scene.fog.separationLuminance = v.number; }),
        number(
            "fog.separation.spread", {0.0, 1e3, true}, "0.05",
            "Share of the picture's height. Light of a larger spread is not separated; all of it is below half that.",
            [](Draft& d, const Value& v) { d.scene.fog.separationSpread = v.number; }),
        number("fog.separation.level", unit, "0.7", "Factor for the level at which separated light is read.",
               [](Draft& d, const Value& v) { d.scene.fog.separationLevel = v.number; }),
    };
}

std::vector<Key> mediumKeys() {
    return {
        choice("fog.media.kind", {"homogeneous", "exponential", "sphere"}, "\"homogeneous\"",
               "Kind of the relative density ϱ at x: 1; exp(-falloff ⟨x - offset, direction⟩); 1 - (r/radius)² at the "
               "distance r from the center, 0 beyond the radius. Media add up.",
               [](Draft& d, const Value& v) { mediumOf(d).kind = mediumKinds.at(v.choice); }),
        rgb("fog.media.scattering", coefficients, "0.0", "Scattering coefficient where ϱ is 1, 1/m.",
            [](Draft& d, const Value& v) { mediumOf(d).scattering = v.vector; }),
        rgb("fog.media.absorption", coefficients, "0.0", "Absorption coefficient where ϱ is 1, 1/m.",
            [](Draft& d, const Value& v) { mediumOf(d).absorption = v.vector; }),
        number("fog.media.visibility", {0.0, 1e9, true}, "(scattering and absorption instead)",
               "Visibility in metres, instead of `scattering` and `absorption`: the medium only scatters, by "
               "3.912/visibility "
               "where ϱ is 1 (Koschmieder: 2 % of the contrast is left at that distance).",
               [](Draft& d, const Value& v) { mediumOf(d).scattering = glm::dvec3(koschmieder / v.number); }),
        number("fog.media.g", {-1.0, 1.0, true, true}, "0.9", "Mean cosine of scattering.",
               [](Draft& d, const Value& v) { mediumOf(d).g = v.number; }),
        rgb("fog.media.emission", light, "0.0", "Radiance gained per metre where ϱ is 1, W/(m³ sr).",
            [](Draft& d, const Value& v) { mediumOf(d).emission = v.vector; }),
        number("fog.media.falloff", {0.0, 1e3}, "0.01", "For `exponential`: rate of the falloff, 1/m.",
               [](Draft& d, const Value& v) { mediumOf(d).falloff = v.number; }),
        other("fog.media.direction", Type::vector, "[0.0, 1.0, 0.0]",
              "For `exponential`: direction towards thinner fog, of any length.",
              [](Draft& d, const Value& v) { mediumOf(d).direction = v.vector; }),
        other("fog.media.offset", Type::vector, "[0.0, 0.0, 0.0]", "For `exponential`: a point in metres where ϱ is 1.",
              [](Draft& d, const Value& v) { mediumOf(d).offset = v.vector; }),
        other("fog.media.center", Type::vector, "[0.0, 0.0, 0.0]", "For `sphere`: its center in metres.",
              [](Draft& d, const Value& v) { mediumOf(d).center = v.vector; }),
        number("fog.media.radius", {0.0, 1e9, true}, "100.0", "For `sphere`: its radius in metres.",
               [](Draft& d, const Value& v) { mediumOf(d).radius = v.number; }),
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
        for (const auto& part :
             {imageAndCameraKeys(), timeKeys(), sunAndSkyKeys(), atmosphereKeys(), cloudKeys(), phaseKeys(),
              preparationKeys(), photonMapAndDrawKeys(), fogKeys(), mediumKeys(), surfaceKeys()}) {
            keys.insert(keys.end(), part.begin(), part.end());
        }
        return keys;
    }();
    return all;
}

}  // namespace lumulus::scene
