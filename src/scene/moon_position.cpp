#include <array>
#include <cmath>

#include "scene/ephemeris.h"

namespace lumulus::scene {
namespace {

/// A term of a series: multiples of the angles D, M, M', F and an amplitude.
struct Term {
    int elongation, sun, moon, node;
    double amplitude;
};

// Meeus 1998, tables 47.A and 47.B, without the terms that are too small to matter
constexpr std::array<Term, 28> longitudes{{
    // degrees, of the sine
    {0, 0, 1, 0, 6.288774},  {2, 0, -1, 0, 1.274027},  {2, 0, 0, 0, 0.658314},   {0, 0, 2, 0, 0.213618},
    {0, 1, 0, 0, -0.185116}, {0, 0, 0, 2, -0.114332},  {2, 0, -2, 0, 0.058793},  {2, -1, -1, 0, 0.057066},
    {2, 0, 1, 0, 0.053322},  {2, -1, 0, 0, 0.045758},  {0, 1, -1, 0, -0.040923}, {1, 0, 0, 0, -0.034720},
    {0, 1, 1, 0, -0.030383}, {2, 0, 0, -2, 0.015327},  {0, 0, 1, 2, -0.012528},  {0, 0, 1, -2, 0.010980},
    {4, 0, -1, 0, 0.010675}, {0, 0, 3, 0, 0.010034},   {4, 0, -2, 0, 0.008548},  {2, 1, -1, 0, -0.007888},
    {2, 1, 0, 0, -0.006766}, {1, 0, -1, 0, -0.005163}, {1, 1, 0, 0, 0.004987},   {2, -1, 1, 0, 0.004036},
    {2, 0, 2, 0, 0.003994},  {4, 0, 0, 0, 0.003861},   {2, 0, -3, 0, 0.003665},  {0, 1, -2, 0, -0.002689},
}};
constexpr std::array<Term, 19> latitudes{{
    // degrees, of the sine
    {0, 0, 0, 1, 5.128122},    {0, 0, 1, 1, 0.280602},    {0, 0, 1, -1, 0.277693},  {2, 0, 0, -1, 0.173237},
    {2, 0, -1, 1, 0.055413},   {2, 0, -1, -1, 0.046271},  {2, 0, 0, 1, 0.032573},   {0, 0, 2, 1, 0.017198},
    {2, 0, 1, -1, 0.009266},   {0, 0, 2, -1, 0.008822},   {2, -1, 0, -1, 0.008216}, {2, 0, -2, -1, 0.004324},
    {2, 0, 1, 1, 0.004200},    {2, 1, 0, -1, -0.003359},  {2, -1, -1, 1, 0.002463}, {2, -1, 0, 1, 0.002211},
    {2, -1, -1, -1, 0.002065}, {0, 1, -1, -1, -0.001870}, {4, 0, -1, -1, 0.001828},
}};
constexpr std::array<Term, 19> distances{{
    // km, of the cosine
    {0, 0, 1, 0, -20905.355}, {2, 0, -1, 0, -3699.111}, {2, 0, 0, 0, -2955.968},  {0, 0, 2, 0, -569.925},
    {0, 1, 0, 0, 48.888},     {2, 0, -2, 0, 246.158},   {2, -1, -1, 0, -152.138}, {2, 0, 1, 0, -170.733},
    {2, -1, 0, 0, -204.586},  {0, 1, -1, 0, -129.620},  {1, 0, 0, 0, 108.743},    {0, 1, 1, 0, 104.755},
    {2, 0, 0, -2, 10.321},    {0, 0, 1, -2, 79.661},    {4, 0, -1, 0, -34.782},   {0, 0, 3, 0, -23.210},
    {4, 0, -2, 0, -21.636},   {2, 1, -1, 0, 24.208},    {2, 1, 0, 0, 30.824},
}};

}  // namespace

Ecliptic moonPosition(double centuries) {
    const double t = centuries, t2 = t * t, t3 = t2 * t, t4 = t3 * t;
    const double mean = 218.3164477 + 481267.88123421 * t - 0.0015786 * t2 + t3 / 538841.0 - t4 / 65194000.0;
    const double elongation = 297.8501921 + 445267.1114034 * t - 0.0018819 * t2 + t3 / 545868.0 - t4 / 113065000.0;
    const double sun = 357.5291092 + 35999.0502909 * t - 0.0001536 * t2 + t3 / 24490000.0;
    const double moon = 134.9633964 + 477198.8675055 * t + 0.0087414 * t2 + t3 / 69699.0 - t4 / 14712000.0;
    const double node = 93.2720950 + 483202.0175233 * t - 0.0036539 * t2 - t3 / 3526000.0 + t4 / 863310000.0;
    // the eccentricity of the earth's orbit falls
    const double orbit = 1.0 - 0.002516 * t - 0.0000074 * t2;
    const auto angle = [&](const Term& term) {
        return glm::radians(term.elongation * elongation + term.sun * sun + term.moon * moon + term.node * node);
    };
    const auto amplitude = [&](const Term& term) { return term.amplitude * std::pow(orbit, std::abs(term.sun)); };
    Ecliptic place{mean, 0.0, 385000.56};
    for (const Term& term : longitudes) place.longitude += amplitude(term) * std::sin(angle(term));
    for (const Term& term : latitudes) place.latitude += amplitude(term) * std::sin(angle(term));
    for (const Term& term : distances) place.distance += amplitude(term) * std::cos(angle(term));
    // pulls of Venus, Jupiter and the flattened earth
    place.longitude += 0.003958 * std::sin(glm::radians(119.75 + 131.849 * t)) +
                       0.001962 * std::sin(glm::radians(mean - node)) +
                       0.000318 * std::sin(glm::radians(53.09 + 479264.290 * t));
    place.latitude += -0.002235 * std::sin(glm::radians(mean));
    place.longitude -= 360.0 * std::floor(place.longitude / 360.0);
    return place;
}

}  // namespace lumulus::scene
