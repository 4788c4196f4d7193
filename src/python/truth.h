#pragma once

#include <pybind11/pybind11.h>

namespace lumulus::python {

/// The functions `reference` and `compare`.
void defineTruth(pybind11::module_& module);

}  // namespace lumulus::python
