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

std::optional<double> visibilityOf(const glm::dvec3& extinction) {
    const double green = extinction.y;
    if (!(green > 0.0)) return std::nullopt;
    const double exponent = extinction.x > 0.0 ? -std::log(extinction.x / green) / std::log(640.0 / 540.0) : 0.0;
    return koschmieder / (green * std::pow(550.0 / 540.0, -exponent));
}

}  // namespace lumulus::scene
