#pragma once

#include <vector>

namespace lumulus::fog_light {

/// Associated Legendre functions of an order, times √((l−m)!/(l+m)!), of the degrees 0 to count−1; 0 below the order.
std::vector<double> legendre(int order, int count, double cosine);

}  // namespace lumulus::fog_light
