#include <array>

#include "scene/schema.h"

namespace lumulus::scene {
namespace {

using Setter = void (*)(Draft&, const Value&);
using Text = std::string_view;

constexpr Range unit{0.0, 1.0};
constexpr Range light{0.0, 1e9};
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
    return d.scene.clouds.at(d.cloud);
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
        other("camera.position", Type::vector, "(placed so that the cloud fills the picture)", "Metres.",
              [](Draft& d, const Value& v) { d.scene.camera.position = v.vector; }),
        other("camera.target", Type::vector, "(the middle of the cloud)", "The point looked at, metres.",
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
        number("preparation.memory_budget", {1.0, 1048576.0}, "512.0", "MiB for the density volume on the GPU.",
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
    };
}

}  // namespace

const std::vector<Key>& schema() {
    static const std::vector<Key> all = [] {
        std::vector<Key> keys;
        for (const auto& part : {imageAndCameraKeys(), sunAndSkyKeys(), cloudKeys(), phaseKeys(), preparationKeys(),
                                 photonMapAndDrawKeys()}) {
            keys.insert(keys.end(), part.begin(), part.end());
        }
        return keys;
    }();
    return all;
}

}  // namespace lumulus::scene
