#include "python/toml_value.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "base/error.h"

namespace lumulus::python {
namespace {

namespace py = pybind11;

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
        if (c == '"' || c == '\\') result += '\\';
        result += control ? fmt::format("\\u{:04X}", static_cast<unsigned>(c)) : std::string(1, c);
    }
    return result + '"';
}

std::string numberOf(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
    const std::string text = fmt::format("{}", value);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string arrayOf(const py::handle& values, const std::string& key) {
    std::vector<std::string> texts;
    for (const py::handle value : values) texts.push_back(tomlOf(value, key));
    return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string tableOf(const py::dict& table, const std::string& key) {
    std::vector<std::string> texts;
    for (const auto& [name, value] : table) {
        const std::string path = std::string(py::str(name));
        texts.push_back(fmt::format("{} = {}", quoted(path), tomlOf(value, key + "." + path)));
    }
    return fmt::format("{{{}}}", fmt::join(texts, ", "));
}

}  // namespace

std::string tomlOf(const py::handle& value, const std::string& key) {
    if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
    if (py::isinstance<py::int_>(value)) return std::string(py::str(value));
    if (py::isinstance<py::float_>(value)) return numberOf(value.cast<double>());
    if (py::isinstance<py::str>(value)) return quoted(value.cast<std::string>());
    if (py::isinstance<py::dict>(value)) return tableOf(py::reinterpret_borrow<py::dict>(value), key);
    if (py::hasattr(value, "tolist")) return tomlOf(value.attr("tolist")(), key);  // NumPy
    if (py::hasattr(value, "__fspath__")) return quoted(py::str(value.attr("__fspath__")()).cast<std::string>());
    if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) return arrayOf(value, key);
    throw InputError(fmt::format("a value of type {} is none of a scene", Py_TYPE(value.ptr())->tp_name), key,
                     "give a number, text, True or False, a list or a dict");
}

}  // namespace lumulus::python
