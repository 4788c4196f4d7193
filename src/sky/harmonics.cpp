#include "sky/harmonics.h"

namespace lumulus::sky {

HeightFactors heightFactors(double up) {
    const double up2 = up * up;
    const std::array<double, harmonicCount> factors{meanHarmonic,
                                                    0.48860251190291992 * up,
                                                    0.48860251190291992,
                                                    0.31539156525252005 * (3.0 * up2 - 1.0),
                                                    1.0925484305920792 * up,
                                                    0.54627421529603959,
                                                    0.37317633259011546 * up * (5.0 * up2 - 3.0),
                                                    0.45704579946446577 * (5.0 * up2 - 1.0),
                                                    1.4453057213202771 * up,
                                                    0.59004358992664352,
                                                    0.10578554691520431 * (35.0 * up2 * up2 - 30.0 * up2 + 3.0),
                                                    0.66904654355728921 * up * (7.0 * up2 - 3.0),
                                                    0.47308734787878004 * (7.0 * up2 - 1.0),
                                                    1.7701307697799304 * up,
                                                    0.62583573544917614};
    HeightFactors result{};
    for (std::size_t i = 0; i < harmonicCount; ++i) result[i] = static_cast<float>(factors[i]);
    return result;
}

}  // namespace lumulus::sky
