#include "python/renderer.h"

#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "base/error.h"
#include "cli/picture_files.h"
#include "python/picture.h"
#include "python/scene_document.h"
#include "python/work.h"
#include "render/renderer.h"

namespace lumulus::python {
namespace {

namespace py = pybind11;

using Point = std::optional<std::array<double, 3>>;

/// A renderer with its scene. Threads of Python that use it wait for each other.
class SceneRenderer {
  public:
    SceneRenderer(const SceneDocument& document, const std::string& device, const py::object& progress)
        : scene_(document.scene()) {
        // a copy: other threads of Python may set keys meanwhile
        work(progress, [&, copy = document] {
            scene_ = copy.placed();
            RendererOptions options{device, false,
                                    [this](std::string_view step, std::uint64_t done, std::uint64_t total) {
                                        hooks_.report(step, done, total);
                                    },
                                    [this] { hooks_.check(); }};
            renderer_ = std::make_unique<Renderer>(scene_, options);
        });
    }

    /// Traces the generations that the scene asks for and are not traced yet, `most` of them at most. Returns how many
    /// are missing then.
    int trace(const py::object& progress, std::optional<int> most) {
        work(progress, [&] { traceMissing(most.value_or(missing())); });
        return missing();
    }

    Picture render(const Point& position, const Point& target, const py::object& progress) {
        LayeredImage image;
        View view;
        work(progress, [&] {
            traceMissing(missing());
            view = renderer_->sceneView();
            if (position) view.camera.position = glm::dvec3((*position)[0], (*position)[1], (*position)[2]);
            if (target) view.camera.target = glm::dvec3((*target)[0], (*target)[1], (*target)[2]);
            image = renderer_->draw(view);
            cli::noteOrigin(image, scene_, renderer_->statistics());
        });
        return {std::move(image), view.image};
    }

    py::dict statistics() {
        const std::unique_lock lock = locked();
        const Statistics now = renderer_->statistics();
        py::dict seconds, result;
        seconds["load"] = now.loadSeconds;
        seconds["prepare"] = now.prepareSeconds;
        seconds["trace"] = now.traceSeconds;
        seconds["draw"] = now.drawSeconds;
        result["device"] = now.device;
        result["photons"] = now.photons;
        result["generations"] = now.generations;
        result["collectors"] = now.collectors;
        result["gpu_bytes"] = now.gpuBytes;
        result["seconds"] = seconds;
        result["warnings"] = now.warnings;
        return result;
    }

  private:
    int missing() const {
        return renderer_->generationsWanted() - static_cast<int>(renderer_->statistics().generations);
    }

    void traceMissing(int count) {
        const int wanted = renderer_->generationsWanted(), done = wanted - missing();
        hooks_.report("photons", static_cast<std::uint64_t>(done), static_cast<std::uint64_t>(wanted));
        for (int i = done; i < std::min(wanted, done + count); ++i) {
            hooks_.check();
            broken_ = true;  // until the generation is whole
            renderer_->traceGeneration();
            broken_ = false;
            hooks_.report("photons", static_cast<std::uint64_t>(i) + 1, static_cast<std::uint64_t>(wanted));
        }
    }

    std::unique_lock<std::mutex> locked() {
        const py::gil_scoped_release released;
        return std::unique_lock(mutex_);
    }

    void work(const py::object& progress, const std::function<void()>& step) {
        const std::unique_lock lock = locked();
        if (broken_)
            throw Error("the renderer was interrupted while it traced photons", "Renderer",
                        "make a new one of the same scene");
        run(progress, [&](const Hooks& hooks) {
            hooks_ = hooks;
            step();
        });
        std::vector<std::string> warnings = renderer_->statistics().warnings;
        warnings.erase(warnings.begin(),
                       warnings.begin() + static_cast<std::ptrdiff_t>(std::exchange(told_, warnings.size())));
        for (const std::string& text : warnings) warn(text);
    }

    std::mutex mutex_;
    scene::Scene scene_;
    Hooks hooks_;           ///< of the work that is done now, or was done last
    std::size_t told_ = 0;  ///< warnings
    bool broken_ = false;   ///< whether a part of a generation is in the photon map
    std::unique_ptr<Renderer> renderer_;
};

}  // namespace

void defineRenderer(py::module_& module) {
    const py::object none = py::none();
    py::class_<SceneRenderer>(module, "Renderer")
        .def(py::init<const SceneDocument&, const std::string&, const py::object&>(), py::arg("scene"),
             py::arg("device") = "", py::arg("progress") = none)
        .def(
            "trace",
            [](SceneRenderer& r, std::optional<int> generations, const py::object& progress) {
                return r.trace(progress, generations);
            },
            py::arg("generations") = none, py::arg("progress") = none)
        .def("render", &SceneRenderer::render, py::arg("position") = none, py::arg("target") = none,
             py::arg("progress") = none)
        .def("statistics", &SceneRenderer::statistics);
    module.def(
        "render",
        [](const SceneDocument& scene, const std::string& device, const py::object& progress) {
            SceneRenderer renderer(scene, device, progress);
            return renderer.render({}, {}, progress);
        },
        py::arg("scene"), py::arg("device") = "", py::arg("progress") = none);
}

}  // namespace lumulus::python
