#include "cli/query.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/number_table.h"
#include "base/progress.h"
#include "base/version.h"
#include "cli/clouds_told.h"
#include "cli/output.h"
#include "query/media.h"
#include "scene/load.h"

namespace lumulus::cli {
namespace {

constexpr std::size_t mostRows = 50000000;
constexpr int mostAcross = 16384;
constexpr std::array<std::string_view, 6> segmentColumns{"x0", "y0", "z0", "x1", "y1", "z1"};
constexpr std::array<std::string_view, 3> pointColumns{"x", "y", "z"};

std::vector<query::Segment> readSegments(const std::filesystem::path& path) {
    const NumberTable table = readNumberTable(path, segmentColumns, mostRows);
    std::vector<query::Segment> segments;
    segments.reserve(table.rows());
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const double* n = table.row(i);
        segments.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
    }
    return segments;
}

std::vector<glm::dvec3> readPoints(const std::filesystem::path& path) {
    const NumberTable table = readNumberTable(path, pointColumns, mostRows);
    std::vector<glm::dvec3> points;
    points.reserve(table.rows());
    for (std::size_t i = 0; i < table.rows(); ++i)
        points.emplace_back(table.row(i)[0], table.row(i)[1], table.row(i)[2]);
    return points;
}

/// Width and height of "WIDTHxHEIGHT".
glm::ivec2 sizeOf(const std::string& text) {
    glm::ivec2 size(0);
    const char* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.x);
    const bool divided = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    const auto height = divided ? std::from_chars(width.ptr + 1, end, size.y) : width;
    const auto fits = [](int n) { return n >= 1 && n <= mostAcross; };
    if (!divided || height.ec != std::errc() || height.ptr != end || !fits(size.x) || !fits(size.y))
        throw InputError(fmt::format("\"{}\" is no size", text), "--size",
                         "give WIDTHxHEIGHT, each 1 to 16384: 512x512");
    return size;
}

query::Rectangle rectangleOf(const QueryOptions& options, const scene::Scene& scene) {
    const std::vector<double>& r = options.rectangle;
    const double y = options.height.value_or(scene.ground ? scene.ground->height : 0.0);
    for (const double number : {r[0], r[1], r[2], r[3], y})
        if (!(std::abs(number) <= 1e9))
            throw InputError(fmt::format("{} is not within ±1e9", number), "--ground-shadow", "give metres");
    if (!(r[0] < r[2] && r[1] < r[3]))
        throw InputError(fmt::format("{},{},{},{} is no rectangle", r[0], r[1], r[2], r[3]), "--ground-shadow",
                         "give X0,Z0,X1,Z1 with X0 < X1 and Z0 < Z1");
    const glm::ivec2 size = sizeOf(options.size);
    return {r[0], r[1], r[2], r[3], y, size.x, size.y};
}

std::string tableOf(std::span<const query::Passage> passages) {
    std::string text =
        "transmittance_r,transmittance_g,transmittance_b,optical_depth_r,optical_depth_g,optical_depth_b\n";
    for (const query::Passage& passage : passages) {
        const glm::dvec3 t = passage.transmittance(), d = passage.opticalDepth;
        fmt::format_to(std::back_inserter(text), "{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", t.r, t.g, t.b, d.r, d.g,
                       d.b);
    }
    return text;
}

/// A number of JSON, which has none that is infinite.
std::string jsonNumber(double number) {
    return std::isfinite(number) ? fmt::format("{:.9g}", number) : "null";
}

std::string jsonOf(std::span<const query::Passage> passages) {
    std::string text = "{\"passages\": [";
    const auto triple = [](const glm::dvec3& v) {
        return fmt::format("[{}, {}, {}]", jsonNumber(v.r), jsonNumber(v.g), jsonNumber(v.b));
    };
    for (std::size_t i = 0; i < passages.size(); ++i)
        fmt::format_to(std::back_inserter(text), "{}\n  {{\"transmittance\": {}, \"optical_depth\": {}}}",
                       i > 0 ? "," : "", triple(passages[i].transmittance()), triple(passages[i].opticalDepth));
    return text + "\n]}\n";
}

void write(const QueryOptions& options, std::string_view text) {
    if (options.output.empty()) return printOut(text);
    writeFile(options.output, std::as_bytes(std::span(text)));
}

query::Media loadMedia(const QueryOptions& options, const scene::Scene& scene, Steps& steps) {
    const CloudVolumes volumes = loadClouds(scene, steps.reporter());
    tellClouds({}, volumes.warnings, options.quiet);
    return query::mediaOf(scene, volumes);
}

void answerWithPassages(const QueryOptions& options, const scene::Scene& scene) {
    const bool asksSun = !options.sun.empty();
    const auto segments = asksSun ? std::vector<query::Segment>{} : readSegments(options.segments);
    const auto points = asksSun ? readPoints(options.sun) : std::vector<glm::dvec3>{};
    Steps steps(options.quiet);
    const query::Media media = loadMedia(options, scene, steps);
    const std::size_t count = segments.size() + points.size();
    steps.report("asking", 0, count);
    const std::vector<query::Passage> passages =
        asksSun ? query::towardsSun(media, points, scene.sun.directionTo, stopIfInterrupted)
                : query::alongSegments(media, segments, stopIfInterrupted);
    steps.report("asking", count, count);
    write(options, options.json ? jsonOf(passages) : tableOf(passages));
}

void answerWithShadow(const QueryOptions& options, const scene::Scene& scene) {
    const query::Rectangle rectangle = rectangleOf(options, scene);
    Steps steps(options.quiet);
    const query::Media media = loadMedia(options, scene, steps);
    LayeredImage shadow = query::groundShadow(media, rectangle, scene.sun.directionTo, stopIfInterrupted);
    shadow.attributes["scene"] = scene.source;
    shadow.attributes["software"] = fmt::format("lumulus {}", version);
    shadow.attributes["rectangle"] =
        fmt::format("{},{},{},{} at {} m", rectangle.x0, rectangle.z0, rectangle.x1, rectangle.z1, rectangle.y);
    writeExr(options.output, shadow);
}

}  // namespace

void runQuery(const QueryOptions& options) {
    const bool shadow = !options.rectangle.empty();
    const int subjects = (options.segments.empty() ? 0 : 1) + (options.sun.empty() ? 0 : 1) + (shadow ? 1 : 0);
    if (subjects != 1)
        throw InputError("query needs exactly one subject", "command line",
                         "give --segments, --sun or --ground-shadow");
    if (shadow && options.output.empty())
        throw InputError("a shadow is a picture", "command line", "give a file: -o shadow.exr");
    if (shadow) requireSuffix(options.output, {".exr"});
    if (!options.output.empty()) checkPlaces({options.output});
    const auto& table = options.sun.empty() ? options.segments : options.sun;
    if (options.scene == "-" && table == "-")
        throw InputError("standard input cannot be both scene and table", "command line", "give a file for one");
    const scene::Scene scene = scene::loadScene(options.scene, options.overrides);
    shadow ? answerWithShadow(options, scene) : answerWithPassages(options, scene);
}

}  // namespace lumulus::cli
