#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "scene/phase.h"
#include "scene/wind.h"

/// A procedural field of clouds (docs/fields.md).
namespace lumulus::scene {

enum class FieldKind { cumulus, stratocumulus, cirrus };

struct Field {
    FieldKind kind = FieldKind::cumulus;
    std::string name;
    double cover = 0.3;                ///< share of the area that clouds hide from above
    double base = 1000.0;              ///< height of the clouds' bases, metres
    glm::dvec3 center{0.0};            ///< middle of the area, metres (y is not used)
    glm::dvec3 area{10e3, 0.0, 10e3};  ///< extent of the area along x and z, metres
    double smallest = 200.0;           ///< smallest diameter of a cloud, metres
    double largest = 2000.0;           ///< largest diameter of a cloud, metres
    double exponent = 1.7;             ///< of the power law of the number of clouds by diameter
    int variants = 6;                  ///< density fields that the clouds share
    int resolution = 128;              ///< voxels along the longest side of a variant
    std::uint64_t seed = 1;
    Wind wind;                 ///< with which its clouds drift, each by the middle of its height
    double extinction = 0.08;  ///< 1/m at density 1
    glm::dvec3 albedo{1.0};
    Phase phase;

    bool operator==(const Field&) const = default;
};

}  // namespace lumulus::scene
