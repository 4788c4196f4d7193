#include <array>

#include "scene/aerosol.h"
#include "scene/key_rows.h"

namespace lumulus::scene {
namespace {

constexpr Range heights{-1e6, 1e6};

constexpr std::array fogFilters{FogFilter::scatter, FogFilter::masked, FogFilter::naive, FogFilter::gather};
constexpr std::array fogFetches{FogFetch::bilinear, FogFetch::linearBicubic, FogFetch::cubicBicubic};
constexpr std::array fogDepths{FogDepth::distance, FogDepth::planar, FogDepth::zbuffer};
constexpr std::array mediumKinds{MediumKind::homogeneous, MediumKind::exponential, MediumKind::sphere,
                                 MediumKind::ellipsoid, MediumKind::box};

FogMedium& mediumOf(Draft& d) {
    return d.scene.fog.media.at(d.entry);
}

}  // namespace

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
        number("fog.sky_distance", {0.0, 1e9, true}, "100000.0",
               "For `lumulus composite`: distance in metres at which media without bottom and top end. The sky and "
               "everything farther is seen through this much of them.",
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
        choice("fog.media.kind", {"homogeneous", "exponential", "sphere", "ellipsoid", "box"}, "\"homogeneous\"",
               "Kind of the relative density ϱ at x: 1; exp(-falloff ⟨x - offset, direction⟩); 1 - (r/radius)² at the "
               "distance r from the center, 0 beyond the radius; 1 within an ellipsoid or a box, 0 beyond. Media add "
               "up.",
               [](Draft& d, const Value& v) { mediumOf(d).kind = mediumKinds.at(v.choice); }),
        rgb("fog.media.scattering", coefficients, "0.0", "Scattering coefficient where ϱ is 1, 1/m.",
            [](Draft& d, const Value& v) { mediumOf(d).scattering = v.vector; }),
        rgb("fog.media.absorption", coefficients, "0.0", "Absorption coefficient where ϱ is 1, 1/m.",
            [](Draft& d, const Value& v) { mediumOf(d).absorption = v.vector; }),
        number("fog.media.visibility", {0.0, 1e9, true}, "(scattering and absorption instead)",
               "Visibility in metres, instead of `scattering` and `absorption`: the extinction is 3.912/visibility "
               "where ϱ is 1 (Koschmieder: 2 % of the contrast is left at that distance). The medium only scatters, "
               "unless it has an `albedo` or an `aerosol`.",
               [](Draft& d, const Value& v) { mediumOf(d).scattering = glm::dvec3(koschmieder / v.number); }),
        rgb("fog.media.albedo", unit, "1.0", "With `visibility`: share of the extinction that scatters.",
            [](Draft& d, const Value& v) { d.fogAlbedos[d.entry] = v.vector; }),
        choice("fog.media.aerosol", aerosolNames(), "(none: it scatters all colours alike)",
               "Particles of the medium, whose visibility is at 550 nm: they give the single-scattering albedo, `g` "
               "and the colour (docs/fog.md).",
               [](Draft& d, const Value& v) { d.aerosols[d.entry] = v.choice; }),
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
        number("fog.media.bottom", heights, "(none, or the ground)",
               "For `homogeneous` and `exponential`: height (y in metres, above the planet's surface where the sky is "
               "an atmosphere) below which the medium ends. A ground ends it too. Under a sun or a sky the fog above "
               "any point must have a finite optical depth, and so must the fog below.",
               [](Draft& d, const Value& v) { mediumOf(d).bottom = v.number; }),
        number("fog.media.top", heights, "(none)", "The height above which it ends. Needs to be above the bottom.",
               [](Draft& d, const Value& v) { mediumOf(d).top = v.number; }),
        other("fog.media.center", Type::vector, "[0.0, 0.0, 0.0]",
              "For `sphere`, `ellipsoid` and `box`: its center in metres.",
              [](Draft& d, const Value& v) { mediumOf(d).center = v.vector; }),
        number("fog.media.radius", {0.0, 1e9, true}, "100.0", "For `sphere`: its radius in metres.",
               [](Draft& d, const Value& v) { mediumOf(d).radius = v.number; }),
        other("fog.media.half_size", Type::vector, "[100.0, 100.0, 100.0]",
              "For `ellipsoid` and `box`: distances in metres from its center to its faces along x, y and z.",
              [](Draft& d, const Value& v) { mediumOf(d).halfSize = v.vector; }),
    };
}

}  // namespace lumulus::scene
