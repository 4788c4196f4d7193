#include "reference/air.h"

#include <algorithm>
#include <cmath>

#include "reference/ground.h"
#include "reference/spectrum.h"

namespace lumulus::reference {
namespace {

constexpr std::size_t moleculesPart = 0, aerosolPart = 1;

PhaseFunction ofMolecules() {
    scene::Phase phase;
    phase.model = scene::PhaseModel::rayleigh;
    return PhaseFunction(phase);
}

}  // namespace

Air::Air(const AirMedium& medium, double ground, const FogMedia<Four>& fog, const glm::dvec2& foot)
    : medium_(medium),
      ground_(ground),
      foot_(foot.x, 0.0, foot.y),
      phases_{ofMolecules(), PhaseFunction::cornetteShanks(medium.aerosolG)},
      fog_(fog) {}

double Air::heightAt(const glm::dvec3& point) const {
    return glm::distance(point - foot_, {0.0, ground_ - planetRadius, 0.0}) - planetRadius;
}

Four Air::scatteringOf(std::size_t part, double height) const {
    const AirParts parts = airPartsAt(height);
    return part == moleculesPart ? parts.molecules * medium_.molecules : parts.aerosol * medium_.aerosolScattering;
}

Four Air::opticalDepth(const Ray& ray, double metres) const {
    return medium_.extinction(AirPath(aboveFoot(ray), ground_, metres).whole()) + fog_.opticalDepth(ray, metres);
}

Four Air::transmittance(const Ray& ray, double metres) const {
    return glm::exp(-opticalDepth(ray, metres));
}

glm::dvec3 Air::fogTransmittance(const Ray& ray, double metres) const {
    const Four through = glm::exp(-fog_.opticalDepth(ray, metres));
    return {through.w, through.y, through.x};  // at 640, 520 and 440 nm, which have R, G and B
}

std::optional<HazeCollision> Air::collide(const Ray& ray, double limit, const Four& throughput, Random& random) const {
    const int i = channelOf(throughput, random);
    std::optional<HazeCollision> first;
    const glm::dvec3 extinction(medium_.molecules[i], medium_.aerosol[i], medium_.ozone[i]);
    const AirPath::Place place = AirPath(aboveFoot(ray), ground_, limit).reach(random.exponential(), extinction);
    if (place.reached && place.metres < limit) {
        const double molecules = scatteringOf(moleculesPart, place.height)[i];
        const double both = molecules + scatteringOf(aerosolPart, place.height)[i];
        first = HazeCollision{place.metres, random.uniform() * both < molecules ? moleculesPart : aerosolPart};
    }
    const auto fog = fog_.collide(ray, first ? first->metres : limit, i, random);
    return fog ? HazeCollision{fog->metres, fog->medium + fogBegin} : first;
}

Four Air::passed(const Ray& ray, double metres, const Four& throughput) const {
    const Four left = throughput * relativeTransmittance(opticalDepth(ray, metres), throughput);
    return left * (sumOf(throughput) / sumOf(left));
}

Four Air::scattered(const Ray& ray, const HazeCollision& collision, const Four& throughput) const {
    const Four left = throughput * relativeTransmittance(opticalDepth(ray, collision.metres), throughput);
    if (isFog(collision.medium)) {
        const auto& fog = fog_[collision.medium - fogBegin];
        return left * fog.scattering * (sumOf(throughput) / sumOf(left * fog.extinction));
    }
    const double height = heightAt(ray.origin + collision.metres * ray.direction);
    const AirParts parts = airPartsAt(height);
    const Four scattering = scatteringOf(collision.medium, height);
    // the density of a collision, times the chance of this part among those that scatter
    const Four density = medium_.extinction(parts) * scattering / glm::max(medium_.scattering(parts), 1e-300);
    const double all = sumOf(left * density);
    return all > 0.0 ? left * scattering * (sumOf(throughput) / all) : Four(0.0);
}

Four Air::emitted(const Ray& ray, double metres, const Four& throughput, Random& random) const {
    return fog_.emitted(
        ray, metres, [&](double point) { return passed(ray, point, throughput); }, random);
}

}  // namespace lumulus::reference
