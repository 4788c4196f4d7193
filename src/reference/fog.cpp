#include "reference/fog.h"

#include "reference/spectrum.h"

namespace lumulus::reference {
namespace {

glm::dvec3 asIs(const glm::dvec3& rgb) {
    return rgb;
}

}  // namespace

Fog::Fog(const scene::Fog& fog) : media_(fog, asIs, asIs, std::nullopt) {}

glm::dvec3 Fog::transmittance(const Ray& ray, double metres) const {
    return glm::exp(-media_.opticalDepth(ray, metres));
}

std::optional<HazeCollision> Fog::collide(const Ray& ray, double limit, const glm::dvec3& throughput,
                                          Random& random) const {
    return media_.collide(ray, limit, channelOf(throughput, random), random);
}

glm::dvec3 Fog::passed(const Ray& ray, double metres, const glm::dvec3& throughput) const {
    const glm::dvec3 left = throughput * relativeTransmittance(media_.opticalDepth(ray, metres), throughput);
    return left * (sumOf(throughput) / sumOf(left));
}

glm::dvec3 Fog::scattered(const Ray& ray, const HazeCollision& collision, const glm::dvec3& throughput) const {
    const auto& m = media_[collision.medium];
    const glm::dvec3 left = throughput * relativeTransmittance(media_.opticalDepth(ray, collision.metres), throughput);
    return left * m.scattering * (sumOf(throughput) / sumOf(left * m.extinction));
}

glm::dvec3 Fog::emitted(const Ray& ray, double metres, const glm::dvec3& throughput, Random& random) const {
    return media_.emitted(
        ray, metres, [&](double point) { return passed(ray, point, throughput); }, random);
}

}  // namespace lumulus::reference
