#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace lumulus::python {

/// A value of Python (bool, number, text, path, sequence, dict, NumPy) as TOML. Errors: InputError that names the key,
/// for values of other types.
std::string tomlOf(const pybind11::handle& value, const std::string& key);

}  // namespace lumulus::python
