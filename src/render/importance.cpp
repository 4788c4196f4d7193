#include "render/importance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "view/camera.h"

namespace lumulus {

namespace {

/// Of the photons, by the light that falls on each instance, however small it is in the picture.
constexpr double byFlux = 0.2;
/// What is out of the picture counts so much less than if it were in its middle.
constexpr double unseen = 0.02;
/// Clouds farther apart than this hardly light each other [m] (METHODS, section 3: below 1 %).
constexpr double farthestExchange = 3000.0;

struct Ball {
    glm::dvec3 middle;
    double radius;
};

/// Solid angle of a ball from the eye [sr], less where it is out of the picture.
double shownOf(const Ball& ball, const Camera& camera) {
    const glm::dvec3 away = ball.middle - camera.position;
    const double distance = std::max(glm::length(away), ball.radius);
    if (camera.projection == scene::Projection::orthographic) return ball.radius * ball.radius;
    const double size = std::numbers::pi * std::pow(ball.radius / distance, 2);
    if (camera.projection == scene::Projection::panorama || glm::length(away) <= ball.radius) return size;
    const double across = camera.pixelAspect * camera.width / camera.height;
    const double corner = std::atan(camera.tanHalfFov * std::hypot(1.0, across) + glm::length(camera.middle));
    const double widest = corner + std::asin(std::min(1.0, ball.radius / distance));
    const double angle = std::acos(std::clamp(glm::dot(away / distance, camera.axes[2]), -1.0, 1.0));
    return angle < widest ? size : unseen * size;
}

/// Adds to each what those near it are worth, times the light of theirs that it sends on: the part of all directions
/// that it fills.
std::vector<double> withNeighbours(const std::vector<Ball>& balls, const std::vector<double>& shown) {
    std::vector<double> worth = shown;
    for (std::size_t i = 0; i < balls.size(); ++i)
        for (std::size_t j = 0; j < balls.size(); ++j) {
            const double apart = glm::length(balls[i].middle - balls[j].middle);
            if (i == j || apart > farthestExchange) continue;
            worth[i] += shown[j] * std::min(1.0, 0.25 * std::pow(balls[i].radius / std::max(apart, 1e-9), 2));
        }
    return worth;
}

void scaleToOne(std::vector<double>& values) {
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    for (double& value : values) value = sum > 0.0 ? value / sum : 1.0 / static_cast<double>(values.size());
}

}  // namespace

std::vector<double> photonShares(const World& world, const std::vector<std::size_t>& visible, const scene::Scene& scene,
                                 bool equally) {
    if (visible.size() == 1) return {1.0};
    std::vector<Ball> balls;
    std::vector<double> flux;
    for (const std::size_t i : visible) {
        const cloud::Instance& instance = world.instances[i];
        balls.push_back({instance.middle(), 0.5 * instance.diagonal()});
        flux.push_back(std::pow(balls.back().radius, 2));
    }
    std::vector<double> shares(visible.size(), 1.0);
    if (!equally) {
        const Camera camera = makeCamera(scene.camera, scene.image, world.bounds);
        for (std::size_t k = 0; k < balls.size(); ++k) shares[k] = shownOf(balls[k], camera);
        shares = withNeighbours(balls, shares);
    }
    scaleToOne(shares);
    scaleToOne(flux);
    for (std::size_t k = 0; k < shares.size(); ++k) shares[k] = (1.0 - byFlux) * shares[k] + byFlux * flux[k];
    scaleToOne(shares);
    return shares;
}

}  // namespace lumulus
