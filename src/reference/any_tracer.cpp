#include "reference/any_tracer.h"

namespace lumulus::reference {
namespace {

std::variant<PathTracer, AirTracer> tracerOf(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes,
                                             Majorant majorant, const glm::dvec3& eye) {
    if (scene.sky.model == scene::SkyModel::atmosphere) return AirTracer(scene, volumes, majorant, eye);
    return PathTracer(scene, volumes, majorant, eye);
}

}  // namespace

AnyTracer::AnyTracer(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, Majorant majorant,
                     const glm::dvec3& eye)
    : tracer_(tracerOf(scene, volumes, majorant, eye)) {}

PathSample AnyTracer::trace(const Ray& ray, Random& random) const {
    return std::visit([&](const auto& tracer) { return tracer.trace(ray, random); }, tracer_);
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

glm::dvec3 AnyTracer::skyUnit() const {
    return std::visit([](const auto& tracer) { return glm::dvec3(tracer.environment().unit()); }, tracer_);
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
