// How rough the rim of a procedural cumulus is, beside clouds of a large-eddy simulation.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <vector>

#include "support/rico.h"
#include "vdb/noise.h"
#include "vdb/procedural.h"

namespace lumulus {
namespace {

constexpr double pi = 3.14159265358979323846;
/// Of the rims in the large-eddy simulation RICO, 122 × 106 × 39 cells, from 420 to 120 m.
constexpr double ricoSlope = 1.42;

/// Powers over wavelength: bins of a third of an octave, from 4 m on.
class Spectrum {
  public:
    static constexpr int bins = 27;
    static double wavelengthOf(int bin) { return 4.0 * std::exp2((bin + 0.5) / 3.0); }

    /// Adds the power spectrum of a line of samples, `spacing` metres apart.
    void add(const std::vector<double>& line, double spacing) {
        const std::size_t n = line.size();
        std::vector<std::complex<double>> roots(n);
        for (std::size_t i = 0; i < n; ++i)
            roots[i] = std::polar(1.0, -2.0 * pi * static_cast<double>(i) / static_cast<double>(n));
        for (std::size_t k = 1; k <= n / 2; ++k) {
            std::complex<double> sum = 0.0;
            for (std::size_t i = 0; i < n; ++i)
                if (line[i] != 0.0) sum += line[i] * roots[k * i % n];
            const double wavelength = static_cast<double>(n) * spacing / static_cast<double>(k);
            const int bin = static_cast<int>(std::floor(3.0 * std::log2(wavelength / 4.0)));
            if (bin < 0 || bin >= bins) continue;
            // power per wave number, whatever the length of the line
            power_[static_cast<std::size_t>(bin)] += std::norm(sum) * spacing / static_cast<double>(n);
            count_[static_cast<std::size_t>(bin)] += 1.0;
        }
    }

    /// The exponent β of power ∝ (wave number)^-β between two wavelengths, by least squares.
    double slope(double shortest, double longest) const {
        double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
        for (std::size_t bin = 0; bin < bins; ++bin) {
            const double wavelength = wavelengthOf(static_cast<int>(bin));
            if (count_[bin] == 0.0 || wavelength < shortest || wavelength > longest) continue;
            const double u = std::log(wavelength), v = std::log(power_[bin] / count_[bin]);
            n += 1.0;
            x += u;
            y += v;
            xx += u * u;
            xy += u * v;
        }
        return (n * xy - x * y) / (n * xx - x * x);
    }

  private:
    std::array<double, bins> power_{}, count_{};
};

/// Lines along x through the upper part of a cloud, from the heights `low` to `high` in metres above its lowest
/// density.
Spectrum spectrumOf(const vdb::Volume& volume, int step, double share) {
    int first = volume.size.y, last = 0;
    for (int y = 0; y < volume.size.y; ++y)
        for (int z = 0; z < volume.size.z; ++z)
            for (int x = 0; x < volume.size.x; ++x)
                if (volume.density[volume.index(x, y, z)] > 0.0F) first = std::min(first, y), last = std::max(last, y);
    Spectrum spectrum;
    for (int y = first + static_cast<int>(share * (last - first)); y <= last; y += step) {
        for (int z = 0; z < volume.size.z; z += step) {
            std::vector<double> line;
            double sum = 0.0;
            for (int x = 0; x < volume.size.x; ++x) {
                // a cloud or none: what remains is the shape of the rim
                line.push_back(volume.density[volume.index(x, y, z)] > 0.1F * volume.maximum ? 1.0 : 0.0);
                sum += line.back();
            }
            if (sum > 0.0) spectrum.add(line, volume.toWorld.linear[0][0]);
        }
    }
    return spectrum;
}

TEST(RimSpectrum, OfAStepIsThatOfEdges) {
    Spectrum spectrum;
    vdb::RandomStream random(1);
    for (int i = 0; i < 300; ++i) {
        std::vector<double> line(512, 0.0);
        const int begin = static_cast<int>(random.uniform(20.0F, 200.0F)),
                  end = static_cast<int>(random.uniform(260.0F, 480.0F));
        for (int x = begin; x < end; ++x) line[static_cast<std::size_t>(x)] = 1.0;
        spectrum.add(line, 2.0);
    }
    EXPECT_NEAR(spectrum.slope(12.0, 200.0), 2.0, 0.1);  // one edge: power falls with the square of the wave number
}

TEST(RimSpectrum, OfACumulusIsLikeThatOfASimulation) {
    const Spectrum cumulus = spectrumOf(vdb::makeCloud({"cumulus", 500, 1}), 7, 0.3);
    const double coarse = cumulus.slope(120.0, 420.0), fine = cumulus.slope(12.0, 120.0);
    std::printf("cumulus: %.2f from 420 to 120 m, %.2f from 120 to 12 m\n", coarse, fine);
    EXPECT_LT(fine, 1.97);  // below that of a smooth rim
    EXPECT_GT(fine, 1.3);
    EXPECT_NEAR(coarse, ricoSlope, 0.35);
    // the simulated field itself, where it is among the data of the tests
    if (const auto path = test::findTestData("rico122x106x39.txt")) {
        const Spectrum rico = spectrumOf(test::readRico(*path), 1, 0.1);
        EXPECT_NEAR(rico.slope(120.0, 420.0), ricoSlope, 0.01);
    }
}

}  // namespace
}  // namespace lumulus
