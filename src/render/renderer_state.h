#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>

#include "cloud/cloud.h"
#include "draw/bands.h"
#include "draw/billboards.h"
#include "draw/light_params.h"
#include "draw/march.h"
#include "draw/sparse_sampling.h"
#include "fog/screen/fog.h"
#include "frame/frame.h"
#include "gpu/commands.h"
#include "light/light_field.h"
#include "light/photon/photon_map.h"
#include "light/shadow_volume.h"
#include "render/renderer.h"
#include "view/camera.h"

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
          keepRing(options.keepRing),
          progressive(options.progressive) {}

    scene::Scene scene;
    Report report;
    Check check;
    gpu::Context context;
    gpu::Commands commands;
    bool keepRing, progressive;
    Bounds bounds;
    Camera camera;  // of the picture that is drawn, as is its part
    Tile tile;
    Tile shown;  // what of the tile the cloud may be seen in: the rest is sky
    int raysAcross = 1;
    int spacing = 1;  // of the points that it is drawn at; 1: every pixel
    int sampledRowsDrawn = 0;
    glm::dvec3 offset{0.0};

    // What follows exists only where the scene needs it.
    photon::Medium medium;
    std::optional<cloud::Cloud> cloud;
    cloud::CellGrid estimatorGrid;
    std::optional<photon::PhotonMap> photons;
    std::optional<light::ShadowVolume> shadowVolume;
    std::optional<draw::PhaseTables> phase;
    std::optional<light::LightField> lightField;
    std::optional<draw::Billboards> billboards;
    std::optional<draw::March> march;
    std::map<int, draw::Interpolation> interpolations;  ///< by spacing: views of several clients take turns
    std::optional<fog::Fog> fog;
    std::optional<frame::Frame> frame;  ///< where passes follow the drawing: fog
    scene::Sun sunlight = scene.sun;    ///< that reaches the cloud through the fog

    std::optional<glm::vec3> lightEye;  // that the light field was made for, by all photons as they are now
    bool lightCounted = false;          // what of it no view changes is up to date
    int sunAllowed = 1;                 // reduction of the sun's depths
    int sunDrawn = 0;                   // reduction with which they are up to date; 0: they are not
    bool sharpening = false;            // whole ones are in the making
    int sinceChange = 0;                // generations under the light of now
    Statistics statistics;

    bool scatters() const { return largest(medium.albedo) > 0.0; }
    bool hasSun() const { return largest(scene.sun.irradiance) > 0.0; }
    bool hasLight() const { return hasSun() || largest(scene.sky.radiance) > 0.0; }

    void makeMedium(const scene::Cloud& from, double maximum);
    void prepareCloud(const vdb::Volume& volume);
    void preparePhotons();
    void prepareDrawing();
    void dimSun();
    void lightChanged();
    void showShadowVolume(int reduction);
    void showView(const View& view);
    shared::FieldParams fieldParams() const;
    void makeLightField(std::uint64_t forPhotons);
    void forgetLight();
    light::CollisionEstimates estimates(const photon::Light& light) const;
    void recordLight(photon::Part part);
    void drawLight(photon::Part part);
    Tile shownPart() const;
    void drawBands(LayeredImage* image, const std::vector<draw::Band>& bands, const Report& told);
    void drawBand(LayeredImage* image, const draw::FrameInputs& inputs, const shared::SamplingGrid& sampling,
                  const draw::Band& band);
    void recordPixels(const draw::FrameInputs& inputs, const shared::DrawPush& push);
    void recordBlocks(const draw::FrameInputs& inputs, const shared::SamplingGrid& sampling, const draw::Band& band,
                      const Tile& pixels);
    shared::DrawParams drawParams() const;
    glm::dvec3 middle() const;
    int samplingSpacing() const;
    void addTimes(const std::vector<gpu::PassTime>& times);
    double passSeconds() const;
    void drawBackground();
    LayeredImage throughFog(const Tile& wanted);
    glm::dvec3 toVoxel(const glm::dvec3& world) const;
    glm::vec3 eyeVoxel() const;
};

}  // namespace lumulus
