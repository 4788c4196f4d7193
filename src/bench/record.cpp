#include "bench/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lumulus::bench {
namespace {

template <typename Value>
Spread spreadOf(std::span<const Run> runs, Value&& value) {
    const auto count = static_cast<double>(runs.size());
    Spread spread;
    for (const Run& run : runs) spread.mean += value(run) / count;
    if (runs.size() < 2) return spread;
    double squares = 0.0;
    for (const Run& run : runs) squares += (value(run) - spread.mean) * (value(run) - spread.mean);
    spread.deviation = std::sqrt(squares / (count - 1.0));
    return spread;
}

Row rowOf(std::span<const Run> runs) {
    Row row{runs.front().method, runs.front().budget, runs.size(), {}, {}, {}, {}, {}, {}, {}, {}};
    row.seconds = spreadOf(runs, [](const Run& r) { return r.seconds; });
    row.warmSeconds = spreadOf(runs, [](const Run& r) { return r.warmSeconds; });
    row.amount = spreadOf(runs, [](const Run& r) { return r.amount; });
    row.relMse = spreadOf(runs, [](const Run& r) { return r.errors.relMse; });
    row.rmse = spreadOf(runs, [](const Run& r) { return r.errors.rmse; });
    row.flip = spreadOf(runs, [](const Run& r) { return r.errors.flip; });
    row.bias = spreadOf(runs, [](const Run& r) { return r.errors.bias; });
    row.relativeBias = spreadOf(runs, [](const Run& r) { return r.errors.relativeBias; });
    return row;
}

}  // namespace

const char* nameOf(Method method) {
    switch (method) {
        case Method::pathTracer:
            return "path tracer";
        case Method::cycles:
            return "Cycles";
        case Method::render:
            break;
    }
    return "render";
}

std::vector<Row> summarise(std::span<const Run> runs) {
    std::vector<std::vector<Run>> groups;
    for (const Run& run : runs) {
        const auto same = std::ranges::find_if(groups, [&](const std::vector<Run>& group) {
            return group.front().method == run.method && group.front().budget == run.budget;
        });
        if (same != groups.end())
            same->push_back(run);
        else
            groups.push_back({run});
    }
    std::vector<Row> rows;
    for (const std::vector<Run>& group : groups) rows.push_back(rowOf(group));
    return rows;
}

std::string csv(std::span<const Row> rows) {
    std::string text = "method,budget,seeds";
    for (const char* name :
         {"seconds", "seconds_without_warmup", "photons_or_spp", "relMSE", "RMSE", "FLIP", "bias", "relative_bias"}) {
        text += fmt::format(",{0},{0}_spread", name);
    }
    text += "\n";
    for (const Row& row : rows) {
        text += fmt::format("{},{:.6g},{}", nameOf(row.method), row.budget, row.seeds);
        for (const Spread& s :
             {row.seconds, row.warmSeconds, row.amount, row.relMse, row.rmse, row.flip, row.bias, row.relativeBias}) {
            text += fmt::format(",{:.6g},{:.3g}", s.mean, s.deviation);
        }
        text += "\n";
    }
    return text;
}

}  // namespace lumulus::bench
