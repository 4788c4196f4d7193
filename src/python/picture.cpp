#include "python/picture.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/exr.h"
#include "cli/output.h"

namespace lumulus::python {
namespace {

namespace py = pybind11;

constexpr std::string_view colours = "RGBA";

/// The layer of a channel: what stands before its last dot; "RGB" for colours without one.
std::string layerOf(const std::string& channel) {
    if (const std::size_t dot = channel.rfind('.'); dot != std::string::npos) return channel.substr(0, dot);
    return channel == "R" || channel == "G" || channel == "B" ? "RGB" : channel;
}

/// Colours stand in the order R, G, B, A, the rest behind them by name.
std::pair<std::size_t, std::string> orderOf(const std::string& channel) {
    const std::string last = channel.substr(channel.rfind('.') + 1);
    return {last.size() == 1 ? std::min(colours.find(last), colours.size()) : colours.size(), last};
}

/// Names of the channels of an array that is given for a layer.
std::vector<std::string> namesFor(const std::string& layer, py::ssize_t channels) {
    if (layer == "RGB") return channels == 3 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>();
    if (channels == 1) return {layer};
    std::vector<std::string> names;
    if (channels == 3 || channels == 4)
        for (py::ssize_t i = 0; i < channels; ++i) names.push_back(layer + "." + colours[static_cast<std::size_t>(i)]);
    return names;
}

/// Adds an array, height × width × channels or height × width, to a picture.
void addArray(LayeredImage& image, const std::string& layer, const py::array& given) {
    const auto array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(given);
    if (given.dtype().kind() != 'f' || !array || array.ndim() < 2 || array.ndim() > 3)
        throw InputError(fmt::format("the array has {} dimensions of type {}", given.ndim(),
                                     py::str(given.dtype()).cast<std::string>()),
                         layer, "give floats, height x width x channels");
    const py::ssize_t channels = array.ndim() == 3 ? array.shape(2) : 1;
    const std::vector<std::string> names = namesFor(layer, channels);
    if (names.empty())
        throw InputError(fmt::format("the array has {} channels", channels), layer,
                         "give 3 for RGB, else 1, or 3 or 4 for R, G, B, A");
    const int height = static_cast<int>(array.shape(0)), width = static_cast<int>(array.shape(1));
    if (image.layers.empty()) std::tie(image.width, image.height) = std::pair(width, height);
    if (width != image.width || height != image.height || image.pixels() == 0)
        throw InputError(fmt::format("the array has {}x{} pixels", width, height), layer,
                         fmt::format("give all of one size, as {}x{}", image.width, image.height));
    for (std::size_t c = 0; c < names.size(); ++c) {
        std::vector<float>& values = image.layer(names[c]);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = array.data()[i * names.size() + c];
    }
}

std::string shownAs(const Picture& picture) {
    std::vector<std::string> names;
    for (const auto& [name, channels] : picture.layers()) names.push_back(name);
    return fmt::format("<lumulus.Picture {}x{}: {}>", picture.image().width, picture.image().height,
                       fmt::join(names, ", "));
}

std::vector<std::string> namesOf(const Picture& picture) {
    std::vector<std::string> names;
    for (const auto& [name, channels] : picture.layers()) names.push_back(name);
    return names;
}

}  // namespace

Picture::Picture(const py::dict& arrays) {
    for (const auto& [name, array] : arrays)
        addArray(image_, py::str(name).cast<std::string>(), py::array::ensure(array));
    if (image_.layers.empty()) throw InputError("the picture has no layer", "arrays", "give at least one");
}

std::map<std::string, std::vector<std::string>> Picture::layers() const {
    std::map<std::string, std::vector<std::string>> found;
    for (const auto& [channel, values] : image_.layers) found[layerOf(channel)].push_back(channel);
    for (auto& [layer, channels] : found) std::ranges::sort(channels, {}, orderOf);
    return found;
}

std::vector<std::string> Picture::channels(const std::string& name) const {
    const auto all = layers();
    if (const auto layer = all.find(name); layer != all.end()) return layer->second;
    return image_.layers.contains(name) ? std::vector{name} : std::vector<std::string>();
}

py::array_t<float> Picture::array(const std::string& name) const {
    const std::vector<std::string> names = channels(name);
    if (names.empty())
        throw py::key_error(fmt::format("{}: the picture has {}", name, fmt::join(namesOf(*this), ", ")));
    const auto count = static_cast<py::ssize_t>(names.size());
    py::array_t<float> result({py::ssize_t{image_.height}, py::ssize_t{image_.width}, count});
    float* to = result.mutable_data();
    for (std::size_t c = 0; c < names.size(); ++c) {
        const std::vector<float>& values = image_.layers.at(names[c]);
        for (std::size_t i = 0; i < values.size(); ++i) to[i * names.size() + c] = values[i];
    }
    return result;
}

void Picture::write(const std::filesystem::path& path) const {
    cli::requireSuffix(path, {".exr", ".png"});
    cli::writePicture(path, image_, how_);
}

const Picture& pictureOf(const py::object& pictureOrPath, py::object& keep) {
    keep = pictureOrPath;
    if (!py::isinstance<Picture>(pictureOrPath))
        keep = py::cast(Picture(readExr(pictureOrPath.cast<std::filesystem::path>()), scene::Image{}));
    return keep.cast<const Picture&>();
}

void definePicture(py::module_& module) {
    py::class_<Picture>(module, "Picture")
        .def(py::init<const py::dict&>(), py::arg("arrays"))
        .def_static(
            "read",
            [](const std::filesystem::path& path) {
                const py::gil_scoped_release released;
                return Picture(readExr(path), scene::Image{});
            },
            py::arg("path"))
        .def_property_readonly("width", [](const Picture& p) { return p.image().width; })
        .def_property_readonly("height", [](const Picture& p) { return p.image().height; })
        .def_property_readonly("attributes", [](const Picture& p) { return p.image().attributes; })
        .def_property_readonly("rgb", [](const Picture& p) { return p.array("RGB"); })
        .def(
            "channels",
            [](const Picture& p, const std::string& layer) {
                p.array(layer);
                return p.channels(layer);
            },
            py::arg("layer"))
        .def("write", &Picture::write, py::arg("path"), py::call_guard<py::gil_scoped_release>())
        .def("keys", namesOf)
        .def("__getitem__", &Picture::array, py::arg("layer"))
        .def(
            "__contains__", [](const Picture& p, const std::string& name) { return !p.channels(name).empty(); },
            py::arg("layer"))
        .def("__iter__", [](const Picture& p) { return py::iter(py::cast(namesOf(p))); })
        .def("__len__", [](const Picture& p) { return p.layers().size(); })
        .def("__repr__", shownAs);
}

}  // namespace lumulus::python
