#include "scene/aerosol.h"

#include <cmath>

namespace lumulus::scene {

std::vector<std::string_view> aerosolNames() {
    std::vector<std::string_view> names;
    for (const Aerosol& aerosol : aerosols) names.push_back(aerosol.name);
    return names;
}

glm::dvec3 relativeExtinction(const Aerosol& aerosol) {
    const auto green = [&](double nanometres) { return std::pow(nanometres / 550.0, -aerosol.exponentGreen); };
    return {green(640.0), green(540.0), green(500.0) * std::pow(440.0 / 500.0, -aerosol.exponentBlue)};
}

}  // namespace lumulus::scene
