#include "python/truth.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/stopwatch.h"
#include "cli/clouds_told.h"
#include "cli/compare.h"
#include "cli/reference.h"
#include "python/picture.h"
#include "python/scene_document.h"
#include "python/work.h"
#include "reference/render.h"
#include "volume/load.h"
#include "volume/summary.h"

namespace lumulus::python {
namespace {

namespace py = pybind11;

/// When the path tracer stops.
struct Limit {
    std::optional<std::uint64_t> samples;
    std::optional<double> seconds;
};

Limit limitOf(std::optional<std::int64_t> spp, std::optional<double> seconds) {
    if (spp.has_value() == seconds.has_value())
        throw InputError("the reference needs one limit", "reference", "give either spp or seconds");
    if (spp && *spp < 1) throw InputError(fmt::format("{} samples are no limit", *spp), "spp", "give 1 or more");
    if (seconds && !(*seconds > 0.0 && std::isfinite(*seconds)))
        throw InputError(fmt::format("{} s are no limit", *seconds), "seconds", "give a number above 0");
    return {spp ? std::optional(static_cast<std::uint64_t>(*spp)) : std::nullopt, seconds};
}

reference::Majorant majorantOf(const std::string& name) {
    if (name == "global") return reference::Majorant::global;
    if (name == "local") return reference::Majorant::local;
    throw InputError(fmt::format("unknown majorant \"{}\"", name), "majorant", "choose from global, local");
}

/// Passes until the limit; the number of rows is the progress where that is known.
void tracePasses(reference::Renderer& renderer, const Limit& limit, const Hooks& hooks) {
    const Stopwatch watch;
    const auto height = static_cast<std::uint64_t>(renderer.film().height);
    const std::uint64_t total =
        limit.samples ? *limit.samples * height : static_cast<std::uint64_t>(1e3 * *limit.seconds);
    std::uint64_t rows = 0;
    const auto goOn = [&](std::uint64_t more) {
        rows += more;
        hooks.check();
        hooks.report("reference",
                     limit.samples ? rows : std::min(total, static_cast<std::uint64_t>(1e3 * watch.seconds())), total);
        return true;
    };
    const auto enough = [&] {
        return limit.samples ? renderer.film().samples >= *limit.samples : watch.seconds() >= *limit.seconds;
    };
    do renderer.pass(goOn);
    while (!enough());
}

Picture trace(const SceneDocument& document, std::optional<std::int64_t> spp, std::optional<double> seconds,
              const std::string& majorant, const py::object& progress) {
    const Limit limit = limitOf(spp, seconds);
    const reference::Majorant kind = majorantOf(majorant);
    LayeredImage image;
    std::vector<std::string> warnings;
    // a copy: other threads of Python may set keys meanwhile
    run(progress, [&, copy = document](const Hooks& hooks) {
        const scene::Scene scene = copy.placed();
        const CloudVolumes clouds = loadClouds(scene, hooks.report, hooks.check);
        reference::Renderer renderer(scene, clouds.placed(), kind, scene.photonMap.seed);
        warnings = clouds.warnings;
        tracePasses(renderer, limit, hooks);
        image = renderer.picture();
        cli::noteReference(image, scene, renderer.film(), kind == reference::Majorant::local);
        cli::noteGrids(image, summarise(scene, clouds));
    });
    for (const std::string& text : warnings) warn(text);
    return {std::move(image), document.scene().image};
}

py::object compare(const py::object& image, const py::object& truth, double exposure) {
    py::object keepImage, keepTruth;
    const Picture &first = pictureOf(image, keepImage), &second = pictureOf(truth, keepTruth);
    std::string json;
    {
        const py::gil_scoped_release released;
        json = cli::comparisonJson(first.image(), second.image(), exposure);
    }
    return py::module_::import("json").attr("loads")(json);
}

}  // namespace

void defineTruth(py::module_& module) {
    module.def("reference", trace, py::arg("scene"), py::kw_only(), py::arg("spp") = py::none(),
               py::arg("seconds") = py::none(), py::arg("majorant") = "global", py::arg("progress") = py::none());
    module.def("compare", compare, py::arg("image"), py::arg("reference"), py::arg("exposure") = 0.0);
}

}  // namespace lumulus::python
