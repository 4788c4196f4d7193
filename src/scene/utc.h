#pragma once

#include <optional>
#include <string_view>

/// Points in time as astronomers count them.
namespace lumulus::scene {

inline constexpr int firstYear = 1950, lastYear = 2050;  ///< between which sun and moon are good to 0.01° and 0.1°

/// A date of the Gregorian calendar with a time of the day, universal time.
struct Utc {
    int year = 2000, month = 1, day = 1;
    double hours = 12.0;  ///< since midnight

    /// Days since noon of the 1st of January, 4713 BC.
    double julianDay() const;
};

/// Reads "2026-06-21T10:00:00Z"; seconds may be left out or have a fraction. Nothing for what is no such time.
std::optional<Utc> parseUtc(std::string_view text);

/// Terrestrial time − universal time, seconds, by the polynomials of Espenak and Meeus (2006), 1941 to 2050.
double deltaT(double julianDay);

}  // namespace lumulus::scene
