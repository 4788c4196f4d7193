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
#include "render/ambient.h"
#include "render/renderer.h"
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

std::vector<glm::dvec3> readPoints(const std::filesystem::path& path, std::size_t most = mostRows) {
    const NumberTable table = readNumberTable(path, pointColumns, most);
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
    CloudVolumes volumes = loadClouds(scene, steps.reporter(), stopIfInterrupted, FieldStorage::asWanted);
    tellClouds({}, volumes.warnings, options.quiet);
    return query::mediaOf(scene, std::move(volumes));
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

/// Errors: InputError with the row of a point below the ground.
void requireAboveGround(const std::vector<glm::dvec3>& points, const scene::Scene& scene, const QueryOptions& options) {
    for (std::size_t i = 0; scene.ground && i < points.size(); ++i)
        if (points[i].y < scene.ground->height)
            throw InputError(fmt::format("y = {} is below the ground at {} m", points[i].y, scene.ground->height),
                             fmt::format("{}, row {}", options.ambient.string(), i + 1), "raise the point");
}

/// Direct sunlight on a plane that faces the sun, then the coefficients, each R, G, B.
std::vector<glm::dvec3> lightAt(Renderer& renderer, ViewState& state, const query::Media& media,
                                const glm::dvec3& point) {
    std::vector<glm::dvec3> values{sunIrradianceAt(renderer, media, point, stopIfInterrupted)};
    for (const glm::dvec3& coefficient : ambientAt(renderer, state, point).coefficients) values.push_back(coefficient);
    return values;
}

std::string ambientText(const std::vector<std::vector<glm::dvec3>>& lights, bool json) {
    std::string text = json ? "{\"points\": [" : "sun_r,sun_g,sun_b";
    for (int i = 0; !json && i < 9; ++i) text += fmt::format(",sh{0}_r,sh{0}_g,sh{0}_b", i);
    if (!json) text += "\n";
    for (std::size_t p = 0; p < lights.size(); ++p) {
        if (json) text += p > 0 ? "," : "";
        for (std::size_t i = 0; i < lights[p].size(); ++i) {
            const glm::dvec3& v = lights[p][i];
            const char* before = i == 0 ? "\n  {\"sun\": " : (i == 1 ? ", \"sh\": [" : ", ");
            text += json ? fmt::format("{}[{:.9g}, {:.9g}, {:.9g}]", before, v.r, v.g, v.b)
                         : fmt::format("{}{:.9g},{:.9g},{:.9g}", i > 0 ? "," : "", v.r, v.g, v.b);
        }
        text += json ? "]}" : "\n";
    }
    return json ? text + "\n]}\n" : text;
}

void answerWithAmbient(const QueryOptions& options, scene::Scene scene) {
    constexpr std::size_t most = 100000;
    const std::vector<glm::dvec3> points = readPoints(options.ambient, most);
    requireAboveGround(points, scene, options);
    scene.sun.angularDiameter = 0.0;  // its light is told apart
    Steps steps(options.quiet);
    RendererOptions wanted;
    wanted.device = options.device;
    wanted.report = [&steps](std::string_view step, std::uint64_t done, std::uint64_t total) {
        if (step != "drawing" && step != "fog") steps.report(step, done, total);  // of each point
    };
    Renderer renderer(scene, wanted);
    tellClouds({}, renderer.statistics().warnings, options.quiet);
    const auto generations = static_cast<std::uint64_t>(renderer.generationsWanted());
    for (std::uint64_t i = 0; i < generations; ++i) {
        steps.report("tracing photons", i, generations);
        renderer.traceGeneration();
    }
    if (generations > 0) steps.report("tracing photons", generations, generations);
    ViewState state;
    const query::Media media = renderer.media();
    std::vector<std::vector<glm::dvec3>> lights;
    for (const glm::dvec3& point : points) {
        stopIfInterrupted();
        lights.push_back(lightAt(renderer, state, media, point));
    }
    write(options, ambientText(lights, options.json));
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
    const int subjects = (options.segments.empty() ? 0 : 1) + (options.sun.empty() ? 0 : 1) +
                         (options.ambient.empty() ? 0 : 1) + (shadow ? 1 : 0);
    if (subjects != 1)
        throw InputError("query needs exactly one subject", "command line",
                         "give --segments, --sun, --ambient or --ground-shadow");
    if (shadow && options.output.empty())
        throw InputError("a shadow is a picture", "command line", "give a file: -o shadow.exr");
    if (shadow) requireSuffix(options.output, {".exr"});
    if (!options.output.empty()) checkPlaces({options.output});
    const bool table = options.segments == "-" || options.sun == "-" || options.ambient == "-";
    if (options.scene == "-" && table)
        throw InputError("standard input cannot be both scene and table", "command line", "give a file for one");
    const scene::Scene scene = scene::loadScene(options.scene, options.overrides, options.quality,
                                                static_cast<double>(options.frame.value_or(0)));
    if (!options.ambient.empty()) return answerWithAmbient(options, scene);
    shadow ? answerWithShadow(options, scene) : answerWithPassages(options, scene);
}

}  // namespace lumulus::cli
