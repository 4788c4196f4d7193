#pragma once

#include "base/image.h"
#include "base/interrupt.h"

namespace lumulus::prefilter {

enum class BrdfModel { ggx, cookTorrance };

/// What a surface reflects of a prefiltered map, as size × size pixels: n·v at (x + ½) / size, roughness at
/// (y + ½) / size from the top. Layer R is the scale of the reflectance at normal incidence, G the bias (Karis 2013),
/// and R + G the energy E of Turquin (2019). `ggx`: alpha is roughness²; `cookTorrance`: alpha is roughness, with
/// Beckmann's distribution. Within 0.2 % of 1. Errors: what `check` throws, on any thread.
LayeredImage brdfTable(BrdfModel model, int size, const Check& check);

}  // namespace lumulus::prefilter
