#include "reference/air.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/ground.h"

namespace lumulus::reference {
namespace {

constexpr std::size_t moleculesPart = 0, aerosolPart = 1;

double sumOf(const Four& v) {
    return (v.x + v.y) + (v.z + v.w);
}

PhaseFunction ofMolecules() {
    scene::Phase phase;
    phase.model = scene::PhaseModel::rayleigh;
    return PhaseFunction(phase);
}

/// A wavelength with the probability of its share in the throughput.
int wavelengthOf(const Four& throughput, Random& random) {
    double left = random.uniform() * sumOf(throughput);
    int last = 0;
    for (int i = 0; i < 4; ++i) {
        if (!(throughput[i] > 0.0)) continue;
        last = i;
        left -= throughput[i];
        if (left < 0.0) break;
    }
    return last;
}

/// e^−depth over that of the clearest wavelength that has light, so that it does not underflow; 0 without light.
Four relativeTransmittance(const Four& depth, const Four& throughput) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 4; ++i) {
        if (throughput[i] > 0.0) least = std::min(least, depth[i]);
    }
    Four result(0.0);
    for (int i = 0; i < 4; ++i) {
        if (throughput[i] > 0.0) result[i] = std::exp(least - depth[i]);
    }
    return result;
}

}  // namespace

Air::Air(const AirMedium& medium, double ground)
    : medium_(medium), ground_(ground), phases_{ofMolecules(), PhaseFunction::cornetteShanks(medium.aerosolG)} {}

double Air::heightAt(const glm::dvec3& point) const {
    return glm::distance(point, {0.0, ground_ - planetRadius, 0.0}) - planetRadius;
}

Four Air::scatteringOf(std::size_t part, double height) const {
    const AirParts parts = airPartsAt(height);
    return part == moleculesPart ? parts.molecules * medium_.molecules : parts.aerosol * medium_.aerosolScattering;
}

Four Air::opticalDepth(const Ray& ray, double metres) const {
    return medium_.extinction(AirPath(ray, ground_, metres).whole());
}

Four Air::transmittance(const Ray& ray, double metres) const {
    return glm::exp(-opticalDepth(ray, metres));
}

std::optional<HazeCollision> Air::collide(const Ray& ray, double limit, const Four& throughput, Random& random) const {
    const int i = wavelengthOf(throughput, random);
    const glm::dvec3 extinction(medium_.molecules[i], medium_.aerosol[i], medium_.ozone[i]);
    const AirPath::Place place = AirPath(ray, ground_, limit).reach(random.exponential(), extinction);
    if (!place.reached || !(place.metres < limit)) return std::nullopt;
    const double molecules = scatteringOf(moleculesPart, place.height)[i];
    const double both = molecules + scatteringOf(aerosolPart, place.height)[i];
    return HazeCollision{place.metres, random.uniform() * both < molecules ? moleculesPart : aerosolPart};
}

Four Air::passed(const Ray& ray, double metres, const Four& throughput) const {
    const Four left = throughput * relativeTransmittance(opticalDepth(ray, metres), throughput);
    return left * (sumOf(throughput) / sumOf(left));
}

Four Air::scattered(const Ray& ray, const HazeCollision& collision, const Four& throughput) const {
    const Four left = throughput * relativeTransmittance(opticalDepth(ray, collision.metres), throughput);
    const double height = heightAt(ray.origin + collision.metres * ray.direction);
    const AirParts parts = airPartsAt(height);
    const Four scattering = scatteringOf(collision.medium, height);
    // the density of a collision, times the chance of this part among those that scatter
    const Four density = medium_.extinction(parts) * scattering / glm::max(medium_.scattering(parts), 1e-300);
    const double all = sumOf(left * density);
    return all > 0.0 ? left * scattering * (sumOf(throughput) / all) : Four(0.0);
}

}  // namespace lumulus::reference
