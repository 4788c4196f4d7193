#pragma once

#include <array>
#include <vector>

#include "sky/atmosphere.h"

namespace lumulus::sky {

/// Light of the rays that leave a point at one angle to the upward direction, by their azimuth. What they have in
/// common is found once: where they look at the air, and what arrives there for a few cosines of the sun, between which
/// it changes little along a ray.
class RowLight {
  public:
    /// `height` of the point [m]; cosines of the rays and of the sun to the upward direction.
    RowLight(const Atmosphere& atmosphere, double height, double up, double sun, int steps);
    /// The same rays as far as `length` metres, which end above the ground.
    RowLight(const Atmosphere& atmosphere, double height, double up, double sun, double length, int steps);

    /// Light of the whole ray that has this cosine to the sun, as Atmosphere::sky().
    AirLight sky(double toSun) const;
    /// Of the whole ray.
    const Spectrum& transmittance() const { return transmittance_; }

  private:
    RowLight(const Atmosphere& atmosphere, double height, double up, double sun, double ground, const AirPath& path);
    /// Light that has scattered already and scatters into the ray, by the order of its azimuth [per metre].
    using ByOrder = std::array<glm::vec4, highestDegree + 1>;
    /// The same for one place of the sun's cosine in the table of multiple scattering, before the exponential of the
    /// mean.
    struct Texel {
        glm::vec4 logMean;
        ByOrder byOrder;
    };
    /// What arrives at a step, for one cosine of the sun.
    struct Node {
        glm::vec4 sun;  ///< transmittance to it, times the step's weight
        ByOrder source;
    };
    struct Step {
        AirStep air;
        double height, sun, perToSun;  ///< the sun's cosine there: `sun`, and `perToSun` times the ray's cosine to it
        std::uint32_t texels = 0;      ///< where its texels begin
        int firstTexel = 0;            ///< and which of the table that is
        std::uint32_t nodes = 0;       ///< where its nodes begin
        int intervals = 0;             ///< between them, even in the sun's cosine; 0: the sun sets there
        double low = 0.0, perNode = 0.0;
    };
    void addTexels(Step& step, double low, double high);
    void addNodes(Step& step, double low, double high);
    ByOrder sourceAt(const Step& step, double sun) const;
    Node nodeAt(const Step& step, double sun) const;
    Node between(const Step& step, double sun) const;

    const Atmosphere& atmosphere_;
    double height_, up_, sun_, ground_;
    Spectrum transmittance_;
    std::vector<Step> steps_;
    std::vector<Texel> texels_;
    std::vector<Node> nodes_;
};

}  // namespace lumulus::sky
