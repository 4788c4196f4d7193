#pragma once

#include <vector>

#include "sky/air_path.h"
#include "sky/multiple_scattering.h"

namespace lumulus::sky {

/// The iteration that makes the table of multiple scattering. What a step of a ray weighs is the same for all orders,
/// and is found once. The rays of a height and a polar angle, to all suns and azimuths, share a path through the air:
/// of a step of it the light is summed over degrees and heights once for all of them.
class ScatteringOrders {
  public:
    ScatteringOrders(const Air& air, const ColumnTable& columns, double discRadius);
    void run(MultipleScattering& result);

  private:
    static constexpr int sunTexels = MultipleScattering::sunTexels, heightTexels = MultipleScattering::heightTexels;
    static constexpr int texels = sunTexels * heightTexels;
    /// Directions above and below the horizon, and from the sun's side to the other.
    static constexpr int polar = 6, polarAngles = 2 * polar, azimuths = 6, steps = 20, mostOrders = 30;
    static constexpr int raysOfPath = sunTexels * azimuths;
    using Incident = MultipleScattering::Incident;
    using Coefficients = std::array<Spectrum, harmonicCount>;

    /// A step of a ray, or its end on the ground, against the sun.
    struct Place {
        std::uint32_t sun;  // column of the table
        float fraction;     // to the next
        float across;       // direction's part across the upward one, in the plane of the sun
        float lit;
    };
    /// What a step scatters to the beginning of its path where the sun stands as in a column of the table: the mean,
    /// and by order of the harmonics what stands before cos mφ.
    struct Scattered {
        glm::vec4 logMean;
        std::array<glm::vec4, highestDegree + 1> byOrder;
    };

    AirPoint start(int path, int ray) const;
    double solidAngle(int path) const;
    double aerosolSum(int height, int sun) const;
    void firstOrder(int height);
    Spectrum prepare(const AirPoint& from, int path, int ray, double aerosolPhase);
    void nextOrder(int height, const std::vector<Incident>& incident);
    std::array<Scattered, sunTexels> scattered(const AirStep& step, const std::vector<Incident>& incident) const;
    Spectrum fromGround(int path, int ray) const;
    void add(int path, int ray, const Spectrum& radiance);

    const Air& air_;
    const ColumnTable& columns_;
    double discRadius_;
    std::array<float, highestDegree + 1> moments_;
    std::vector<AirPath> paths_;                           // by height and polar angle
    std::vector<Place> places_;                            // of the steps of paths, by ray
    std::vector<Place> ends_;                              // of the rays of paths, on the ground
    std::vector<Coefficients> coefficients_;               // of one order
    std::array<Spectrum, sunTexels> irradiance_, before_;  // of the sky on the ground; of the order before
};

}  // namespace lumulus::sky
