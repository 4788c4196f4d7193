#include <array>

#include "scene/schema.h"

namespace lumulus::scene {
namespace {

using Setter = void (*)(Draft&, const Value&);
using Text = std::string_view;

constexpr Range unit{0.0, 1.0};
constexpr Range light{0.0, 1e9};
constexpr Range coefficients{0.0, 1e6};
constexpr double koschmieder = 3.912;            // −ln(.02): optical depth at the visibility (Koschmieder 1924)
constexpr Range seeds{0.0, 9007199254740992.0};  // 2^53, which every reader of numbers takes exactly

constexpr std::array projections{Projection::perspective, Projection::orthographic, Projection::panorama};
constexpr std::array phaseModels{PhaseModel::henyeyGreenstein,
                                 PhaseModel::henyeyGreenstein,
                                 PhaseModel::schlick,
                                 PhaseModel::rayleigh,
                                 PhaseModel::hazy,
                                 PhaseModel::murky,
                                 PhaseModel::droplet};
constexpr std::array majorants{Majorant::automatic, Majorant::local, Majorant::global};
constexpr std::array drawModes{DrawMode::march, DrawMode::billboards};
constexpr std::array fogFilters{FogFilter::scatter, FogFilter::masked, FogFilter::naive, FogFilter::gather};
constexpr std::array fogFetches{FogFetch::bilinear, FogFetch::linearBicubic, FogFetch::cubicBicubic};
constexpr std::array fogDepths{FogDepth::distance, FogDepth::planar, FogDepth::zbuffer};
constexpr std::array mediumKinds{MediumKind::homogeneous, MediumKind::exponential, MediumKind::sphere};
constexpr std::array surfaceKinds{SurfaceKind::plane, SurfaceKind::sphere, SurfaceKind::disc};

Key number(Text name, Range range, Text fallback, Text documentation, Setter set) {
    return {name, Type::number, range, {}, fallback, documentation, set};
}

Key integer(Text name, Range range, Text fallback, Text documentation, Setter set) {
    return {name, Type::integer, range, {}, fallback, documentation, set};
}

Key rgb(Text name, Range range, Text fallback, Text documentation, Setter set) {
    return {name, Type::rgb, range, {}, fallback, documentation, set};
}

Key choice(Text name, std::vector<Text> choices, Text fallback, Text documentation, Setter set) {
    return {name, Type::choice, {}, std::move(choices), fallback, documentation, set};
}

Key other(Text name, Type type, Text fallback, Text documentation, Setter set) {
    return {name, type, {}, {}, fallback, documentation, set};
}

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
        integer("image.width", {1.0, 16384.0}, "1280", "Pixels. The picture has at most 33554432 of them.",
                [](Draft& d, const Value& v) { d.scene.image.width = static_cast<int>(v.integer); }),
        integer("image.height", {1.0, 16384.0}, "720", "Pixels.",
                [](Draft& d, const Value& v) { d.scene.image.height = static_cast<int>(v.integer); }),
        number("image.exposure", {-64.0, 64.0}, "0.0",
               "Photographic stops, applied before the tone map of PNG files. EXR files stay linear.",
               [](Draft& d, const Value& v) { d.scene.image.exposure = v.number; }),
        other("camera.position", Type::vector, "(placed so that the clouds fill the picture)", "Metres.",
              [](Draft& d, const Value& v) { d.scene.camera.position = v.vector; }),
        other("camera.target", Type::vector, "(the middle of the clouds)", "The point looked at, metres.",
              [](Draft& d, const Value& v) { d.scene.camera.target = v.vector; }),
        other("camera.up", Type::vector, "[0.0, 1.0, 0.0]", "A direction; not along the view.",
              [](Draft& d, const Value& v) { d.scene.camera.up = v.vector; }),
        number("camera.vertical_fov", {0.01, 170.0}, "40.0",
               "Degrees. For an orthographic camera the angle that frames the same height at the target's distance.",
               [](Draft& d, const Value& v) { d.scene.camera.verticalFov = v.number; }),
        choice("camera.projection", {"perspective", "orthographic", "panorama"}, "\"perspective\"",
               "`panorama` is the whole sphere: longitude by latitude, the target in the middle.",
               [](Draft& d, const Value& v) { d.scene.camera.projection = projections.at(v.choice); }),
    };
}

std::vector<Key> sunAndSkyKeys() {
    return {
        other("sun.direction_to", Type::vector, "(from azimuth and elevation)",
              "Direction towards the sun, any length. Instead of azimuth and elevation.",
              [](Draft& d, const Value& v) { d.directionTo = v.vector; }),
        number("sun.azimuth", {-360.0, 360.0}, "70.0",
               "Degrees, clockwise seen from above: 0 is towards -Z, 90 towards +X.",
               [](Draft& d, const Value& v) { d.azimuth = v.number; }),
        number("sun.elevation", {-90.0, 90.0}, "35.0", "Degrees above the horizon.",
               [](Draft& d, const Value& v) { d.elevation = v.number; }),
        rgb("sun.irradiance", light, "[5.0, 4.8, 4.4]", "On a plane that faces the sun, W/m² per channel. 0 is no sun.",
            [](Draft& d, const Value& v) { d.scene.sun.irradiance = v.vector; }),
        number("sun.angular_diameter", {0.0, 90.0}, "0.53", "Degrees.",
               [](Draft& d, const Value& v) { d.scene.sun.angularDiameter = v.number; }),
        choice("sky.model", {"constant"}, "\"constant\"", "The same radiance from everywhere.",
               [](Draft&, const Value&) {}),
        rgb("sky.radiance", light, "[0.12, 0.22, 0.42]", "W/(m² sr) per channel.",
            [](Draft& d, const Value& v) { d.scene.sky.radiance = v.vector; }),
    };
}

std::vector<Key> cloudKeys() {
    return {
        other("cloud.name", Type::text, "(its index: \"0\", \"1\", …)",
              "For messages and `--set cloud.NAME.key`. No two clouds have the same. Letters, digits, `-` and `_`, a "
              "letter first; at most 64 of them, and not the name of a key.",
              [](Draft& d, const Value& v) { cloudOf(d).name = v.text; }),
        other("cloud.vdb", Type::path, "(none: a procedural cloud)", "OpenVDB file. Instead of `procedural`.",
              [](Draft& d, const Value& v) { cloudOf(d).vdb = (d.folder / v.text).lexically_normal(); }),
        other("cloud.grid", Type::text, "\"\"", "Name of the grid; empty: `density`, or else the first float grid.",
              [](Draft& d, const Value& v) { cloudOf(d).grid = v.text; }),
        choice("cloud.procedural", {"cumulus", "stratus", "cirrus", "sphere", "slab"}, "\"cumulus\"",
               "As for `lumulus cloud`.", [](Draft& d, const Value& v) { cloudOf(d).procedural = v.text; }),
        integer("cloud.resolution", {8.0, 1024.0}, "192", "Voxels along the longest side of a procedural cloud.",
                [](Draft& d, const Value& v) { cloudOf(d).resolution = static_cast<int>(v.integer); }),
        integer("cloud.seed", seeds, "1", "Of a procedural cloud.",
                [](Draft& d, const Value& v) { cloudOf(d).seed = static_cast<std::uint64_t>(v.integer); }),
        other(
            "cloud.transform", Type::matrix, "[[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]",
            "Rows of a matrix that acts on columns (x, y, z, 1), after the grid's own transform; the last column is a "
            "shift in metres. Must be invertible. A fourth row, if given, is [0, 0, 0, 1].",
            [](Draft& d, const Value& v) { cloudOf(d).transform = v.matrix; }),
        number("cloud.density_scale", {0.0, 1e6}, "1.0", "Multiplies the values of the grid.",
               [](Draft& d, const Value& v) { cloudOf(d).densityScale = v.number; }),
        number("cloud.extinction", {0.0, 1e6}, "0.08",
               "1/m at density 1: the extinction coefficient is extinction · density_scale · value.",
               [](Draft& d, const Value& v) { cloudOf(d).extinction = v.number; }),
        rgb("cloud.albedo", unit, "1.0", "Share of the extinction that is scattering.",
            [](Draft& d, const Value& v) { cloudOf(d).albedo = v.vector; }),
    };
}

std::vector<Key> phaseKeys() {
    return {
        choice("cloud.phase.model", {"henyey-greenstein", "hg", "schlick", "rayleigh", "hazy", "murky", "droplet"},
               "\"henyey-greenstein\"",
               "`hg` is short for `henyey-greenstein`; `schlick` approximates it; `hazy` and `murky` are Nishita's "
               "(1987); `droplet` is the fit of Jendersie and d'Eon (2023) for fog and clouds.",
               [](Draft& d, const Value& v) { cloudOf(d).phase.model = phaseModels.at(v.choice); }),
        number("cloud.phase.g", {-1.0, 1.0, true, true}, "0.85",
               "Mean cosine of scattering, for `henyey-greenstein` and `schlick`.",
               [](Draft& d, const Value& v) { cloudOf(d).phase.g = v.number; }),
        number("cloud.phase.droplet_diameter", {5.0, 50.0}, "20.0", "Micrometres, for `droplet`.",
               [](Draft& d, const Value& v) { cloudOf(d).phase.dropletDiameter = v.number; }),
    };
}

std::vector<Key> preparationKeys() {
    return {
        integer("preparation.samples", {1.0, 1e8}, "20000",
                "Point samples of the density's gradient, from which the cloud is divided into leaves.",
                [](Draft& d, const Value& v) { d.scene.preparation.samples = static_cast<int>(v.integer); }),
        number("preparation.density_threshold", unit, "0.1",
               "Share of the largest density: a leaf whose densities differ by less is not split further.",
               [](Draft& d, const Value& v) { d.scene.preparation.densityThreshold = v.number; }),
        number("preparation.influence_radius", {0.0, 1e9, true}, "(from the mean distance of samples)",
               "Metres: space farther from every sample is split off.",
               [](Draft& d, const Value& v) { d.scene.preparation.influenceRadius = v.number; }),
        integer("preparation.max_leaves", {1.0, 16777216.0}, "32768", "Limit of leaves.",
                [](Draft& d, const Value& v) { d.scene.preparation.maxLeaves = static_cast<int>(v.integer); }),
        number(
            "preparation.memory_budget", {1.0, 1048576.0}, "512.0",
            "MiB for the density volumes of all clouds on the GPU. Grids that need more are averaged to larger voxels.",
            [](Draft& d, const Value& v) { d.scene.preparation.memoryBudget = v.number; }),
    };
}

std::vector<Key> photonMapAndDrawKeys() {
    return {
        integer("photon_map.photons", {1.0, 1099511627776.0}, "2000000", "In all generations together.",
                [](Draft& d, const Value& v) { d.scene.photonMap.photons = v.integer; }),
        integer("photon_map.generations", {1.0, 4096.0}, "20", "Generations of photons in the map.",
                [](Draft& d, const Value& v) { d.scene.photonMap.generations = static_cast<int>(v.integer); }),
        integer("photon_map.first_generation", {0.0, 4294963200.0}, "0",
                "Number of the first generation: an independent picture with the same seed.",
                [](Draft& d, const Value& v) { d.scene.photonMap.firstGeneration = v.integer; }),
        integer("photon_map.bands", {1.0, 8.0}, "4",
                "Bands of spherical harmonics in a collector: bands² coefficients.",
                [](Draft& d, const Value& v) { d.scene.photonMap.bands = static_cast<int>(v.integer); }),
        number("photon_map.forward_cut", {0.0, 90.0}, "15.0",
               "Degrees: scattering by less does not count as a turn. 0 turns the truncation off.",
               [](Draft& d, const Value& v) { d.scene.photonMap.forwardCut = v.number; }),
        choice("photon_map.majorant", {"auto", "local", "global"}, "\"auto\"",
               "Bound of the extinction that photons are tracked with; `auto` computes which costs fewer steps.",
               [](Draft& d, const Value& v) { d.scene.photonMap.majorant = majorants.at(v.choice); }),
        number("photon_map.memory_budget", {1.0, 1048576.0}, "1024.0",
               "MiB on the GPU for the light that collectors hold. What needs more is refused.",
               [](Draft& d, const Value& v) { d.scene.photonMap.memoryBudget = v.number; }),
        integer("photon_map.seed", seeds, "1", "Of the photons' random numbers.",
                [](Draft& d, const Value& v) { d.scene.photonMap.seed = static_cast<std::uint64_t>(v.integer); }),
        choice("draw.mode", {"march", "billboards"}, "\"march\"", "How the view is drawn.",
               [](Draft& d, const Value& v) { d.scene.draw.mode = drawModes.at(v.choice); }),
        number("draw.tolerance", {0.0, 1.0}, "0.2",
               "Pixels between every fourth one are interpolated where light, transmittance and depth bend by less "
               "than this part from one to the next and voxels are larger than pixels; elsewhere every second one is "
               "drawn, and "
               "all where it bends still. 0 draws all.",
               [](Draft& d, const Value& v) { d.scene.draw.tolerance = v.number; }),
    };
}

std::vector<Key> fogKeys() {
    return {
        choice("fog.filter", {"scatter", "masked", "naive", "gather"}, "\"scatter\"",
               "How light that the fog scatters is spread over the picture: `scatter` conserves energy, `masked` (Elek "
               "2013, Iser 2017) and `naive` gather from blurred copies, `gather` is the exact and slow reference.",
               [](Draft& d, const Value& v) { d.scene.fog.filter = fogFilters.at(v.choice); }),
        integer("fog.filter_size", {2.0, 6.0}, "4", "Taps across of the filter between two levels: 2, 4 or 6.",
                [](Draft& d, const Value& v) { d.scene.fog.filterSize = static_cast<int>(v.integer); }),
        choice("fog.fetch", {"bilinear", "linear-bicubic", "cubic-bicubic"}, "\"linear-bicubic\"",
               "How a level is read between its pixels; `scatter` has linear and cubic only.",
               [](Draft& d, const Value& v) { d.scene.fog.fetch = fogFetches.at(v.choice); }),
        integer("fog.depth_lookups", {0.0, 4.0}, "2",
                "For `masked`: how often the level is corrected by the blurred distance of the level found before.",
                [](Draft& d, const Value& v) { d.scene.fog.depthLookups = static_cast<int>(v.integer); }),
        number("fog.sky_distance", {0.0, 1e9, true}, "100000.0",
               "Metres: what is farther, the sky too, is seen through this much of the fog.",
               [](Draft& d, const Value& v) { d.scene.fog.skyDistance = v.number; }),
        other("fog.inscattering", Type::boolean, "true",
              "For `lumulus reference`: with `false` the fog scatters the light of surfaces and clouds alone, as the "
              "filter does, and none that comes to it straight from sun or sky.",
              [](Draft& d, const Value& v) { d.scene.fog.inscattering = v.boolean; }),
        choice("fog.depth", {"distance", "planar", "zbuffer"}, "\"distance\"",
               "What the depth of `lumulus composite` is: metres along the ray, metres along the view's axis, or a "
               "z-buffer from 0 at `near` to 1 at `far`.",
               [](Draft& d, const Value& v) { d.scene.fog.depth = fogDepths.at(v.choice); }),
        number("fog.near", {0.0, 1e9, true}, "0.1",
               "Metres: where the z-buffer is 0. A reversed one has it beyond `far`.",
               [](Draft& d, const Value& v) { d.scene.fog.near = v.number; }),
        number("fog.far", {0.0, 1e9, true}, "1000.0", "Metres: where the z-buffer is 1.",
               [](Draft& d, const Value& v) { d.scene.fog.far = v.number; }),
        number("fog.separation.strength", unit, "1.0",
               "For `masked`: how much of the light of bright near pixels is filtered apart. 0 turns it off.",
               [](Draft& d, const Value& v) { d.scene.fog.separation = v.number; }),
        number("fog.separation.luminance", {0.0, 1e9, true}, "3.0",
               "W/(m² sr): scattered light above it is separated, all of it at twice that.",
               [](Draft& d, const Value& v) { d.scene.fog.separationLuminance = v.number; }),
        number("fog.separation.spread", {0.0, 1e3, true}, "0.05",
               "Share of the picture's height: light of a larger spread is not separated, all of it below half that.",
               [](Draft& d, const Value& v) { d.scene.fog.separationSpread = v.number; }),
        number("fog.separation.level", unit, "0.7", "Share of the level at which separated light is read.",
               [](Draft& d, const Value& v) { d.scene.fog.separationLevel = v.number; }),
    };
}

std::vector<Key> mediumKeys() {
    return {
        choice("fog.media.kind", {"homogeneous", "exponential", "sphere"}, "\"homogeneous\"",
               "Relative density ϱ at x: 1; exp(-falloff ⟨x - offset, direction⟩); 1 - (r/radius)², r from the center "
               "within the "
               "radius. All media add up.",
               [](Draft& d, const Value& v) { mediumOf(d).kind = mediumKinds.at(v.choice); }),
        rgb("fog.media.scattering", coefficients, "0.0", "Scattering coefficient where ϱ is 1, 1/m.",
            [](Draft& d, const Value& v) { mediumOf(d).scattering = v.vector; }),
        rgb("fog.media.absorption", coefficients, "0.0", "Absorption coefficient where ϱ is 1, 1/m.",
            [](Draft& d, const Value& v) { mediumOf(d).absorption = v.vector; }),
        number(
            "fog.media.visibility", {0.0, 1e9, true}, "(scattering and absorption instead)",
            "Metres: a medium that only scatters, 3.912/visibility where ϱ is 1 (Koschmieder: 2 % of the contrast is "
            "left at that distance). Instead of `scattering` and `absorption`.",
            [](Draft& d, const Value& v) { mediumOf(d).scattering = glm::dvec3(koschmieder / v.number); }),
        number("fog.media.g", {-1.0, 1.0, true, true}, "0.9", "Mean cosine of scattering.",
               [](Draft& d, const Value& v) { mediumOf(d).g = v.number; }),
        rgb("fog.media.emission", light, "0.0", "Radiance gained per metre where ϱ is 1, W/(m³ sr).",
            [](Draft& d, const Value& v) { mediumOf(d).emission = v.vector; }),
        number("fog.media.falloff", {0.0, 1e3}, "0.01", "1/m, for `exponential`.",
               [](Draft& d, const Value& v) { mediumOf(d).falloff = v.number; }),
        other("fog.media.direction", Type::vector, "[0.0, 1.0, 0.0]",
              "For `exponential`: towards thinner fog, any length.",
              [](Draft& d, const Value& v) { mediumOf(d).direction = v.vector; }),
        other("fog.media.offset", Type::vector, "[0.0, 0.0, 0.0]", "For `exponential`: a point where ϱ is 1, metres.",
              [](Draft& d, const Value& v) { mediumOf(d).offset = v.vector; }),
        other("fog.media.center", Type::vector, "[0.0, 0.0, 0.0]", "Of a `sphere`, metres.",
              [](Draft& d, const Value& v) { mediumOf(d).center = v.vector; }),
        number("fog.media.radius", {0.0, 1e9, true}, "100.0", "Of a `sphere`, metres.",
               [](Draft& d, const Value& v) { mediumOf(d).radius = v.number; }),
    };
}

std::vector<Key> surfaceKeys() {
    return {
        choice("surface.kind", {"plane", "sphere", "disc"}, "\"plane\"", "A plane has no end.",
               [](Draft& d, const Value& v) { surfaceOf(d).kind = surfaceKinds.at(v.choice); }),
        other("surface.position", Type::vector, "[0.0, 0.0, 0.0]",
              "Metres: a point of the plane, the middle of a sphere or disc.",
              [](Draft& d, const Value& v) { surfaceOf(d).position = v.vector; }),
        other("surface.normal", Type::vector, "[0.0, 1.0, 0.0]", "Of a plane or disc, any length.",
              [](Draft& d, const Value& v) { surfaceOf(d).normal = v.vector; }),
        number("surface.radius", {0.0, 1e9, true}, "100.0", "Of a sphere or disc, metres.",
               [](Draft& d, const Value& v) { surfaceOf(d).radius = v.number; }),
        rgb("surface.albedo", unit, "0.5",
            "Share of the light that is reflected, the same in all directions (Lambert).",
            [](Draft& d, const Value& v) { surfaceOf(d).albedo = v.vector; }),
        rgb("surface.emission", light, "0.0", "Radiance that it gives off, on both sides, W/(m² sr) per channel.",
            [](Draft& d, const Value& v) { surfaceOf(d).emission = v.vector; }),
    };
}

}  // namespace

const std::vector<Key>& schema() {
    static const std::vector<Key> all = [] {
        std::vector<Key> keys;
        for (const auto& part : {imageAndCameraKeys(), sunAndSkyKeys(), cloudKeys(), phaseKeys(), preparationKeys(),
                                 photonMapAndDrawKeys(), fogKeys(), mediumKeys(), surfaceKeys()}) {
            keys.insert(keys.end(), part.begin(), part.end());
        }
        return keys;
    }();
    return all;
}

}  // namespace lumulus::scene
