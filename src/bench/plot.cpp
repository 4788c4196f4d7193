#include "bench/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/canvas.h"

namespace lumulus::bench {
namespace {

// pixels
constexpr double width = 720.0, height = 500.0;
constexpr double left = 80.0, right = 700.0, top = 86.0, bottom = 446.0;
constexpr double pngScale = 2.0;

constexpr double lineWidth = 1.8;
constexpr Colour orange{0.76, 0.25, 0.05}, blue{0.11, 0.31, 0.85}, green{0.0, 0.45, 0.2}, grey{0.33, 0.33, 0.33};
constexpr Colour major{0.73, 0.73, 0.73}, minor{0.93, 0.93, 0.93};

/// A logarithmic axis from one power of ten to another.
struct Axis {
    int lowest = 0, highest = 1;  ///< exponents
    double begin = 0.0, end = 0.0;

    double place(double value) const {
        const double share = (std::log10(value) - lowest) / (highest - lowest);
        return begin + std::clamp(share, 0.0, 1.0) * (end - begin);
    }
};

struct Axes {
    Axis x, y;

    Point place(double seconds, double error) const { return {x.place(seconds), y.place(error)}; }
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
    Colour colour;
    bool whole;  ///< time of the whole process: hollow discs, dashed lines

    Stroke stroke() const { return {colour, lineWidth, whole ? std::vector{5.0, 4.0} : std::vector<double>{}}; }
};

constexpr std::array<Series, 6> allSeries{
    {{Method::render, &Row::warmSeconds, "render, without warm-up", orange, false},
     {Method::render, &Row::seconds, "render, whole", orange, true},
     {Method::pathTracer, &Row::warmSeconds, "path tracer, without warm-up", blue, false},
     {Method::pathTracer, &Row::seconds, "path tracer, whole", blue, true},
     {Method::cycles, &Row::warmSeconds, "Cycles, without warm-up", green, false},
     {Method::cycles, &Row::seconds, "Cycles, whole", green, true}}};

const Stroke floorStroke{grey, lineWidth, {2.0, 3.0}};

bool drawable(const Row& row) {
    return row.relMse.mean > 0.0;
}

void drawLine(Canvas& canvas, const Point& from, const Point& to, const Stroke& stroke) {
    canvas.line(std::array{from, to}, stroke);
}

/// Calls `draw(place, words)` at 1 to 9 of each decade; words only at its powers of ten.
template <typename Draw>
void eachGridLine(const Axis& axis, Draw&& draw) {
    for (int decade = axis.lowest; decade <= axis.highest; ++decade) {
        const double power = std::pow(10.0, decade);
        for (int digit = decade < axis.highest ? 9 : 1; digit >= 1; --digit) {
            draw(axis.place(digit * power), digit == 1 ? fmt::format("{:g}", power) : std::string());
        }
    }
}

void drawGrid(Canvas& canvas, const Axes& axes) {
    const auto stroke = [](const std::string& words) { return Stroke{words.empty() ? minor : major, 1.0, {}}; };
    eachGridLine(axes.x, [&](double at, const std::string& words) {
        drawLine(canvas, {at, top}, {at, bottom}, stroke(words));
        canvas.text({at, bottom + 18.0}, Anchor::middle, words);
    });
    eachGridLine(axes.y, [&](double at, const std::string& words) {
        drawLine(canvas, {left, at}, {right, at}, stroke(words));
        canvas.text({left - 7.0, at + 4.0}, Anchor::right, words);
    });
    canvas.box({left, top}, {right, bottom}, {grey, 1.0, {}});
    canvas.text({0.5 * (left + right), height - 14.0}, Anchor::middle, "seconds");
    canvas.textUpwards({22.0, 0.5 * (top + bottom)}, Anchor::middle, "relMSE");
}

void drawSeries(Canvas& canvas, const Series& series, std::span<const Row> rows, const Axes& axes) {
    std::vector<Point> points;
    for (const Row& row : rows) {
        if (row.method != series.method || !drawable(row)) continue;
        const double seconds = (row.*series.seconds).mean;
        points.push_back(axes.place(seconds, row.relMse.mean));
        const double low = std::max(row.relMse.mean - row.relMse.deviation, std::pow(10.0, axes.y.lowest));
        drawLine(canvas, axes.place(seconds, low), axes.place(seconds, row.relMse.mean + row.relMse.deviation),
                 {series.colour, lineWidth, {}});
    }
    canvas.line(points, series.stroke());
    for (const Point& point : points) canvas.disc(point, 3.4, series.colour, !series.whole);
}

/// Draws the legend above the grid, where no curve can be: a column for each method, and a line for the noise floor.
/// Cycles appears only if it has points.
void drawLegend(Canvas& canvas, bool withFloor, bool withCycles) {
    constexpr std::array columns{left, left + 206.0, left + 436.0};
    constexpr double rowHeight = 18.0, sample = 32.0;
    const auto entry = [&](std::size_t column, int row, const char* name, const Stroke& stroke) {
        const Point at{columns.at(column), 52.0 + row * rowHeight};
        const double y = at.y - 4.0;
        drawLine(canvas, {at.x, y}, {at.x + sample, y}, stroke);
        canvas.text({at.x + sample + 8.0, at.y}, Anchor::left, name);
        return Point{at.x + 0.5 * sample, y};
    };
    for (const Series& series : allSeries) {
        if (series.method == Method::cycles && !withCycles) continue;
        const auto column = static_cast<std::size_t>(series.method);
        const Point middle = entry(column, series.whole ? 1 : 0, series.name, series.stroke());
        canvas.disc(middle, 3.4, series.colour, !series.whole);
    }
    if (withFloor) entry(2, withCycles ? -1 : 0, "noise of the reference", floorStroke);
}

std::vector<std::byte> drawn(Canvas canvas, std::span<const Row> rows, const std::string& title,
                             std::optional<double> floor) {
    std::vector<double> seconds, errors;
    for (const Row& row : rows) {
        if (!drawable(row)) continue;
        seconds.insert(seconds.end(), {row.seconds.mean, row.warmSeconds.mean});
        errors.push_back(row.relMse.mean);
    }
    const bool withFloor = floor && *floor > 0.0;
    if (withFloor) errors.push_back(*floor);
    const Axes axes{axisOver(seconds, left, right), axisOver(errors, bottom, top)};
    canvas.text({left, 26.0}, Anchor::left, title);
    drawGrid(canvas, axes);
    if (withFloor) {
        const double y = axes.y.place(*floor);
        drawLine(canvas, {left, y}, {right, y}, floorStroke);
    }
    for (const Series& series : allSeries) drawSeries(canvas, series, rows, axes);
    const bool withCycles = std::ranges::any_of(rows, [](const Row& row) { return row.method == Method::cycles; });
    drawLegend(canvas, withFloor, withCycles);
    return canvas.finish();
}

}  // namespace

Plot errorPlot(std::span<const Row> rows, const std::string& title, std::optional<double> floor) {
    return {drawn(Canvas::svg(width, height), rows, title, floor),
            drawn(Canvas::png(width, height, pngScale), rows, title, floor)};
}

}  // namespace lumulus::bench
