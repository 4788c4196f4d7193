#include "vdb/transform.h"

#include <cmath>

#include "base/error.h"

namespace lumulus::vdb {
namespace {

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool singular(const glm::dmat3& linear) {
    constexpr double smallest = 1e-12;
    glm::dmat3 directions = linear;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(linear[axis]);
        if (!(length > 0.0)) return true;
        directions[axis] /= length;
    }
    return !(std::abs(glm::determinant(directions)) > smallest);
}

}  // namespace

Affine composeTransforms(const glm::dmat4& outer, const Affine& inner, const std::string& where) {
    const glm::dvec4 bottom(outer[0][3], outer[1][3], outer[2][3], outer[3][3]);
    if (bottom != glm::dvec4(0.0, 0.0, 0.0, 1.0)) {
        throw InputError("the cloud's transform is not affine", where, "make the last row of the matrix 0, 0, 0, 1");
    }
    const glm::dmat3 linear(outer);
    Affine whole;
    whole.linear = linear * inner.linear;
    whole.translation = linear * inner.translation + glm::dvec3(outer[3]);
    if (!finite(whole.linear[0]) || !finite(whole.linear[1]) || !finite(whole.linear[2]) ||
        !finite(whole.translation)) {
        throw InputError("the cloud's transform holds numbers that are not finite", where, "give finite numbers");
    }
    if (singular(whole.linear)) {
        throw InputError("the cloud's transform is singular: it squeezes the cloud flat", where,
                         "give every axis a scale and a direction of its own");
    }
    return whole;
}

}  // namespace lumulus::vdb
