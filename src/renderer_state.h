#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "cloud/cloud.h"
#include "draw/billboards.h"
#include "draw/camera.h"
#include "draw/collector_sun.h"
#include "draw/light_field.h"
#include "draw/march.h"
#include "draw/sun_depth.h"
#include "gpu/commands.h"
#include "photon/photon_map.h"
#include "renderer.h"

namespace lumulus {

inline double largest(const glm::dvec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

/// What a Renderer owns; for the files that implement it.
struct Renderer::State {
    State(const scene::Scene& theScene, const RendererOptions& options)
        : scene(theScene),
          report(options.report),
          check(options.check),
          context({options.device, options.validation}),
          commands(context),
          keepRing(options.keepRing) {}

    scene::Scene scene;
    Report report;
    Check check;
    gpu::Context context;
    gpu::Commands commands;
    bool keepRing;
    Bounds bounds;
    Camera camera;  // of the picture that is drawn, as is its part
    Tile tile;
    int raysAcross = 1;
    glm::dvec3 offset{0.0};

    // What follows exists only where the scene needs it.
    photon::Medium medium;
    std::optional<cloud::Cloud> cloud;
    std::optional<photon::PhotonMap> photons;
    std::optional<draw::SunDepth> sunDepth;
    std::optional<draw::CollectorSun> collectorSun;
    std::optional<draw::PhaseTables> phase;
    std::optional<draw::LightField> lightField;
    std::optional<draw::Billboards> billboards;
    std::optional<draw::March> march;

    bool sunDrawn = false;  // the sun's depths are up to date
    int sinceChange = 0;    // generations under the light of now
    std::uint64_t lightFieldPhotons = 0;
    Statistics statistics;

    bool scatters() const { return largest(medium.albedo) > 0.0; }
    bool hasSun() const { return largest(scene.sun.irradiance) > 0.0; }
    bool hasLight() const { return hasSun() || largest(scene.sky.radiance) > 0.0; }

    void makeMedium(const scene::Cloud& from, double maximum);
    void prepareCloud(const vdb::Volume& volume);
    void preparePhotons();
    void drawCloud(LayeredImage& image);
    void prepareDrawing();
    void lightChanged();
    shared::FieldParams fieldParams() const;
    void recordLight();
    void drawBand(LayeredImage& image, const draw::FrameInputs& inputs, gpu::Buffer& params, int firstRow, int rows);
    glm::dvec3 toVoxel(const glm::dvec3& world) const;
    glm::vec3 eyeVoxel() const;
};

}  // namespace lumulus
