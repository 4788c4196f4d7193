#pragma once

#include <glm/glm.hpp>

#include "scene/sky.h"
#include "scene/utc.h"

/// Where sun and moon stand (Meeus 1998, "Astronomical Algorithms"). Angles in degrees, unless a name says otherwise.
namespace lumulus::scene {

/// A place on the ellipsoid of the earth at the height of the sea.
struct Place {
    double latitude = 0.0;   ///< north positive
    double longitude = 0.0;  ///< east positive
};

/// A place in the sky as seen from the earth's centre, equinox of the date.
struct Ecliptic {
    double longitude = 0.0;
    double latitude = 0.0;
    double distance = 0.0;  ///< sun: astronomical units; moon: km
};

/// The apparent sun (ch. 25 with aberration and nutation), within 0.01° from 1950 to 2050. `centuries` of 36525 days
/// since noon of the 1st of January 2000, terrestrial time.
Ecliptic sunPosition(double centuries);

/// The apparent moon by the largest terms of ch. 47: within 0.03° and 100 km from 1950 to 2050.
Ecliptic moonPosition(double centuries);

/// True obliquity of the ecliptic (ch. 22).
double obliquity(double centuries);

/// A place in the sky of an observer.
struct Horizontal {
    double azimuth = 0.0;    ///< clockwise from north
    double elevation = 0.0;  ///< above the horizon, without the refraction of the air
    double distance = 0.0;   ///< as of Ecliptic
};

/// Sun and moon in the sky of a place.
struct SunAndMoon {
    Horizontal sun, moon;
    double moonPhaseAngle = 0.0;  ///< sun–moon–earth: 0 is full, 180 new (ch. 48)
};

/// Positions at a time, seen from the place itself: the moon is up to a degree lower than from the earth's centre.
SunAndMoon sunAndMoonAt(const Utc& utc, const Place& place);

/// Degrees by which the air at 1010 hPa and 10 °C lifts what stands at a true elevation; 0 well below the horizon (Reda
/// and Andreas 2004, "Solar Position Algorithm", eq. 42).
double refraction(double elevation);

/// Where the sun's disc is seen: towards the sun, or higher by `refraction` where the scene asks for that.
glm::dvec3 apparentDirection(const Sun& sun);

/// Illuminance of the moon over that of the sun, both outside of the air: by the magnitude
/// −12.73 + 0.026 |α| + 4e−9 α⁴ of the moon at the phase angle α (Allen; Krisciunas and Schaefer 1991) and −26.74 of
/// the sun.
double moonShare(double phaseAngle);

}  // namespace lumulus::scene
