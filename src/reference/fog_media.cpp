#include "reference/fog_media.h"

#include <algorithm>

#include "reference/fog_on_ray.h"

namespace lumulus::reference {
namespace {

PhaseFunction phaseOf(const scene::FogMedium& medium) {
    scene::Phase phase;
    phase.model = scene::PhaseModel::henyeyGreenstein;
    phase.g = medium.g;
    return PhaseFunction(phase);
}

}  // namespace

template <typename Light>
FogMedia<Light>::FogMedia(const scene::Fog& fog, const Spread& coefficient, const Spread& emission,
                          const std::optional<double>& planet)
    : planet_(planet) {
    for (const scene::FogMedium& from : fog.media) {
        media_.push_back({from, coefficient(from.scattering), coefficient(from.scattering + from.absorption),
                          emission(from.emission), phaseOf(from)});
    }
}

template <typename Light>
Light FogMedia<Light>::opticalDepth(const Ray& ray, double metres) const {
    Light depth(0.0);
    for (const Medium& m : media_) depth += m.extinction * FogOnRay(m.shape, ray, planet_).pathTo(metres);
    return depth;
}

template <typename Light>
std::optional<HazeCollision> FogMedia<Light>::collide(const Ray& ray, double limit, int channel, Random& random) const {
    HazeCollision first{limit, media_.size()};
    for (std::size_t i = 0; i < media_.size(); ++i) {
        const double extinction = media_[i].extinction[channel];
        if (!(extinction > 0.0)) continue;
        const double metres = FogOnRay(media_[i].shape, ray, planet_).metresTo(random.exponential() / extinction);
        if (metres < first.metres) first = {metres, i};
    }
    if (first.medium == media_.size()) return std::nullopt;
    return first;
}

template <typename Light>
Light FogMedia<Light>::emitted(const Ray& ray, double metres, const std::function<Light(double)>& passed,
                               Random& random) const {
    Light radiance(0.0);
    for (const Medium& m : media_) {
        if (m.emission == Light(0.0)) continue;
        const FogOnRay density(m.shape, ray, planet_);
        const double path = density.pathTo(metres);
        if (!(path > 0.0)) continue;
        // a point drawn by the density; the end of the path has the mean transmittance to it already
        const double point = std::min(metres, density.metresTo(path * random.uniform()));
        radiance += m.emission * path * passed(point);
    }
    return radiance;
}

template class FogMedia<glm::dvec3>;
template class FogMedia<Four>;

}  // namespace lumulus::reference
