#pragma once

#include <optional>

#include "frame/frame.h"
#include "shared/sky_view.h"
#include "sky/sky_view.h"

namespace lumulus::frame {

/// Shows an atmosphere in a frame: sky and ground behind the clouds, and the air between them and the eye. Its tables
/// belong to the eye of one viewer, and are made anew where the eye's height or the sun has changed.
class SkyPass {
  public:
    explicit SkyPass(gpu::Context& context);

    /// Brings the tables up to date. Clouds lie between the distances `nearest` and `farthest` [m]; there are none
    /// where these are the same. Errors: InputError where the eye lies below the ground.
    void update(const sky::Atmosphere& atmosphere, const Camera& camera, const scene::Sun& sun, double nearest,
                double farthest);
    /// Records the pass over a frame that shows the part `tile` of the camera's picture, whose radiance is that of the
    /// clouds alone.
    void record(gpu::Commands& commands, const Frame& frame, const Camera& camera, const Tile& tile);

  private:
    void upload(std::optional<gpu::Image>& image, const char* name, glm::ivec3 size, bool volume,
                const std::vector<glm::vec4>& texels);

    /// What the tables were made for.
    struct Made {
        glm::dvec3 up{0.0};
        double height = 0.0;
        glm::dvec3 toSun{0.0}, irradiance{0.0};
        bool operator==(const Made&) const = default;
    };

    gpu::Context& context_;
    gpu::Program<gpu::NoPush> program_;
    gpu::Buffer params_;
    std::optional<Made> made_;
    shared::SkyViewParams sky_{};
    double nearest_ = 0.0, farthest_ = 1.0;
    std::optional<gpu::Image> scattered_, aerosol_, airLight_, airTransmittance_;
};

}  // namespace lumulus::frame
