#include "render/ambient.h"

#include <cmath>
#include <numbers>
#include <span>

namespace lumulus {

namespace {

using std::numbers::pi;

constexpr int panoramaWidth = 64, panoramaHeight = 32;

}  // namespace

std::array<double, 9> ambientBasis(const glm::dvec3& d) {
    return {0.28209479177387814,
            0.4886025119029199 * d.y,
            0.4886025119029199 * d.z,
            0.4886025119029199 * d.x,
            1.0925484305920792 * d.x * d.y,
            1.0925484305920792 * d.y * d.z,
            0.31539156525252005 * (3.0 * d.z * d.z - 1.0),
            1.0925484305920792 * d.x * d.z,
            0.5462742152960396 * (d.x * d.x - d.y * d.y)};
}

glm::dvec3 AmbientLight::irradiance(const glm::dvec3& normal) const {
    const std::array<double, 9> basis = ambientBasis(normal);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < coefficients.size(); ++i)
        sum += coefficients[i] * basis[i] * (i == 0 ? pi : (i < 4 ? 2.0 * pi / 3.0 : pi / 4.0));
    return sum;
}

AmbientLight projectPanorama(std::span<const float> red, std::span<const float> green, std::span<const float> blue,
                             int width, int height) {
    AmbientLight light;
    std::size_t pixel = 0;
    for (int y = 0; y < height; ++y) {
        const double upper = pi * (0.5 - static_cast<double>(y) / height), lower = upper - pi / height;
        const double angle = 2.0 * pi / width * (std::sin(upper) - std::sin(lower));
        const double elevation = 0.5 * (upper + lower);
        for (int x = 0; x < width; ++x, ++pixel) {
            const double azimuth = 2.0 * pi * ((x + 0.5) / width - 0.5);  // clockwise from north
            const glm::dvec3 direction(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                       -std::cos(elevation) * std::cos(azimuth));
            const glm::dvec3 radiance(red[pixel], green[pixel], blue[pixel]);
            const std::array<double, 9> basis = ambientBasis(direction);
            for (std::size_t i = 0; i < basis.size(); ++i) light.coefficients[i] += angle * basis[i] * radiance;
        }
    }
    return light;
}

glm::dvec3 sunIrradianceAt(const Renderer& renderer, const query::Media& media, const glm::dvec3& point,
                           const Check& check) {
    const scene::Sun sun = renderer.sunAt(point);  // through fog and air
    const query::Media clouds{media.clouds, {}, media.ground};
    return sun.irradiance *
           query::towardsSun(clouds, std::span(&point, 1), sun.directionTo, check).front().transmittance();
}

AmbientLight ambientAt(Renderer& renderer, ViewState& state, const glm::dvec3& point) {
    View view = renderer.sceneView();
    view.camera.position = point;
    view.camera.target = point + glm::dvec3(0.0, 0.0, -1.0);
    view.camera.up = glm::dvec3(0.0, 1.0, 0.0);
    view.camera.projection = scene::Projection::panorama;
    view.image.width = panoramaWidth;
    view.image.height = panoramaHeight;
    view.image.background = true;
    view.sunDisc = false;
    const LayeredImage seen = renderer.draw(view, state);
    return projectPanorama(seen.layers.at("R"), seen.layers.at("G"), seen.layers.at("B"), panoramaWidth,
                           panoramaHeight);
}

}  // namespace lumulus
