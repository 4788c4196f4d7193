#include "reference/majorant.h"

#include <glm/gtx/component_wise.hpp>

namespace lumulus::reference {
namespace {

/// Edge of a local cell in voxels. Smaller cells cost steps, larger ones null collisions; 6 is fastest in the Disney
/// cloud.
constexpr int localEdge = 6;

/// Interpolation in float may exceed its largest sample by rounding.
constexpr double margin = 1.0 + 1e-6;

}  // namespace

MajorantGrid::MajorantGrid(const Medium& medium, Majorant kind) {
    const glm::ivec3 size = medium.size();
    const int edge = kind == Majorant::local ? localEdge : glm::compMax(size);
    edge_ = edge;
    inverseEdge_ = 1.0 / edge;
    cells_ = (size + edge - 1) / edge;
    for (int z = 0; z < cells_.z; ++z) {
        for (int y = 0; y < cells_.y; ++y) {
            for (int x = 0; x < cells_.x; ++x) {
                const glm::ivec3 low = edge * glm::ivec3(x, y, z);
                const double majorant = margin * medium.extinctionScale() * medium.maximumWithin(low, low + edge);
                bounds_.push_back({majorant, majorant > 0.0 ? 1.0 / majorant : 0.0});
            }
        }
    }
}

}  // namespace lumulus::reference
