#include "scene/utc.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace lumulus::scene {
namespace {

/// Takes a number of exactly `digits` digits off the text.
std::optional<int> takeDigits(std::string_view& text, std::size_t digits) {
    if (text.size() < digits) return std::nullopt;
    int value = 0;
    for (const char c : text.substr(0, digits)) {
        if (c < '0' || c > '9') return std::nullopt;
        value = 10 * value + (c - '0');
    }
    text.remove_prefix(digits);
    return value;
}

bool take(std::string_view& text, char c) {
    if (text.empty() || text.front() != c) return false;
    text.remove_prefix(1);
    return true;
}

int daysOf(int year, int month) {
    constexpr std::array days{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    return days.at(static_cast<std::size_t>(month - 1)) + (month == 2 && leap ? 1 : 0);
}

/// Seconds with an optional fraction.
std::optional<double> takeSeconds(std::string_view& text) {
    const auto whole = takeDigits(text, 2);
    if (!whole) return std::nullopt;
    double seconds = *whole, unit = 1.0;
    if (!take(text, '.')) return seconds;
    if (text.empty() || text.front() < '0' || text.front() > '9') return std::nullopt;
    while (!text.empty() && text.front() >= '0' && text.front() <= '9') {
        unit *= 0.1;
        seconds += unit * (text.front() - '0');
        text.remove_prefix(1);
    }
    return seconds;
}

}  // namespace

std::optional<Utc> parseUtc(std::string_view text) {
    const auto year = takeDigits(text, 4);
    if (!year || !take(text, '-')) return std::nullopt;
    const auto month = takeDigits(text, 2);
    if (!month || !take(text, '-')) return std::nullopt;
    const auto day = takeDigits(text, 2);
    if (!day || !take(text, 'T')) return std::nullopt;
    const auto hour = takeDigits(text, 2);
    if (!hour || !take(text, ':')) return std::nullopt;
    const auto minute = takeDigits(text, 2);
    if (!minute) return std::nullopt;
    std::optional<double> second = 0.0;
    if (take(text, ':')) second = takeSeconds(text);
    if (!second || !take(text, 'Z') || !text.empty()) return std::nullopt;
    if (*month < 1 || *month > 12 || *day < 1 || *day > daysOf(*year, *month)) return std::nullopt;
    if (*hour > 23 || *minute > 59 || *second >= 60.0) return std::nullopt;
    return Utc{*year, *month, *day, *hour + *minute / 60.0 + *second / 3600.0};
}

double Utc::julianDay() const {
    // Meeus 1998, ch. 7, for the Gregorian calendar
    const int y = month > 2 ? year : year - 1, m = month > 2 ? month : month + 12;
    const int century = y / 100;
    return std::floor(365.25 * (y + 4716)) + std::floor(30.6001 * (m + 1)) + day + 2 - century + century / 4 - 1524.5 +
           hours / 24.0;
}

double deltaT(double julianDay) {
    const double year = 2000.0 + (julianDay - 2451545.0) / 365.25;
    if (year < 1961.0) {
        const double t = year - 1950.0;
        return 29.07 + 0.407 * t - t * t / 233.0 + t * t * t / 2547.0;
    }
    if (year < 1986.0) {
        const double t = year - 1975.0;
        return 45.45 + 1.067 * t - t * t / 260.0 - t * t * t / 718.0;
    }
    const double t = year - 2000.0;
    if (year < 2005.0)
        return 63.86 + t * (0.3345 + t * (-0.060374 + t * (0.0017275 + t * (0.000651814 + t * 0.00002373599))));
    return 62.92 + 0.32217 * t + 0.005589 * t * t;
}

}  // namespace lumulus::scene
