#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/version.h"
#include "cli/threads.h"
#include "python/picture.h"
#include "python/renderer.h"
#include "python/scene_document.h"
#include "python/toml_value.h"
#include "python/truth.h"

namespace lumulus::python {
namespace {

namespace py = pybind11;

using Edges = std::variant<double, std::array<double, 3>>;

std::optional<scene::Quality> qualityOf(const std::optional<std::string>& name) {
    if (!name) return std::nullopt;
    if (*name == "draft") return scene::Quality::draft;
    if (*name == "interactive") return scene::Quality::interactive;
    if (*name == "final") return scene::Quality::final;
    throw InputError("unknown quality \"" + *name + "\"", "quality", "choose from draft, interactive, final");
}

void setAll(SceneDocument& document, const py::dict& values) {
    std::vector<std::string> overrides;
    for (const auto& [key, value] : values) {
        const std::string path = py::str(key).cast<std::string>();
        overrides.push_back(path + "=" + tomlOf(value, path));
    }
    document.set(overrides);
}

/// Densities of an array along x, y, z. Errors: InputError for other shapes and types.
std::shared_ptr<const scene::Voxels> voxelsOf(const py::array& given, const Edges& edges,
                                              const std::array<double, 3>& origin) {
    constexpr const char* where = "NumPy array";
    if (given.ndim() != 3)
        throw InputError("the array has " + std::to_string(given.ndim()) + " dimensions", where,
                         "give densities along x, y and z");
    if (given.dtype().kind() != 'f')
        throw InputError("the array holds values of type " + py::str(given.dtype()).cast<std::string>() + ", not float",
                         where, "convert it: array.astype(numpy.float32)");
    constexpr py::ssize_t longest = 1 << 20;
    for (int axis = 0; axis < 3; ++axis)
        if (given.shape(axis) < 1 || given.shape(axis) > longest)
            throw InputError("the array has " + std::to_string(given.shape(axis)) + " voxels along an axis", where,
                             "give 1 to 1048576");
    const auto array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(given);
    if (!array) throw py::error_already_set();
    scene::Voxels voxels;
    voxels.name = where;
    for (int axis = 0; axis < 3; ++axis) {
        voxels.size[axis] = static_cast<int>(array.shape(axis));
        voxels.edges[axis] = std::holds_alternative<double>(edges) ? std::get<double>(edges)
                                                                   : std::get<1>(edges)[static_cast<std::size_t>(axis)];
        voxels.origin[axis] = origin[static_cast<std::size_t>(axis)];
    }
    voxels.values.assign(array.data(), array.data() + array.size());
    return std::make_shared<const scene::Voxels>(std::move(voxels));
}

void defineScene(py::module_& module) {
    const py::object none = py::none();
    py::class_<SceneDocument>(module, "Scene")
        .def(py::init([](const std::filesystem::path& path, const std::optional<std::string>& quality, double frame) {
                 return SceneDocument(scene::sceneText(path), qualityOf(quality), frame);
             }),
             py::arg("path"), py::arg("quality") = none, py::arg("frame") = 0.0)
        .def_static(
            "from_text",
            [](const std::string& text, const std::string& name, const std::optional<std::string>& quality,
               double frame) {
                return SceneDocument({text, name}, qualityOf(quality), frame);
            },
            py::arg("text"), py::arg("name") = "text", py::arg("quality") = none, py::arg("frame") = 0.0)
        .def(
            "set",
            [](SceneDocument& document, const std::string& key, const py::object& value) {
                py::dict one;
                one[py::str(key)] = value;
                setAll(document, one);
            },
            py::arg("key"), py::arg("value"))
        .def("update", setAll, py::arg("values"))
        .def(
            "set_density",
            [](SceneDocument& document, const py::array& array, const Edges& edges, const std::array<double, 3>& origin,
               const std::variant<int, std::string>& cloud) {
                const bool number = std::holds_alternative<int>(cloud);
                document.setDensity(voxelsOf(array, edges, origin),
                                    number ? std::to_string(std::get<int>(cloud)) : std::get<std::string>(cloud));
            },
            py::arg("array"), py::arg("voxel_size"), py::arg("origin") = std::array{0.0, 0.0, 0.0},
            py::arg("cloud") = 0)
        .def_property_readonly("source", [](const SceneDocument& d) { return d.scene().source; })
        .def_property_readonly("width", [](const SceneDocument& d) { return d.scene().image.width; })
        .def_property_readonly("height", [](const SceneDocument& d) { return d.scene().image.height; })
        .def_property_readonly("seed", [](const SceneDocument& d) { return d.scene().photonMap.seed; });
}

/// Errors of the house become exceptions with the text of the command line.
void defineErrors(py::module_& module) {
    const auto& error = py::register_exception<Error>(module, "Error");
    py::register_exception<InputError>(module, "InputError", error);
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const std::bad_alloc&) {
            PyErr_SetString(PyExc_MemoryError, "out of memory: make the picture or the cloud smaller");
        }
    });
}

}  // namespace

PYBIND11_MODULE(_core, module) {
    module.attr("__version__") = version;
    defineErrors(module);
    definePicture(module);
    defineScene(module);
    defineRenderer(module);
    defineTruth(module);
    module.def(
        "limit_threads",
        [](int threads) {
            constexpr int most = 1024;  // as of --threads
            if (threads < 1 || threads > most)
                throw InputError(std::to_string(threads) + " is no number of threads", "limit_threads",
                                 "give 1 to 1024");
            cli::limitThreads(threads, cli::ThreadUse::device);
        },
        py::arg("threads"));
}

}  // namespace lumulus::python
