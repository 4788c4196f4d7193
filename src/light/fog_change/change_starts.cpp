#include "light/fog_change/change_starts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::fog_change {

namespace {

using std::numbers::pi;

constexpr double leastShare = 0.1;  ///< of all photons, of the sun and of the rest
constexpr double sunLobe = 0.8;     ///< mean cosine of directions that are chosen about the sun's

/// Numbers that fill five dimensions evenly (the R sequence of Roberts 2018), shifted by a seed.
struct Even {
    std::array<double, 5> u;

    Even(std::uint64_t number, std::uint64_t seed) {
        constexpr double ratio = 1.1347241384015194;  // the root of x⁶ = x + 1
        double step = 1.0;
        for (std::size_t i = 0; i < u.size(); ++i) {
            step /= ratio;
            const double start = std::fmod(
                0.5 + static_cast<double>(seed % 1000003U) * 0.6180339887498949 * (1.0 + static_cast<double>(i)), 1.0);
            u[i] = std::fmod(start + static_cast<double>(number % (std::uint64_t{1} << 40U)) * step, 1.0);
        }
    }
};

double lobe(double cosine) {
    const double away = 1.0 + sunLobe * sunLobe - 2.0 * sunLobe * cosine;
    return (1.0 - sunLobe * sunLobe) / (4.0 * pi * away * std::sqrt(away));
}

double lobeCosine(double u) {
    const double root = (1.0 - sunLobe * sunLobe) / (1.0 - sunLobe + 2.0 * sunLobe * u);
    return (1.0 + sunLobe * sunLobe - root * root) / (2.0 * sunLobe);
}

double strengthOf(const glm::dvec3& light) {
    return (light.x + light.y + light.z) / 3.0;
}

/// Areas of the faces of a box across each axis.
glm::dvec3 facesOf(const glm::dvec3& size) {
    return {size.y * size.z, size.z * size.x, size.x * size.y};
}

glm::dvec3 anyDirection(double u, double v) {
    return turned({0.0, 1.0, 0.0}, 1.0 - 2.0 * u, 2.0 * pi * v);
}

}  // namespace

ChangeStarts::ChangeStarts(const ChangeSources& sources)
    : sources_(sources), size_(sources.clouds.upper() - sources.clouds.lower()) {
    const bool shines = sources.toSun.y > 0.0 && sources.sun != glm::dvec3(0.0);
    const double diffuse = findMean();
    if (shines) {
        const double height = 0.5 * (sources.clouds.lower().y + sources.clouds.upper().y);
        const double beam = strengthOf(sources.sun * sources.fog.sunShare(height)) * seenFromSun();
        const double share = std::clamp(beam / (beam + diffuse), leastShare, 1.0 - leastShare);
        sun_ = static_cast<std::uint64_t>(share * static_cast<double>(sources.starts));
    }
    diffuse_ = sources.starts - sun_;
    towardsSun_ = shines ? 0.5 : 0.0;
    bool absorbs = sources.medium.albedo != glm::dvec3(1.0);
    for (const fog_light::FogLayer& layer : sources.fog.fog.layers())
        absorbs = absorbs || layer.absorption != glm::dvec3(0.0);
    absorbed_ = absorbs ? diffuse_ / 2 : 0;
}

/// Area of the box as the sun sees it [m²].
double ChangeStarts::seenFromSun() const {
    return glm::dot(glm::abs(sources_.toSun), facesOf(size_));
}

/// A place on the box; `areas`: of the faces across each axis, with which they are chosen. Of the axes whose sign is
/// set in `face` above ½ the upper one.
ChangeStarts::Place ChangeStarts::onBox(const glm::dvec3& areas, double face, double u, double v) const {
    const double whole = areas.x + areas.y + areas.z;
    double at = face * whole;
    int axis = 0;
    while (axis < 2 && at >= areas[axis]) at -= areas[axis++];
    const bool upper = at < 0.5 * areas[axis];
    glm::dvec3 share(u, u, u);
    share[(axis + 1) % 3] = v;
    share[axis] = upper ? 1.0 : 0.0;
    Place place{sources_.clouds.lower() + share * size_, glm::dvec3(0.0)};
    place.inwards[axis] = upper ? -1.0 : 1.0;
    return place;
}

double ChangeStarts::density(const glm::dvec3& direction, const glm::dvec3& inwards) const {
    return (1.0 - towardsSun_) * std::max(0.0, glm::dot(direction, inwards)) / pi +
           towardsSun_ * (towardsSun_ > 0.0 ? lobe(-glm::dot(direction, sources_.toSun)) : 0.0);
}

/// Finds the mean radiance on the box. Returns the power by which light differs from it there [W].
double ChangeStarts::findMean() {
    constexpr int samples = 2048;
    std::vector<glm::dvec3> found;
    const glm::dvec3 areas = facesOf(size_);
    for (int i = 0; i < samples; ++i) {
        const Even even(static_cast<std::uint64_t>(i), 0);
        const Place place = onBox(areas, even.u[0], even.u[1], even.u[2]);
        const glm::dvec3 direction = turned(place.inwards, std::sqrt(even.u[3]), 2.0 * pi * even.u[4]);
        found.push_back(sources_.fog.radiance(place.position.y, -direction));
        mean_ += found.back() / static_cast<double>(samples);
    }
    double differs = 0.0;
    for (const glm::dvec3& radiance : found) differs += strengthOf(glm::abs(radiance - mean_)) / samples;
    return 2.0 * (areas.x + areas.y + areas.z) * pi * differs;
}

void ChangeStarts::follow(std::uint64_t number, PairWalk& walk) const {
    if (number < sun_)
        followSun(number, walk);
    else if (number < sun_ + diffuse_)
        followDiffuse(number - sun_, walk);
    else
        followAbsorbed(number - sun_ - diffuse_, walk);
}

void ChangeStarts::followSun(std::uint64_t number, PairWalk& walk) const {
    const Even even(number, sources_.seed);
    Numbers numbers(sources_.seed, number);
    const glm::dvec3 seen = glm::abs(sources_.toSun) * facesOf(size_);
    Place place = onBox(seen, even.u[0], even.u[1], even.u[2]);
    for (int axis = 0; axis < 3; ++axis)
        if (place.inwards[axis] != 0.0)  // of the two faces the one that the sun sees
            place.position[axis] =
                sources_.toSun[axis] > 0.0 ? sources_.clouds.upper()[axis] : sources_.clouds.lower()[axis];
    Photon photon{place.position, -sources_.toSun, {}, glm::dvec3(0.0)};
    walk.follow(
        photon,
        [&] {
            return sources_.sun * sources_.fog.sunShare(place.position.y) * seenFromSun() / static_cast<double>(sun_);
        },
        numbers);
}

void ChangeStarts::followDiffuse(std::uint64_t number, PairWalk& walk) const {
    const Even even(number, sources_.seed + 1);
    Numbers numbers(sources_.seed, sun_ + number);
    const glm::dvec3 areas = facesOf(size_);
    const Place place = onBox(areas, even.u[0], even.u[1], even.u[2]);
    const bool aboutSun = numbers.next() < towardsSun_;
    const glm::dvec3 direction = aboutSun ? turned(-sources_.toSun, lobeCosine(even.u[3]), 2.0 * pi * even.u[4])
                                          : turned(place.inwards, std::sqrt(even.u[3]), 2.0 * pi * even.u[4]);
    const double cosine = glm::dot(direction, place.inwards);
    if (!(cosine > 0.0)) return;
    const double area = 2.0 * (areas.x + areas.y + areas.z);
    const double scale = area * cosine / (density(direction, place.inwards) * static_cast<double>(diffuse_));
    walk.follow(
        {place.position, direction, {}, {}},
        [&] { return scale * (sources_.fog.radiance(place.position.y, -direction) - mean_); }, numbers);
}

/// What absorbs in the box takes from the mean radiance too: clouds all that they absorb, fog what it absorbs more or
/// less than without them.
void ChangeStarts::followAbsorbed(std::uint64_t number, PairWalk& walk) const {
    const Even even(number, sources_.seed + 2);
    Numbers numbers(sources_.seed, sun_ + diffuse_ + number);
    const Photon photon{sources_.clouds.lower() + size_ * glm::dvec3(even.u[0], even.u[1], even.u[2]),
                        anyDirection(even.u[3], even.u[4]),
                        {},
                        {}};
    const double volume = size_.x * size_.y * size_.z / static_cast<double>(absorbed_);
    const glm::dvec3 whole = -4.0 * pi * volume * mean_;
    const double extinction = sources_.clouds.extinctionAt(photon.position);
    const glm::dvec3 inCloud = extinction * (1.0 - sources_.medium.albedo);
    if (inCloud != glm::dvec3(0.0)) {
        Photon alone = photon;
        alone.light = whole * inCloud;
        walk.followAlone(alone, numbers);
    }
    glm::dvec3 inFog(0.0);
    for (const fog_light::FogLayer& layer : sources_.fog.fog.layers())
        inFog += layer.absorption * layer.density(photon.position.y);
    if (inFog != glm::dvec3(0.0))
        walk.follow(
            photon, [&] { return whole * inFog; }, numbers);
}

}  // namespace lumulus::fog_change
