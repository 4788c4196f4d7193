#pragma once

#include <pybind11/pybind11.h>

namespace lumulus::python {

/// The class Renderer and the function `render`.
void defineRenderer(pybind11::module_& module);

}  // namespace lumulus::python
