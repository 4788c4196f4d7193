#include "reference/air_path.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/ground.h"

namespace lumulus::reference {
namespace {

/// Heights in metres between which each density changes by a factor of e³ at most where it matters, with the corners of
/// the ozone's tent.
constexpr std::array<double, 10> levels{0.0, 1.5e3, 4e3, 7e3, 10e3, 16e3, 25e3, 40e3, 60e3, airTop};

/// Gauss and Legendre's rule of five points on [−1, 1].
constexpr std::array<double, 5> nodes{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                      0.9061798459386640};
constexpr std::array<double, 5> weights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                        0.2369268850561891};

/// Metres for a step of one in u.
double metresPerStep(double lowestRadius, double u) {
    return 2.0 * (lowestRadius + u * u) / std::sqrt(2.0 * lowestRadius + u * u);
}

double dotOf(const AirParts& parts, const glm::dvec3& extinction) {
    return parts.molecules * extinction.x + parts.aerosol * extinction.y + parts.ozone * extinction.z;
}

}  // namespace

AirPath::AirPath(const Ray& ray, double ground, double limit) {
    const glm::dvec3 fromMiddle = ray.origin - glm::dvec3(0.0, ground - planetRadius, 0.0);
    origin_ = glm::dot(fromMiddle, ray.direction);
    lowestRadius_ = glm::length(glm::cross(fromMiddle, ray.direction));
    lowest_ = lowestRadius_ - planetRadius;
    if (lowest_ >= airTop) return;
    const double reach = std::sqrt(airTop - lowest_);
    double end = lengthTo(reach);
    // the ground is where the line comes down to height 0
    if (lowest_ < 0.0 && origin_ < 0.0) end = lengthTo(-std::sqrt(-lowest_));
    begin_ = placeOf(std::max(origin_, lengthTo(-reach)));
    end_ = placeOf(std::min(end, origin_ + limit));
}

double AirPath::lengthTo(double u) const {
    return u * std::sqrt(2.0 * lowestRadius_ + u * u);
}

double AirPath::placeOf(double length) const {
    const double square = length * length;
    const double above = square / (std::sqrt(lowestRadius_ * lowestRadius_ + square) + lowestRadius_);
    return std::copysign(std::sqrt(above), length);
}

/// Calls `visit(from, to)` for the pieces between the levels, until it returns false.
template <typename Visit>
void AirPath::eachPiece(double begin, double end, Visit&& visit) const {
    const auto upTo = [&](double u) {
        if (u <= begin) return true;
        const double to = std::min(u, end);
        const bool goOn = visit(begin, to) && to < end;
        begin = to;
        return goOn;
    };
    if (!(begin < end)) return;
    for (std::size_t i = levels.size(); i-- > 0;) {
        if (levels[i] > lowest_ && !upTo(-std::sqrt(levels[i] - lowest_))) return;
    }
    if (!upTo(0.0)) return;
    for (const double level : levels) {
        if (level > lowest_ && !upTo(std::sqrt(level - lowest_))) return;
    }
    if (begin < end) visit(begin, end);
}

AirParts AirPath::piece(double begin, double end) const {
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    AirParts sum;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double u = middle + half * nodes[i];
        sum += airPartsAt(heightAt(u)) * (half * weights[i] * metresPerStep(lowestRadius_, u));
    }
    return sum;
}

AirParts AirPath::between(double begin, double end) const {
    AirParts sum;
    eachPiece(begin, end, [&](double from, double to) {
        sum += piece(from, to);
        return true;
    });
    return sum;
}

AirPath::Place AirPath::reach(double depth, const glm::dvec3& extinction) const {
    Place place;
    eachPiece(begin_, end_, [&](double from, double to) {
        const AirParts more = piece(from, to);
        const double wanted = depth - dotOf(place.parts, extinction), whole = dotOf(more, extinction);
        if (whole <= wanted) {
            place.parts += more;
            return true;
        }
        // Newton's steps, kept within what is known to hold the place
        double low = from, high = to, u = from + (to - from) * (wanted / whole);
        AirParts part = piece(from, u);
        for (int step = 0; step < 30; ++step) {
            const double miss = dotOf(part, extinction) - wanted;
            (miss > 0.0 ? high : low) = u;
            if (std::abs(miss) <= 1e-10 * whole) break;
            const double slope = dotOf(airPartsAt(heightAt(u)), extinction) * metresPerStep(lowestRadius_, u);
            const double next = u - miss / slope;
            u = next > low && next < high ? next : 0.5 * (low + high);
            part = piece(from, u);
        }
        place.reached = true;
        place.metres = std::max(0.0, lengthTo(u) - origin_);
        place.height = heightAt(u);
        place.parts += part;
        return false;
    });
    return place;
}

}  // namespace lumulus::reference
