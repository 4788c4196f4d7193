#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/field.h"
#include "scene/places.h"

namespace lumulus {

/// One cloud of a field.
struct FieldPlace {
    int variant = 0;
    scene::Place place;
    double middle = 0.0;  ///< height of the middle between its base and its top [m]
};

/// The procedural cloud that a field is made of.
std::string proceduralKind(scene::FieldKind kind);
/// The seed of a variant of a field.
std::uint64_t variantSeed(const scene::Field& field, int variant);

/// Optical thickness from which on a column counts as covered: thinner cirrus are not seen (Sassen and Cho 1992).
inline constexpr double visibleThickness = 0.03;

/// Places the clouds of a field, so that they cover the share `cover` of its area within 0.01, seen from above.
///
/// Cumuli and cirri: diameters (of a circle with the area of the cloud) follow the power law n(D) ∝ D^-exponent between
/// `smallest` and `largest` (Neggers et al. 2003, Benner and Curry 1998). Places are drawn by best candidates (Mitchell
/// 1991): clouds keep apart and gather where a noise of several kilometres, drawn out along the wind, is high.
/// Stratocumuli: cells on a jittered hexagonal grid; an open deck has gaps where such a noise is low.
/// The same field gives the same places everywhere. Errors: InputError for more clouds than `most`, with both numbers.
std::vector<FieldPlace> placesOf(const scene::Field& field, const std::string& name, std::size_t most);

}  // namespace lumulus
