// Four wavelengths and one matrix against 18 wavelengths (METHODS-sky-clouds-motion.md, section 1).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "sky/atmosphere.h"

namespace lumulus::sky {
namespace {

using glm::dvec3;

constexpr std::size_t bands = 18;  // of 20 nm, from 400 to 740 nm

struct Band {
    double sunlight;  // above the air [W/(m² nm)], ASTM G173, means of 10 nm weighted 1, 2, 1
    double ozone;     // absorption cross section [m²] (Serdyuchenko 2014, 233 K, as Bruneton 2017 gives it)
    dvec3 observer;   // CIE 1931, 2°
};

// clang-format off
constexpr std::array<Band, bands> spectrum{{
    {1.58303, 1.527e-27, {0.01431, 0.000396, 0.06785}}, {1.68013, 5.520e-27, {0.13438, 0.0040, 0.6456}},
    {1.86781, 1.582e-26, {0.34828, 0.0230, 1.74706}},   {2.02443, 3.669e-26, {0.2908, 0.0600, 1.6692}},
    {1.96194, 7.752e-26, {0.09564, 0.13902, 0.81295}},  {1.90540, 1.480e-25, {0.0049, 0.3230, 0.2720}},
    {1.86498, 2.139e-25, {0.06327, 0.7100, 0.07825}},   {1.86162, 3.091e-25, {0.2904, 0.9540, 0.0203}},
    {1.83828, 4.266e-25, {0.5945, 0.9950, 0.0039}},     {1.81137, 4.398e-25, {0.9163, 0.8700, 0.00165}},
    {1.74617, 5.019e-25, {1.0622, 0.6310, 0.0008}},     {1.67673, 3.740e-25, {0.85445, 0.3810, 0.00019}},
    {1.59439, 2.662e-25, {0.4479, 0.1750, 0.00002}},    {1.53630, 1.852e-25, {0.1649, 0.0610, 0.0}},
    {1.47688, 1.209e-25, {0.04677, 0.0170, 0.0}},       {1.40908, 7.455e-26, {0.011359, 0.004102, 0.0}},
    {1.34145, 5.105e-26, {0.0029, 0.001047, 0.0}},      {1.28550, 4.228e-26, {0.00069, 0.000249, 0.0}},
}};
// clang-format on

double wavelengthOf(std::size_t band) {
    return 400.0 + 20.0 * static_cast<double>(band);
}

/// Linear Rec. 709 [W/m²] of a transfer by band, sunlight 1.
dvec3 rgbOf(const std::array<double, bands>& transfer) {
    dvec3 xyz(0.0);
    for (std::size_t i = 0; i < bands; ++i) xyz += 20.0 * spectrum[i].sunlight * transfer[i] * spectrum[i].observer;
    return {3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z, -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
            0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
}

/// Air at four of the bands from `first` on; beyond the last one it is repeated.
Air airAt(const scene::Sky& sky, std::size_t first) {
    constexpr double peakMolecules = 300.0 * 2.687e20 / 15e3;  // of ozone [1/m³]: 300 DU in a tent of 15 km
    Air air = airOf(sky);
    const double aerosolAlbedo = air.aerosolScattering[0] / air.aerosolExtinction[0];
    for (int i = 0; i < 4; ++i) {
        const std::size_t band = std::min(first + static_cast<std::size_t>(i), bands - 1);
        const double wavelength = wavelengthOf(band);
        air.wavelengths[i] = wavelength;
        air.molecules[i] = moleculeDepth(wavelength) / 8000.0;
        air.aerosolExtinction[i] = sky.aerosolDepth / 1200.0 * std::pow(wavelength / 500.0, -sky.angstrom);
        air.ozone[i] = peakMolecules * spectrum[band].ozone;
    }
    air.aerosolScattering = aerosolAlbedo * air.aerosolExtinction;
    return air;
}

class ColourMatrix : public testing::Test {
  protected:
    /// The spectrum that `seen` finds in an atmosphere, through the matrix against all bands: the root mean square of
    /// the channels' differences over the luminance.
    template <class Seen>
    double errorOf(const Seen& seen) const {
        std::array<double, bands> transfer{};
        for (std::size_t i = 0; i < bands; ++i) transfer[i] = seen(fine_[i / 4])[static_cast<int>(i % 4)];
        const dvec3 exact = rgbOf(transfer), found = four_.air().rgb(seen(four_));
        const dvec3 off = found - exact;
        return std::sqrt(glm::dot(off, off) / 3.0) / glm::dot(exact, {0.2126, 0.7152, 0.0722});
    }

    const scene::Sky sky_;
    const Atmosphere four_{sky_};
    const std::vector<Atmosphere> fine_ = [this] {
        std::vector<Atmosphere> made;
        for (std::size_t first = 0; first < bands; first += 4) made.emplace_back(airAt(sky_, first), 0.0, 0.53);
        return made;
    }();
};

/// Above the air, and from a high sun to twilight in all directions: 1 % on average and 7 % at most.
TEST_F(ColourMatrix, SkyAndSunHaveTheirColours) {
    std::array<double, bands> all{};
    all.fill(1.0);
    EXPECT_NEAR(photometric(rgbOf(all)), 132.1e3, 0.01 * 132.1e3);
    EXPECT_LT(errorOf([](const Atmosphere& air) { return air.sunTransmittance(1e5, 1.0); }), 0.01);
    const dvec3 eye(0.0, 2.0, 0.0);
    double sum = 0.0, worst = 0.0;
    int count = 0;
    const auto note = [&](double error) {
        sum += error;
        worst = std::max(worst, error);
        ++count;
    };
    for (const double elevation : {89.0, 60.0, 30.0, 20.0, 10.0, 5.0, 2.0, 0.0, -2.0, -4.0, -6.0}) {
        const dvec3 toSun = scene::skyDirection(0.0, elevation);
        if (elevation >= 0.0) note(errorOf([&](const Atmosphere& air) { return air.sunTransmittance(2.0, toSun.y); }));
        for (const double up : {0.5, 5.0, 20.0, 55.0}) {
            for (const double azimuth : {0.0, 60.0, 120.0, 180.0}) {
                const dvec3 direction = scene::skyDirection(azimuth, up);
                note(errorOf([&](const Atmosphere& air) {
                    return air.sky(air.at(eye, direction, toSun)).light(air.air(), glm::dot(direction, toSun));
                }));
            }
        }
    }
    RecordProperty("spectra", count);
    EXPECT_GE(count, 180);
    EXPECT_LT(sum / count, 0.01);
    EXPECT_LT(worst, 0.07);
    std::printf("%d spectra: %.4f on average, %.4f at most\n", count, sum / count, worst);
}

}  // namespace
}  // namespace lumulus::sky
