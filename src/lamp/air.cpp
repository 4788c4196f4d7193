#include "lamp/air.h"

namespace lumulus::lamp {

namespace {

constexpr double moleculeHeight = 8000.0, aerosolHeight = 1200.0;  // metres, as sky::airDensity()

/// Of a coefficient at four wavelengths, that of each channel.
glm::dvec3 channels(const sky::Air& air, const sky::Spectrum& coefficient) {
    return glm::max(air.rgb(coefficient) / air.rgb(sky::Spectrum(1.0)), glm::dvec3(0.0));
}

scene::FogMedium layer(const glm::dvec3& scattering, const glm::dvec3& absorption, double g, double scaleHeight,
                       double groundHeight) {
    scene::FogMedium medium;
    medium.kind = scene::MediumKind::exponential;
    medium.scattering = scattering;
    medium.absorption = absorption;
    medium.g = g;
    medium.falloff = 1.0 / scaleHeight;
    medium.offset = {0.0, groundHeight, 0.0};
    medium.bottom = groundHeight;
    return medium;
}

}  // namespace

scene::Fog withAir(scene::Fog fog, const sky::Air& air, double groundHeight) {
    const glm::dvec3 aerosol = channels(air, air.aerosolScattering);
    fog.media.push_back(layer(channels(air, air.molecules), glm::dvec3(0.0), 0.0, moleculeHeight, groundHeight));
    fog.media.push_back(layer(aerosol, glm::max(channels(air, air.aerosolExtinction) - aerosol, glm::dvec3(0.0)),
                              air.aerosolMoments()[1], aerosolHeight, groundHeight));
    return fog;
}

}  // namespace lumulus::lamp
