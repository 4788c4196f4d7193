#include "bench/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lumulus::bench {
namespace {

// pixels of the SVG's own coordinates
constexpr double width = 720.0, height = 480.0;
constexpr double left = 80.0, right = 700.0, top = 46.0, bottom = 425.0;

/// A logarithmic axis from one power of ten to another.
struct Axis {
    int lowest = 0, highest = 1;  ///< exponents
    double begin = 0.0, end = 0.0;

    double place(double value) const {
        const double share = (std::log10(value) - lowest) / (highest - lowest);
        return begin + std::clamp(share, 0.0, 1.0) * (end - begin);
    }
};

Axis axisOver(const std::vector<double>& values, double begin, double end) {
    if (values.empty()) return {-3, 0, begin, end};
    const auto [least, most] = std::ranges::minmax(values);
    const int lowest = static_cast<int>(std::floor(std::log10(least)));
    const int highest = static_cast<int>(std::ceil(std::log10(most)));
    return {lowest, std::max(highest, lowest + 1), begin, end};
}

struct Series {
    Method method;
    Spread Row::*seconds;
    const char* name;
    const char* colour;
    const char* dash;
};

constexpr std::array<Series, 4> allSeries{
    {{Method::render, &Row::warmSeconds, "render, without warm-up", "#c2410c", ""},
     {Method::render, &Row::seconds, "render, whole", "#c2410c", "5 4"},
     {Method::pathTracer, &Row::warmSeconds, "path tracer, without warm-up", "#1d4ed8", ""},
     {Method::pathTracer, &Row::seconds, "path tracer, whole", "#1d4ed8", "5 4"}}};

bool drawable(const Row& row) {
    return row.relMse.mean > 0.0;
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else
            result += c;
    }
    return result;
}

std::string lineSvg(double x1, double y1, double x2, double y2, const std::string& style) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2, style);
}

std::string textSvg(double x, double y, const char* anchor, const std::string& text) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, escaped(text));
}

/// Lines at 1 to 9 of each decade, names at its powers of ten.
std::string gridSvg(const Axis& x, const Axis& y) {
    std::string svg;
    const auto each = [](const Axis& axis, auto&& draw) {
        for (int decade = axis.lowest; decade <= axis.highest; ++decade) {
            for (int digit = 1; digit <= (decade < axis.highest ? 9 : 1); ++digit) {
                draw(axis.place(digit * std::pow(10.0, decade)), decade, digit == 1);
            }
        }
    };
    const auto style = [](bool major) { return major ? "stroke=\"#bbb\"" : "stroke=\"#eee\""; };
    each(x, [&](double at, int decade, bool major) {
        svg += lineSvg(at, top, at, bottom, style(major));
        if (major) svg += textSvg(at, bottom + 17.0, "middle", fmt::format("{:g}", std::pow(10.0, decade)));
    });
    each(y, [&](double at, int decade, bool major) {
        svg += lineSvg(left, at, right, at, style(major));
        if (major) svg += textSvg(left - 7.0, at + 4.0, "end", fmt::format("{:g}", std::pow(10.0, decade)));
    });
    svg += textSvg(0.5 * (left + right), height - 14.0, "middle", "seconds");
    return svg + fmt::format(
                     "<text x=\"22\" y=\"{0:.1f}\" text-anchor=\"middle\" transform=\"rotate(-90 22 {0:.1f})\">"
                     "relMSE</text>\n",
                     0.5 * (top + bottom));
}

std::string seriesSvg(const Series& series, std::span<const Row> rows, const Axis& x, const Axis& y) {
    const std::string stroke = fmt::format("stroke=\"{}\" stroke-width=\"1.8\"", series.colour);
    std::string points, marks;
    for (const Row& row : rows) {
        if (row.method != series.method || !drawable(row)) continue;
        const double px = x.place((row.*series.seconds).mean), py = y.place(row.relMse.mean);
        points += fmt::format("{:.1f},{:.1f} ", px, py);
        marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.2\" fill=\"{}\"/>\n", px, py, series.colour);
        const double low = std::max(row.relMse.mean - row.relMse.deviation, std::pow(10.0, y.lowest));
        marks += lineSvg(px, y.place(low), px, y.place(row.relMse.mean + row.relMse.deviation), stroke);
    }
    return fmt::format("<polyline points=\"{}\" fill=\"none\" {} stroke-dasharray=\"{}\"/>\n{}", points, stroke,
                       series.dash, marks);
}

std::string legendSvg(bool withFloor) {
    double y = top + 16.0;
    std::string svg =
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"232\" height=\"{}\" fill=\"#fff\" stroke=\"#bbb\"/>\n",
                    right - 240.0, top + 2.0, withFloor ? 92 : 75);
    const auto entry = [&](const char* name, const char* colour, const char* dash) {
        svg += lineSvg(right - 232.0, y - 4.0, right - 200.0, y - 4.0,
                       fmt::format("stroke=\"{}\" stroke-width=\"1.8\" stroke-dasharray=\"{}\"", colour, dash));
        svg += textSvg(right - 192.0, y, "start", name);
        y += 17.0;
    };
    for (const Series& series : allSeries) entry(series.name, series.colour, series.dash);
    if (withFloor) entry("noise of the reference", "#555", "2 3");
    return svg;
}

}  // namespace

std::string errorPlotSvg(std::span<const Row> rows, const std::string& title, std::optional<double> floor) {
    std::vector<double> seconds, errors;
    for (const Row& row : rows) {
        if (!drawable(row)) continue;
        seconds.insert(seconds.end(), {row.seconds.mean, row.warmSeconds.mean});
        errors.push_back(row.relMse.mean);
    }
    const bool withFloor = floor && *floor > 0.0;
    if (withFloor) errors.push_back(*floor);
    const Axis x = axisOver(seconds, left, right), y = axisOver(errors, bottom, top);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
        width, height);
    svg += textSvg(left, 28.0, "start", title) + gridSvg(x, y);
    if (withFloor) {
        svg += lineSvg(left, y.place(*floor), right, y.place(*floor),
                       "stroke=\"#555\" stroke-width=\"1.8\" stroke-dasharray=\"2 3\"");
    }
    for (const Series& series : allSeries) svg += seriesSvg(series, rows, x, y);
    return svg + legendSvg(withFloor) + "</svg>\n";
}

}  // namespace lumulus::bench
