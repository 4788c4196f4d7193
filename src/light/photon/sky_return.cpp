#include "light/photon/sky_return.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/sky_return.h"

namespace lumulus::photon {

namespace {

using std::numbers::pi;

constexpr int rows = shared::SKY_RETURN_ROWS, columns = shared::SKY_RETURN_COLUMNS, depths = shared::SKY_RETURN_DEPTHS;

/// Number of the term l, m ≥ 0 of a spherical harmonic.
std::size_t term(int l, int m) {
    return static_cast<std::size_t>(l * (l + 1) / 2 + m);
}

/// P_l^m of orthonormal harmonics at an angle to the zenith, by term.
std::vector<double> legendre(int bands, double down) {
    std::vector<double> values(term(bands, 0));
    const double x = std::cos(down), sine = std::sin(down);
    for (int m = 0; m < bands; ++m) {  // upwards in l, as shared/sh.h
        values[term(m, m)] =
            m == 0 ? std::sqrt(0.25 / pi) : std::sqrt(1.0 + 0.5 / m) * sine * values[term(m - 1, m - 1)];
        for (int l = m + 1; l < bands; ++l) {
            const double a = std::sqrt((4.0 * l * l - 1.0) / (l * l - m * m)),
                         b = std::sqrt(((l - 1.0) * (l - 1.0) - m * m) / (4.0 * (l - 1.0) * (l - 1.0) - 1.0));
            values[term(l, m)] = a * (x * values[term(l - 1, m)] - (l > m + 1 ? b * values[term(l - 2, m)] : 0.0));
        }
    }
    return values;
}

/// The mean of the same over a row of cells, between two angles.
std::vector<double> legendreOver(int bands, double low, double high) {
    constexpr int parts = 8;
    std::vector<double> mean(term(bands, 0), 0.0);
    for (int part = 0; part < parts; ++part) {
        const double share = (part + 0.5) / parts;
        const std::vector<double> values =
            legendre(bands, std::acos((1.0 - share) * std::cos(low) + share * std::cos(high)));
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += values[i] / parts;
    }
    return mean;
}

/// Cosine and sine of the parts of a circle.
std::vector<glm::dvec2> turnsOf(int parts) {
    std::vector<glm::dvec2> turns;
    for (int i = 0; i < parts; ++i) turns.emplace_back(std::cos(2.0 * pi * i / parts), std::sin(2.0 * pi * i / parts));
    return turns;
}

/// Coefficients of cosine and sine of the azimuth, by term.
struct Harmonics {
    std::vector<glm::dvec3> cosines, sines;
};

/// Bands that are returned at most: those above are sent back less, and are finer than the cells of a sky.
constexpr int mostBands = 48;

/// Bands that collectors hand on.
int bandsOf(const phase::ScatteringMedium& medium) {
    const std::vector<float>& moments = medium.tables.bandMoments;
    int bands = static_cast<int>(moments.size());
    while (bands > 0 && moments[static_cast<std::size_t>(bands) - 1] == 0.0F) --bands;
    return bands;
}

/// Radiance of each cell of the sky [W/(m² sr)], from the table that photons start by: what a photon weighs times how
/// often one starts there. In fog the mean over the cloud's heights.
std::vector<glm::dvec3> radianceOf(const AirLight& air) {
    const std::size_t count = air.cells.size();
    std::vector<double> starts(count, 0.0);  // probability of each cell, times their number
    for (std::size_t i = 0; i < count; ++i) {
        const shared::SkyCell& cell = air.cells[i];
        starts[i] += static_cast<double>(cell.keep);
        starts[cell.other] += 1.0 - static_cast<double>(cell.keep);
    }
    std::vector<glm::dvec3> radiance;
    for (std::size_t i = 0; i < count; ++i) {
        glm::dvec3 weight = 0.5 * (glm::dvec3(air.cells[i].low) + glm::dvec3(air.cells[i].high));
        for (int height = 0; !air.fogSky.empty() && height < shared::FOG_SKY_HEIGHTS; ++height)
            weight += glm::dvec3(air.fogSky[static_cast<std::size_t>(height) * count + i]) /
                      static_cast<double>(shared::FOG_SKY_HEIGHTS);
        const double angle = air.skyFrame.solidAngle(static_cast<int>(i)) * static_cast<double>(count);
        radiance.push_back(weight * air.skyFlux * (starts[i] / angle));
    }
    return radiance;
}

/// Of a sky by cell.
Harmonics harmonicsOf(const AirLight& air, int bands) {
    const glm::ivec2 size = air.skyFrame.size;
    const std::vector<glm::dvec3> radiance = radianceOf(air);
    const std::vector<glm::dvec2> turns = turnsOf(2 * size.x);
    Harmonics made{std::vector<glm::dvec3>(term(bands, 0), glm::dvec3(0.0)), {}};
    made.sines = made.cosines;
    for (int row = 0; row < size.y; ++row) {
        const double low = pi * row / size.y, high = pi * (row + 1) / size.y;
        const std::vector<double> values = legendreOver(bands, low, high);
        const double angle = air.skyFrame.solidAngle(row * size.x);
        for (int m = 0; m < bands; ++m) {
            glm::dvec3 cosine(0.0), sine(0.0);
            for (int column = 0; column < size.x; ++column) {
                const glm::dvec3& light = radiance[static_cast<std::size_t>(row * size.x + column)];
                const glm::dvec2& turn = turns[static_cast<std::size_t>(m * (2 * column + 1) % (2 * size.x))];
                cosine += light * turn.x;
                sine += light * turn.y;
            }
            for (int l = m; l < bands; ++l) {
                made.cosines[term(l, m)] += (angle * values[term(l, m)]) * cosine;
                made.sines[term(l, m)] += (angle * values[term(l, m)]) * sine;
            }
        }
    }
    return made;
}

/// What a layer of this optical depth, lit from both sides along a line by a band of the sky, sends along it beyond
/// what comes straight through. `share`: of the light that is sent back at each scattering.
double returned(double share, double depth, bool odd) {
    const double root = std::sqrt(std::max(0.0, 1.0 - share * share)), steps = std::min(root * depth, 40.0);
    const double reflected = root < 1e-6 ? depth / (1.0 + depth) : share * std::tanh(steps) / (root + std::tanh(steps));
    const double passed = root < 1e-6 ? 1.0 / (1.0 + depth) : root / (root * std::cosh(steps) + std::sinh(steps));
    return (odd ? -reflected : reflected) + passed - std::exp(-depth);
}

}  // namespace

glm::ivec3 SkyReturn::size() {
    return {columns + 1, rows, depths};
}

bool returnsSky(const phase::ScatteringMedium& medium) {
    return !medium.tables.axisTable.empty();
}

SkyReturn makeSkyReturn(const AirLight& air, const phase::ScatteringMedium& medium) {
    const int all = std::min({mostBands, air.skyFrame.size.y, air.skyFrame.size.x / 2});
    const int bands = bandsOf(medium);
    const double g = std::abs(static_cast<double>(medium.tables.g));  // of Schlick's, which is made like the other
    const Harmonics sky = harmonicsOf(air, all);
    SkyReturn made{air.skyFrame.axes, {}};
    made.texels.resize(static_cast<std::size_t>((columns + 1) * rows * depths));
    std::vector<std::vector<double>> atRows;
    const std::vector<glm::dvec2> turns = turnsOf(columns);
    for (int row = 0; row < rows; ++row) atRows.push_back(legendre(all, pi * (row + 0.5) / rows));
    tbb::parallel_for(0, depths * rows, [&](int task) {
        const int level = task / rows, row = task % rows;
        const double x = level / (depths - 1.0), depth = x < 1.0 ? x / (1.0 - x) : 1e6;
        const std::vector<double>& values = atRows[static_cast<std::size_t>(row)];
        std::vector<glm::dvec3> cosines(static_cast<std::size_t>(all), glm::dvec3(0.0)), sines = cosines;
        for (int l = bands; l < all; ++l) {
            glm::dvec3 share;
            for (int c = 0; c < 3; ++c) share[c] = returned(medium.albedo[c] * std::pow(g, l), depth, l % 2 != 0);
            for (int m = 0; m <= l; ++m) {
                const double twice = m == 0 ? 1.0 : 2.0;
                cosines[static_cast<std::size_t>(m)] += twice * values[term(l, m)] * share * sky.cosines[term(l, m)];
                sines[static_cast<std::size_t>(m)] += twice * values[term(l, m)] * share * sky.sines[term(l, m)];
            }
        }
        for (int column = 0; column <= columns; ++column) {
            glm::dvec3 sum(0.0);
            for (int m = 0; m < all; ++m) {
                const glm::dvec2& turn = turns[static_cast<std::size_t>(m * column % columns)];
                sum += turn.x * cosines[static_cast<std::size_t>(m)] + turn.y * sines[static_cast<std::size_t>(m)];
            }
            made.texels[static_cast<std::size_t>(task * (columns + 1) + column)] = glm::vec4(glm::vec3(sum), 1.0F);
        }
    });
    return made;
}

}  // namespace lumulus::photon
