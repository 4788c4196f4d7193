#include "environment/surroundings.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "base/error.h"
#include "query/media.h"
#include "sky/sky_report.h"

namespace lumulus::environment {
namespace {

/// Height of the ground [m], where there is one.
std::optional<double> groundOf(const scene::Scene& scene) {
    if (scene.ground) return scene.ground->height;
    return scene.sky.model == scene::SkyModel::atmosphere ? std::optional(0.0) : std::nullopt;
}

/// A layer of a panorama whose middle looks north (−Z), with its middle east (+X).
std::vector<float> eastInTheMiddle(const std::vector<float>& north, int width) {
    std::vector<float> values(north.size());
    const auto across = static_cast<std::size_t>(width);
    for (std::size_t i = 0; i < north.size(); ++i)
        values[i] = north[i / across * across + (i % across + across / 4) % across];
    return values;
}

/// The lights that shine, as they reach the point.
std::vector<Luminary> lightsOf(Renderer& renderer, const scene::Scene& scene, const glm::dvec3& point,
                               const Check& check) {
    const sky::SkyReport report = sky::reportSky(scene, point);
    const scene::Sun& sun = renderer.sun();
    std::vector<Luminary> lights;
    if (report.sun.irradiance != glm::dvec3(0.0))
        lights.push_back({"sun", sun.directionTo, 0.5 * sun.angularDiameter, report.sun.irradiance, glm::dvec3(1.0)});
    const bool moon = scene.moon.shines && scene.sky.model == scene::SkyModel::atmosphere;
    if (moon && report.moon.irradiance != glm::dvec3(0.0))
        lights.push_back(
            {"moon", scene.moon.directionTo, 0.5 * scene.sun.angularDiameter, report.moon.irradiance, glm::dvec3(1.0)});
    const query::Media media = renderer.media();
    for (Luminary& light : lights)
        light.transmittance =
            query::towardsSun(media, std::span(&point, 1), light.directionTo, check).front().transmittance();
    return lights;
}

}  // namespace

scene::Scene sceneAround(scene::Scene scene, const glm::dvec3& point, int size, const std::string& option) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(point[axis]) <= 1e9))
            throw InputError(fmt::format("{} is not within ±1e9", point[axis]), option, "give metres");
    const std::optional<double> ground = groundOf(scene);
    if (ground && point.y < *ground)
        throw InputError(fmt::format("y = {:g} is below the ground at {:g} m", point.y, *ground), option,
                         "raise the point");
    scene.camera.position = point;
    scene.camera.target = point + glm::dvec3(0.0, 0.0, -1.0);
    scene.camera.up = glm::dvec3(0.0, 1.0, 0.0);
    scene.camera.projection = scene::Projection::panorama;
    scene.image.width = 4 * size;
    scene.image.height = 2 * size;
    scene.image.background = true;
    return scene;
}

Surroundings drawSurroundings(Renderer& renderer, const scene::Scene& scene, bool discs, const Check& check) {
    View view = renderer.sceneView();
    view.sunDisc = discs;
    const LayeredImage seen = renderer.draw(view);
    const std::vector<float>&red = seen.layers.at("R"), &green = seen.layers.at("G"), &blue = seen.layers.at("B");
    Surroundings result;
    result.point = scene.camera.position.value();
    result.harmonics = projectPanorama(red, green, blue, seen.width, seen.height);
    result.panorama = prefilter::panoramaOf(seen.width, seen.height, eastInTheMiddle(red, seen.width),
                                            eastInTheMiddle(green, seen.width), eastInTheMiddle(blue, seen.width));
    result.discsInMap = discs;
    result.lights = lightsOf(renderer, scene, result.point, check);
    return result;
}

}  // namespace lumulus::environment
