// Prints the table of clear_sky_values.h: clear_sky_reference SCALE > tests/stat/clear_sky_values.h
// A scale of 1 takes some seven minutes of one processor.
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <cmath>
#include <cstdlib>

#include "reference/tracer.h"
#include "stat/clear_sky_views.h"

using namespace lumulus;

namespace {

struct Value {
    glm::dvec3 radiance{0.0};
    double error = 0.0;  ///< relative standard error of the luminance
};

/// Paths to each view; twilight needs more.
double pathsFor(double sun) {
    return sun > 5.0 ? 150e3 : sun > 1.0 ? 200e3 : sun > -1.0 ? 300e3 : sun > -3.0 ? 400e3 : 1500e3;
}

Value measure(const reference::AirTracer& tracer, const glm::dvec3& direction, int paths, std::uint64_t stream) {
    reference::Random random(1, stream, 0);
    glm::dvec3 sum(0.0);
    double squares = 0.0;
    for (int i = 0; i < paths; ++i) {
        const reference::PathSample sample = tracer.trace({ClearSky::eye, direction}, random);
        const glm::dvec3 radiance = sample.radiance + sample.passed;
        sum += radiance;
        squares += std::pow(ClearSky::luminance(radiance), 2);
    }
    const double mean = ClearSky::luminance(sum) / paths;
    return {sum / static_cast<double>(paths), std::sqrt((squares / paths - mean * mean) / paths) / mean};
}

}  // namespace

int main(int count, char** words) {
    const double scale = count > 1 ? std::atof(words[1]) : 1.0;
    fmt::print("#pragma once\n\n#include <array>\n\n");
    fmt::print(
        "/// Radiance of ClearSky by the reference in W·m⁻²·sr⁻¹, and the relative standard error of its luminance:\n");
    fmt::print("/// suns, views, then R, G, B, error. Made by clear_sky_reference {}.\n", scale);
    fmt::print("inline constexpr std::array<std::array<std::array<double, 4>, 16>, 7> clearSkyValues{{{{\n");
    for (const double sun : ClearSky::suns) {
        const reference::AirTracer tracer(ClearSky::scene(sun), {}, reference::Majorant::local);
        std::array<Value, ClearSky::views> values;
        tbb::parallel_for(std::size_t{0}, ClearSky::views, [&](std::size_t view) {
            const auto stream = static_cast<std::uint64_t>((sun + 90.0) * 100.0) + view;
            values[view] = measure(tracer, ClearSky::view(view), static_cast<int>(scale * pathsFor(sun)), stream);
        });
        fmt::print("    {{{{  // the sun at {}°\n", sun);
        for (const Value& value : values) {
            fmt::print("        {{{:.4g}, {:.4g}, {:.4g}, {:.2g}}},\n", value.radiance.x, value.radiance.y,
                       value.radiance.z, value.error);
        }
        fmt::print("    }}}},\n");
        std::fflush(stdout);
    }
    fmt::print("}}}};\n");
}
