#include "light/photon/emission.h"

#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <numbers>

#include "light/photon/air_light.h"

namespace lumulus::photon {

double luminance(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

std::uint64_t Emission::sunPhotons(std::uint64_t photons, double u) const {
    return std::min(photons, static_cast<std::uint64_t>(std::floor(static_cast<double>(photons) * sunShare + u)));
}

glm::dvec3 Emission::sunPower(std::uint64_t photons) const {
    return sunShare > 0.0 ? sunFlux / (static_cast<double>(photons) * sunShare) : glm::dvec3(0.0);
}

glm::dvec3 Emission::skyPower(std::uint64_t photons) const {
    return sunShare < 1.0 ? skyFlux / (static_cast<double>(photons) * (1.0 - sunShare)) : glm::dvec3(0.0);
}

namespace {

Emission sharedOut(const scene::Sun& sun, const glm::dvec3& skyFlux, const glm::dmat3& faceArea) {
    Emission emission;
    double projected = 0.0;
    for (int axis = 0; axis < 3; ++axis) projected += std::abs(glm::dot(faceArea[axis], sun.directionTo));
    emission.sunFlux = sun.irradiance * projected;
    emission.skyFlux = skyFlux;
    const double both = luminance(emission.sunFlux) + luminance(emission.skyFlux);
    emission.sunShare = both > 0.0 ? luminance(emission.sunFlux) / both : 0.0;
    return emission;
}

}  // namespace

Emission makeEmission(const scene::Sun& sun, const sky::Environment& environment, const glm::dmat3& faceArea) {
    return sharedOut(sun, environment.fluxThrough(faceArea), faceArea);
}

Emission makeEmission(const scene::Sun& sun, const AirLight& air, const glm::dmat3& faceArea) {
    Emission emission = sharedOut(sun, air.skyFlux, faceArea);
    emission.skyPeak = air.skyPeak;
    return emission;
}

Emission makeEmission(const scene::Sun& sun, const sky::Environment& environment, double area) {
    Emission emission;
    emission.sunFlux = sun.irradiance * area;
    emission.skyFlux = 4.0 * std::numbers::pi * area * glm::dvec3(environment.params().radiance);
    const double both = luminance(emission.sunFlux) + luminance(emission.skyFlux);
    emission.sunShare = both > 0.0 ? luminance(emission.sunFlux) / both : 0.0;
    return emission;
}

Emission makeEmission(const scene::Sun& sun, const AirLight& air, double area) {
    Emission emission;
    emission.sunFlux = sun.irradiance * area;
    emission.skyFlux = air.skyFlux;
    emission.skyPeak = air.skyPeak;
    const double both = luminance(emission.sunFlux) + luminance(emission.skyFlux);
    emission.sunShare = both > 0.0 ? luminance(emission.sunFlux) / both : 0.0;
    return emission;
}

double greatestFlux(const glm::dvec3& irradiance, const Emission& emission, const glm::dmat3& faceArea) {
    const double area = glm::length(faceArea[0]) + glm::length(faceArea[1]) + glm::length(faceArea[2]);
    return glm::compMax(irradiance * area + emission.skyFlux);
}

double greatestFlux(const glm::dvec3& irradiance, const Emission& emission, double area, double each) {
    return glm::compMax(irradiance * area + emission.skyFlux * (area / each));
}

glm::dmat3 faceAreas(const glm::dmat3& voxelEdges, const glm::dvec3& size) {
    const glm::dmat3 edges(voxelEdges[0] * size.x, voxelEdges[1] * size.y, voxelEdges[2] * size.z);
    const glm::dmat3 areas(glm::cross(edges[1], edges[2]), glm::cross(edges[2], edges[0]),
                           glm::cross(edges[0], edges[1]));
    return glm::determinant(edges) < 0.0 ? -areas : areas;
}

}  // namespace lumulus::photon
