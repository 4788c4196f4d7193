#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lumulus::bench {

enum class Method { render, pathTracer, cycles };

/// Name of a method: "render", "path tracer" or "Cycles".
const char* nameOf(Method method);

/// Errors of a picture against the reference (see reference::Comparison).
struct Errors {
    double relMse = 0.0;  ///< without the reference's own noise, if that is known
    double rmse = 0.0;    ///< with the reference's noise
    double flip = 0.0;
    double bias = 0.0;          ///< mean signed difference, W·m⁻²·sr⁻¹
    double relativeBias = 0.0;  ///< bias over the reference's mean
};

/// One picture with its time and its errors.
struct Run {
    Method method = Method::render;
    double budget = 0.0;       ///< seconds wanted, without warm-up
    double seconds = 0.0;      ///< from the scene to the picture, everything
    double warmSeconds = 0.0;  ///< without device, pipelines, loading, preparation and first dispatches
    double amount = 0.0;       ///< photons, or samples per pixel
    Errors errors;
};

/// Mean and standard deviation over the seeds (0 for a single seed).
struct Spread {
    double mean = 0.0;
    double deviation = 0.0;
};

/// All seeds of a method at one budget.
struct Row {
    Method method = Method::render;
    double budget = 0.0;
    std::size_t seeds = 0;
    Spread seconds, warmSeconds, amount, relMse, rmse, flip, bias, relativeBias;
};

/// Groups runs into rows, in the order in which method and budget first appear.
std::vector<Row> summarise(std::span<const Run> runs);

/// The rows as CSV with a line of names first; `_spread` is the standard deviation over the seeds.
std::string csv(std::span<const Row> rows);

}  // namespace lumulus::bench
