#pragma once

#include <optional>

#include "frame/frame.h"
#include "light/fog_light/air_over_fog.h"
#include "shared/sky_view.h"
#include "sky/sky_view.h"

namespace lumulus::frame {

/// Shows an atmosphere in a frame: sky and ground behind the clouds, and the air between them and the eye. Its tables
/// belong to the eye of one viewer, and are made anew where the eye's height or the sun has changed.
class SkyPass {
  public:
    /// `moon`: a second sun, which stays where it is. `fog`: there is level fog in the light of the sky.
    SkyPass(gpu::Context& context, const std::optional<scene::Sun>& moon, bool fog = false);

    /// Brings the tables up to date. Clouds lie between the distances `nearest` and `farthest` [m]; there are none
    /// where these are the same. For a `coarse` picture (View::coarse) the sky of an eye nearby serves, and the air has
    /// fewer texels. `fog`: where there is some, only the air above it is shown. Errors: InputError where the eye lies
    /// below the ground.
    void update(const sky::Atmosphere& atmosphere, const Camera& camera, const scene::Sun& sun, double nearest,
                double farthest, bool coarse, const fog_light::AirOverFog* fog = nullptr);
    /// Records the pass over a frame that shows the part `tile` of the camera's picture, whose radiance is that of the
    /// clouds alone, or of clouds and fog seen from above the fog.
    void record(gpu::Commands& commands, const Frame& frame, const Camera& camera, const Tile& tile);

    /// The radiance of the sky in each pixel, clouds or not, of the last record(); null where there is no fog.
    const gpu::Image* behind() const { return behind_ ? &*behind_ : nullptr; }

  private:
    void makeTables(const sky::Atmosphere& atmosphere, const glm::dvec3& eye, const scene::Sun& sun,
                    const fog_light::AirOverFog* fog);
    void upload(std::optional<gpu::Image>& image, const char* name, glm::ivec3 size, bool volume,
                const std::vector<glm::vec4>& texels);

    /// What the tables were made for.
    struct Made {
        glm::dvec3 up{0.0};
        double height = 0.0;
        glm::dvec3 toSun{0.0}, irradiance{0.0};
        std::optional<double> fogTop{};
        sky::Spectrum groundAlbedo{0.0};
        bool operator==(const Made&) const = default;
        /// Whether the sky differs by less than a coarse picture shows.
        bool isNear(const Made& other) const;
    };

    gpu::Context& context_;
    gpu::Program<gpu::NoPush> program_;
    gpu::Buffer params_;
    std::optional<Made> made_;
    bool fog_, aboveFog_ = false;
    shared::SkyViewParams sky_{};
    double nearest_ = 0.0, farthest_ = 1.0;
    std::optional<scene::Sun> moon_;
    shared::SkyViewParams moonSky_{};
    std::optional<gpu::Image> scattered_, aerosol_, airLight_, airTransmittance_;
    std::optional<gpu::Image> moonScattered_, moonAerosol_;  ///< of the moon; a texel where there is none
    std::optional<gpu::Image> transmittance_, behind_;       ///< where there is fog
};

}  // namespace lumulus::frame
