#pragma once

#include <glm/glm.hpp>
#include <string>

#include "vdb/volume.h"

namespace lumulus::vdb {

/// The transform `outer` after `inner`. Throws InputError with the place `where` unless `outer` is affine, all numbers
/// are finite and the result has a volume: |det| above 1e-12 of the product of its columns' lengths, a bound that does
/// not depend on units.
Affine composeTransforms(const glm::dmat4& outer, const Affine& inner, const std::string& where);

/// `outer` applied after `inner`; neither is checked.
inline Affine composed(const Affine& outer, const Affine& inner) {
    return {outer.linear * inner.linear, outer.point(inner.translation)};
}

}  // namespace lumulus::vdb
