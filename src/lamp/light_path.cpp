#include "lamp/light_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/rng.h"

namespace lumulus::lamp {

namespace {

using std::numbers::pi;

/// Events after which a path ends, in fog and among clouds.
constexpr int mostEvents = 300, mostEventsInClouds = 1000;
/// Share of its first weight below which a path goes on by chance.
constexpr double thin = 0.05;
/// LightPaths::leastDistance() over the mean free path, or over the way to a lamp.
constexpr double nearShare = 0.03;
constexpr double farAway = 1e6;  // metres

double sumOf(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

/// Vectors square to a unit vector and to each other.
void squareTo(const glm::dvec3& axis, glm::dvec3& one, glm::dvec3& other) {
    one = glm::normalize(
        glm::cross(axis, std::abs(axis.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0)));
    other = glm::cross(axis, one);
}

glm::dvec3 around(const glm::dvec3& axis, double cosine, double u) {
    glm::dvec3 one, other;
    squareTo(axis, one, other);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), azimuth = 2.0 * pi * u;
    return cosine * axis + sine * (std::cos(azimuth) * one + std::sin(azimuth) * other);
}

/// Henyey–Greenstein.
double cosineOf(double g, double u) {
    if (std::abs(g) < 1e-3) return 2.0 * u - 1.0;
    const double root = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    return std::clamp((1.0 + g * g - root * root) / (2.0 * g), -1.0, 1.0);
}

}  // namespace

struct LightPaths::Walk {
    glm::uvec4 key{0};
    Ray ray;
    glm::dvec3 weight{0.0};
    double first = 0.0;  ///< sum of the weight at the lamp
    int events = 0;
    std::optional<glm::dvec3> surface;  ///< normal of what it is on
    std::optional<std::size_t> cloud;   ///< that it is in

    glm::dvec4 numbers() {
        ++key.y;
        return glm::dvec4(shared::rngUniform4(key)) + 0x1p-25;
    }
};

LightPaths::LightPaths(const Around& around, std::span<const Beam> beams, std::uint64_t count, std::uint64_t seed)
    : haze_(around.haze),
      clouds_(around.clouds),
      ground_(around.ground),
      solids_(around.solids),
      beams_(beams),
      count_(count),
      seed_(seed) {
    double sum = 0.0;
    for (const Beam& beam : beams) upTo_.push_back(sum += sumOf(beam.power()));
    for (double& each : upTo_) each /= sum;
}

/// Each lamp has a share of the paths by its power, one after the other.
bool LightPaths::start(Walk& walk, std::uint64_t path) const {
    const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
    walk.key = {low(path), 0U, 0x1A3BU, shared::rngStream(low(seed_), low(seed_ >> 32U), low(path >> 32U))};
    const double share = (static_cast<double>(path) + 0.5) / static_cast<double>(count_);
    const auto lamp =
        std::min(static_cast<std::size_t>(std::ranges::lower_bound(upTo_, share) - upTo_.begin()), beams_.size() - 1);
    const Beam& beam = beams_[lamp];
    const double chance = upTo_[lamp] - (lamp > 0 ? upTo_[lamp - 1] : 0.0);
    walk.weight = beam.power() / (chance * static_cast<double>(count_));
    walk.first = sumOf(walk.weight);
    walk.ray.origin = beam.position();
    for (int tries = 0; tries < 1000; ++tries)
        if (beam.sample(glm::dvec3(walk.numbers()), walk.ray.direction))
            return !ground_ || beam.position().y > ground_->height;
    return false;
}

/// Takes the path to its next event. Free paths are drawn for one channel, chosen by the weight, and count by the mean
/// density of that choice.
bool LightPaths::step(Walk& walk) const {
    const glm::dvec4 u = walk.numbers();
    const glm::dvec3 chances = walk.weight / sumOf(walk.weight);
    const int channel = u.x < chances.x ? 0 : (u.x < chances.x + chances.y ? 1 : 2);
    const double wanted = -std::log(1.0 - std::min(u.y, 1.0 - 1e-9));
    double low = 0.0, high = farAway;
    const bool falls = ground_ && walk.ray.direction.y < 0.0;
    if (falls) high = std::min(high, (walk.ray.origin.y - ground_->height) / -walk.ray.direction.y);
    const bool grounded = falls && high < farAway;
    const std::optional<SolidMeeting> solid = solids_ != nullptr ? solids_->meet(walk.ray, high) : std::nullopt;
    if (solid) high = solid->metres;
    const std::optional<Meeting> meeting = meetCloud(walk, high);
    if (meeting) high = meeting->metres;
    if (haze_.isClear() || haze_.depth(walk.ray, high)[channel] <= wanted) {
        if (!meeting && solid) return meetSolid(walk, *solid, chances);
        if (!meeting) return grounded && meetGround(walk, high, chances);
        walk.surface.reset();
        walk.cloud = meeting->cloud;
        return goTo(walk, high, clouds_[meeting->cloud].albedo, chances);
    }
    double metres = 0.5 * high;
    const double here = haze_.extinction(walk.ray.origin)[channel];
    if (here > 0.0) metres = std::min(metres, wanted / here);
    for (int i = 0; i < 40; ++i) {
        const double miss = haze_.depth(walk.ray, metres)[channel] - wanted;
        if (std::abs(miss) < 1e-5) break;
        (miss > 0.0 ? high : low) = metres;
        const double slope = haze_.extinction(walk.ray.origin + metres * walk.ray.direction)[channel];
        const double next = slope > 0.0 ? metres - miss / slope : low;
        metres = next > low && next < high ? next : 0.5 * (low + high);
    }
    const glm::dvec3 point = walk.ray.origin + metres * walk.ray.direction, extinction = haze_.extinction(point);
    const glm::dvec3 passed = glm::exp(-haze_.depth(walk.ray, metres));
    const double density = glm::dot(chances, extinction * passed);
    if (!(density > 0.0)) return false;
    walk.weight *= haze_.scattering(point) * passed / density;
    walk.ray.origin = point;
    walk.surface.reset();
    walk.cloud.reset();
    return true;
}

/// The event in a cloud, if there is one before `limit`.
std::optional<Meeting> LightPaths::meetCloud(Walk& walk, double limit) const {
    if (clouds_.empty()) return {};
    return clouds_.meet(walk.ray, limit, [&] { return -std::log(1.0 - std::min(walk.numbers().x, 1.0 - 1e-9)); });
}

/// To something that reflects or scatters at a distance which the fog has let the path pass.
bool LightPaths::goTo(Walk& walk, double metres, const glm::dvec3& albedo, const glm::dvec3& chances) const {
    const glm::dvec3 passed = haze_.isClear() ? glm::dvec3(1.0) : glm::exp(-haze_.depth(walk.ray, metres));
    const double density = glm::dot(chances, passed);
    if (!(density > 0.0)) return false;
    walk.weight *= albedo * passed / density;
    walk.ray.origin += metres * walk.ray.direction;
    return true;
}

bool LightPaths::meetGround(Walk& walk, double metres, const glm::dvec3& chances) const {
    if (!goTo(walk, metres, ground_->albedo, chances)) return false;
    walk.ray.origin.y = ground_->height;
    walk.surface = glm::dvec3(0.0, 1.0, 0.0);
    walk.cloud.reset();
    return true;
}

bool LightPaths::meetSolid(Walk& walk, const SolidMeeting& solid, const glm::dvec3& chances) const {
    constexpr double off = 1e-6;  // of the distances there, so that the next ray does not meet the same
    if (!goTo(walk, solid.metres, solid.albedo, chances)) return false;
    walk.ray.origin +=
        off * (solids_->radius + glm::length(walk.ray.origin - solids_->middle) + solid.metres) * solid.normal;
    walk.surface = solid.normal;
    walk.cloud.reset();
    return true;
}

/// Whether a solid body stands between the event and the eye.
bool LightPaths::hidden(const Walk& walk, const Eye& eye, const glm::dvec3& way, double distance) const {
    if (solids_ == nullptr || eye.solids.empty()) return false;
    if (walk.surface) return solids_->distance({walk.ray.origin, way}, distance).has_value();
    return eye.solids.transmittance(-way, distance) < 0.5;
}

/// What an event sends of the path's light into a direction [1/sr].
glm::dvec3 LightPaths::response(const Walk& walk, const glm::dvec3& direction) const {
    if (walk.surface) return glm::dvec3(std::max(0.0, glm::dot(*walk.surface, direction)) / pi);
    if (walk.cloud) return clouds_[*walk.cloud].phase.between(walk.ray.direction, direction);
    return haze_.turned(walk.ray.origin, glm::dot(walk.ray.direction, direction)) /
           glm::max(haze_.scattering(walk.ray.origin), glm::dvec3(1e-300));
}

double LightPaths::leastDistance(const glm::dvec3& eye) const {
    const double extinction = sumOf(haze_.extinction(eye));
    if (!(extinction > 0.0)) return 0.0;
    double least = 3.0 / extinction;
    for (const Beam& beam : beams_) least = std::min(least, glm::distance(eye, beam.position()));
    return nearShare * least;
}

void LightPaths::show(const Walk& walk, const Eye& eye, const Seen& seen) const {
    const glm::dvec3 way = eye.position - walk.ray.origin;
    const double distance = glm::length(way);
    if (!(distance > 0.0)) return;
    const glm::dvec3 direction = way / distance;
    const double least = eye.least, clear = eye.clouds.transmittance(-direction, distance);
    if (clear < 1e-6 || hidden(walk, eye, direction, distance)) return;
    const glm::dvec3 passed = glm::exp(-haze_.depth({eye.position, -direction}, distance));
    seen(-direction, clear * walk.weight * response(walk, direction) * passed / (distance * distance + least * least),
         walk.cloud.has_value());
}

void LightPaths::turn(Walk& walk) const {
    const glm::dvec4 u = walk.numbers();
    if (walk.cloud) {
        walk.ray.direction = clouds_[*walk.cloud].phase.sample(walk.ray.direction, u);
        return;
    }
    walk.ray.direction = walk.surface
                             ? around(*walk.surface, std::sqrt(u.x), u.y)
                             : around(walk.ray.direction, cosineOf(haze_.meanCosine(walk.ray.origin, u.z), u.x), u.y);
}

void LightPaths::trace(std::uint64_t path, const Eye& eye, const Seen& seen) const {
    Walk walk;
    if (!start(walk, path)) return;
    const int most = clouds_.empty() ? mostEvents : mostEventsInClouds;
    while (walk.events < most && step(walk)) {
        if (++walk.events > 1) show(walk, eye, seen);
        const double left = sumOf(walk.weight) / walk.first;
        if (!(left > 0.0)) return;
        if (left < thin) {
            if (walk.numbers().x > left / thin) return;
            walk.weight *= thin / left;
        }
        turn(walk);
    }
}

}  // namespace lumulus::lamp
