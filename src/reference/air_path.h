#pragma once

#include <glm/glm.hpp>

#include "reference/air_medium.h"
#include "view/camera.h"

namespace lumulus::reference {

/// A ray through the shell of air around the planet. Its places are counted by u, where the height is that of the
/// ray's lowest point (of the whole line) plus u²: with it the densities are smooth along any ray, level or steep, and
/// heights keep their digits. u is negative before the lowest point.
class AirPath {
  public:
    /// `ground`: y of the ground at x = z = 0 in metres. The path is the part of the ray in the air, from its origin to
    /// `limit` metres at most, and ends where it meets the ground.
    AirPath(const Ray& ray, double ground, double limit);

    bool empty() const { return !(begin_ < end_); }

    /// Integral of the densities along the whole path. Gauss's rule between heights at which the densities change
    /// little: relative error below 1e-6.
    AirParts whole() const { return between(begin_, end_); }

    /// The place where the optical depth from the begin of the path reaches `depth`.
    struct Place {
        bool reached = false;  ///< false: the path ends before
        double metres = 0.0;   ///< from the ray's origin
        double height = 0.0;   ///< above the ground, metres
        AirParts parts;        ///< integral of the densities up to there; of the whole path where it ends before
    };
    /// `extinction`: of the three parts at one wavelength, 1/m.
    Place reach(double depth, const glm::dvec3& extinction) const;

  private:
    template <typename Visit>
    void eachPiece(double begin, double end, Visit&& visit) const;
    AirParts between(double begin, double end) const;
    AirParts piece(double begin, double end) const;

    double heightAt(double u) const { return lowest_ + u * u; }
    /// Metres along the line, from its lowest point.
    double lengthTo(double u) const;
    double placeOf(double length) const;

    double lowest_;        ///< height of the line's lowest point above the ground, metres
    double lowestRadius_;  ///< its distance from the planet's middle, metres
    double origin_;        ///< of the ray, as a length from the lowest point, metres
    double begin_ = 0.0;   ///< places
    double end_ = 0.0;
};

}  // namespace lumulus::reference
