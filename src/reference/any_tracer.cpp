#include "reference/any_tracer.h"

#include <cmath>

namespace lumulus::reference {
namespace {

std::variant<PathTracer, AirTracer> tracerOf(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes,
                                             Majorant majorant, int scatterings) {
    if (scene.sky.model == scene::SkyModel::atmosphere) return AirTracer(scene, volumes, majorant, scatterings);
    return PathTracer(scene, volumes, majorant, scatterings);
}

/// The scene under its moon alone. Its night sky is that of a sun as weak as the moon, which is as good as none.
scene::Scene moonlit(scene::Scene scene) {
    constexpr double sunMagnitude = -26.74;
    const double angle = scene.moon.phaseAngle;
    const double magnitude = -12.73 + 0.026 * angle + 4e-9 * angle * angle * angle * angle;  // Allen
    scene.sun.directionTo = scene.moon.directionTo;
    scene.sun.irradiance *= std::pow(10.0, 0.4 * (sunMagnitude - magnitude));
    scene.sun.limbDarkening = false;
    // all other light has been counted beside the sun's
    for (scene::Surface& surface : scene.surfaces) surface.emission = glm::dvec3(0.0);
    for (scene::FogMedium& medium : scene.fog.media) medium.emission = glm::dvec3(0.0);
    scene.lamps.clear();
    return scene;
}

}  // namespace

AnyTracer::AnyTracer(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, Majorant majorant,
                     int scatterings)
    : tracer_(tracerOf(scene, volumes, majorant, scatterings)) {
    if (scene.moon.shines && scene.sky.model == scene::SkyModel::atmosphere)
        moon_.emplace(moonlit(scene), volumes, majorant, scatterings, false);
}

PathSample AnyTracer::trace(const Ray& ray, Random& random) const {
    PathSample sample = std::visit([&](const auto& tracer) { return tracer.trace(ray, random); }, tracer_);
    if (!moon_) return sample;
    const PathSample moonlight = moon_->trace(ray, random);
    sample.radiance += moonlight.radiance;
    sample.passed += moonlight.passed;
    sample.lost = sample.lost || moonlight.lost;
    sample.events += moonlight.events;
    return sample;
}

RayIntegrals AnyTracer::integrate(const Ray& ray) const {
    return std::visit([&](const auto& tracer) { return tracer.integrate(ray); }, tracer_);
}

std::optional<double> AnyTracer::front(const Ray& ray) const {
    return std::visit([&](const auto& tracer) { return tracer.front(ray); }, tracer_);
}

glm::dvec3 AnyTracer::discSeen(const Ray& ray) const {
    return std::visit([&](const auto& tracer) { return tracer.discSeen(ray); }, tracer_);
}

glm::dvec3 AnyTracer::discUnit() const {
    return std::visit([](const auto& tracer) { return tracer.discUnit(); }, tracer_);
}

glm::dvec3 AnyTracer::lampSeen(const Ray& ray, std::size_t lamp) const {
    return std::visit([&](const auto& tracer) { return tracer.lampSeen(ray, lamp); }, tracer_);
}

glm::dvec3 AnyTracer::skyUnit() const {
    return std::visit([](const auto& tracer) { return glm::dvec3(tracer.environment().unit()); }, tracer_);
}

const mesh::Placed* AnyTracer::meshes() const {
    return std::visit([](const auto& tracer) { return tracer.meshes().placed(); }, tracer_);
}

const SunDisc& AnyTracer::sun() const {
    return std::visit([](const auto& tracer) -> const SunDisc& { return tracer.environment().sun(); }, tracer_);
}

bool AnyTracer::sunny() const {
    return std::visit([](const auto& tracer) { return tracer.environment().sunny(); }, tracer_);
}

bool AnyTracer::hazy() const {
    return std::visit([](const auto& tracer) { return tracer.hazy(); }, tracer_);
}

}  // namespace lumulus::reference
