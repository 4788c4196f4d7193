#include "light/fog_change/pair_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::fog_change {

namespace {

using std::numbers::pi;

constexpr int mostEvents = 4000;
/// Light walks so far beyond the widest square of cells, in half its width.
constexpr double beyond = 1.5;
/// Share of its first power below which light goes on by chance.
constexpr double faint = 0.1;

double strengthOf(const glm::dvec3& light) {
    return std::max({std::abs(light.x), std::abs(light.y), std::abs(light.z)});
}

}  // namespace

glm::dvec3 turned(const glm::dvec3& direction, double cosine, double azimuth) {
    // a basis about a direction (Duff et al. 2017)
    const double s = direction.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (s + direction.z), b = direction.x * direction.y * a;
    const glm::dvec3 tangent(1.0 + s * direction.x * direction.x * a, s * b, -s * direction.x);
    const glm::dvec3 other(b, s + direction.y * direction.y * a, -direction.y);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return glm::normalize(cosine * direction + sine * (std::cos(azimuth) * tangent + std::sin(azimuth) * other));
}

void PairWalk::scatterInFog(Photon& photon, std::size_t layer, Numbers& numbers) const {
    const WalkedLayer& walked = world_.fog.layers()[layer];
    photon.light *= walked.scattering / walked.walked;
    photon.beam.reset();
    const double cosine = walked.phase.sampleCosine(numbers.next());
    photon.direction = turned(photon.direction, cosine, 2.0 * pi * numbers.next());
}

void PairWalk::scatterInCloud(Photon& photon, Numbers& numbers) const {
    photon.light *= world_.medium.albedo;
    photon.beam.reset();
    const double cosine = world_.medium.sampleCosine(numbers.next());
    photon.direction = turned(photon.direction, cosine, 2.0 * pi * numbers.next());
}

/// Takes a photon along its way; its colours have met more or less than what it walks by.
void PairWalk::go(Photon& photon, double length, bool leave, Numbers& numbers) {
    if (leave) leaveOnWay(photon, length, numbers);
    const double height = photon.position.y, rise = photon.direction.y;
    if (photon.beam) *photon.beam += world_.fog.peakDepth(height, rise, length);
    if (!world_.fog.isGrey()) photon.light *= glm::exp(-world_.fog.excessDepth(height, rise, length));
    photon.position += length * photon.direction;
}

void PairWalk::follow(Photon photon, const std::function<glm::dvec3()>& lightOf, Numbers& numbers) {
    photon.light = glm::dvec3(1.0);
    for (int event = 0; event < mostEvents; ++event) {
        const glm::dvec2 part =
            partInBox(world_.clouds.lower(), world_.clouds.upper(), photon.position, photon.direction);
        const double end = std::max(0.0, part.y);
        const auto inFog =
            world_.fog.collision(photon.position.y, photon.direction.y, end, [&] { return numbers.depth(); });
        const auto inCloud =
            world_.clouds.collision(photon.position, photon.direction, inFog ? inFog->distance : end, numbers.depth());
        if (inCloud) {
            go(photon, *inCloud, false, numbers);
            photon.light *= lightOf();
            Photon other = photon;
            other.light = -other.light;
            walk(other, true, numbers);
            scatterInCloud(photon, numbers);
            walk(photon, false, numbers);
            return;
        }
        if (!inFog) return;
        go(photon, inFog->distance, false, numbers);
        scatterInFog(photon, inFog->layer, numbers);
    }
}

void PairWalk::followAlone(const Photon& photon, Numbers& numbers) {
    walk(photon, false, numbers);
}

/// How far a photon may go without meeting anything, and whether the ground is there.
double PairWalk::reachOf(const Photon& photon, bool& toGround) const {
    const double wide = beyond * world_.cells.halfWidth(ChangeCells::levels - 1);
    const glm::dvec2& middle = world_.cells.middle();
    const double lowest = world_.ground ? *world_.ground : std::min(world_.cells.bottom(), world_.clouds.lower().y);
    const double highest = std::max(world_.cells.top(), world_.clouds.upper().y);
    const glm::dvec2 part = partInBox({middle.x - wide, lowest, middle.y - wide},
                                      {middle.x + wide, highest, middle.y + wide}, photon.position, photon.direction);
    const double reach = std::max(0.0, part.y);
    toGround = world_.ground && photon.direction.y < 0.0 &&
               photon.position.y + reach * photon.direction.y < lowest + 1e-6 * (highest - lowest) + 1e-9;
    return reach;
}

void PairWalk::walk(Photon photon, bool withoutCloud, Numbers& numbers) {
    const double first = strengthOf(photon.light);
    for (int event = 0; event < mostEvents; ++event) {
        bool toGround = false;
        const double reach = reachOf(photon, toGround);
        if (!(reach > 0.0) && !toGround) return;
        const auto inFog =
            world_.fog.collision(photon.position.y, photon.direction.y, reach, [&] { return numbers.depth(); });
        const double way = inFog ? inFog->distance : reach;
        std::optional<double> inCloud;
        if (!withoutCloud) inCloud = world_.clouds.collision(photon.position, photon.direction, way, numbers.depth());
        go(photon, inCloud ? *inCloud : way, true, numbers);
        if (inCloud) {
            scatterInCloud(photon, numbers);
        } else if (inFog) {
            scatterInFog(photon, inFog->layer, numbers);
        } else if (toGround) {
            photon.light *= world_.groundAlbedo;
            photon.beam.reset();
            photon.position.y = *world_.ground;
            photon.direction = turned({0.0, 1.0, 0.0}, std::sqrt(numbers.next()), 2.0 * pi * numbers.next());
        } else {
            return;
        }
        if (withoutCloud && !world_.clouds.contains(photon.position)) withoutCloud = false;
        const double strength = strengthOf(photon.light);
        if (!(strength > 0.0)) return;
        if (strength < faint * first) {
            if (numbers.next() * faint * first >= strength) return;
            photon.light *= faint * first / strength;
        }
    }
}

/// Leaves a photon's light in the cells on its way: in each of the squares beyond the finer one.
void PairWalk::leaveOnWay(const Photon& photon, double length, Numbers& numbers) {
    const ChangeCells& cells = world_.cells;
    const auto partIn = [&](int level) {
        const double half = cells.halfWidth(level);
        const glm::dvec3 lower(cells.middle().x - half, cells.bottom(), cells.middle().y - half);
        const glm::dvec3 upper(cells.middle().x + half, cells.top(), cells.middle().y + half);
        glm::dvec2 part = partInBox(lower, upper, photon.position, photon.direction);
        part.y = std::min(part.y, length);
        return part.x < part.y ? part : glm::dvec2(0.0);
    };
    glm::dvec2 inner(0.0);
    for (int level = 0; level < ChangeCells::levels; ++level) {
        const glm::dvec2 part = partIn(level);
        if (part.x < part.y) {
            if (inner.x < inner.y) {
                leaveOnPart(photon, level, part.x, inner.x, numbers);
                leaveOnPart(photon, level, inner.y, part.y, numbers);
            } else {
                leaveOnPart(photon, level, part.x, part.y, numbers);
            }
            inner = part;
        }
    }
}

void PairWalk::leaveOnPart(const Photon& photon, int level, double from, double to, Numbers& numbers) {
    if (!(to > from)) return;
    const double step = world_.cells.edge(level), height = photon.position.y, rise = photon.direction.y;
    for (double at = from + step * numbers.next(); at < to; at += step) {
        glm::dvec3 light = photon.light;
        if (!world_.fog.isGrey()) light *= glm::exp(-world_.fog.excessDepth(height, rise, at));
        // what no peak has scattered is no part of this
        Passing passing{world_.cells.cellAt(level, photon.position + at * photon.direction),
                        glm::vec3(photon.direction)};
        const double scale = step / world_.cells.volume(passing.cell);
        if (photon.beam) {
            passing.isBeam = true;
            const glm::dvec3 depth = *photon.beam + world_.fog.peakDepth(height, rise, at);
            passing.straight = glm::vec3(scale * light * glm::exp(-depth));
        }
        passing.light = glm::vec3(scale * light);
        passing_.push_back(passing);
    }
}

}  // namespace lumulus::fog_change
