#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "surface/material/microfacet.h"

namespace lumulus::material {

/// What a surface of microfacets sends back of light that is the same from everywhere, without what facets send to one
/// another: reflectance · scale + bias (Karis 2013), with the reflectance at normal incidence.
struct SplitSum {
    double scale = 0.0, bias = 0.0;

    /// Of a perfect mirror: E of Turquin (2019).
    double energy() const { return scale + bias; }
};

/// By quadrature with this many points (0.1 % with 1024). `cosView` > 0.
SplitSum splitSum(Microfacets kind, double cosView, double alpha, std::uint32_t points = 1024);

/// Split sums in a table, bilinear in √cosView and √alpha; within 0.5 % of splitSum(). It never changes.
class EnergyTable {
  public:
    explicit EnergyTable(Microfacets kind);

    Microfacets kind() const { return kind_; }
    SplitSum at(double cosView, double alpha) const;

  private:
    static constexpr int nodes_ = 64;
    Microfacets kind_;
    std::vector<SplitSum> values_;  ///< cosView fastest
};

}  // namespace lumulus::material
