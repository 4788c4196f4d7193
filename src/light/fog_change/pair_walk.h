#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "light/fog_change/change_cells.h"
#include "light/fog_change/cloud_grid.h"
#include "light/fog_change/fog_paths.h"
#include "shared/rng.h"

namespace lumulus::fog_change {

/// Numbers in [0, 1) of one photon.
class Numbers {
  public:
    Numbers(std::uint64_t seed, std::uint64_t photon)
        : key_(static_cast<std::uint32_t>(photon), 0U, 0U,
               shared::rngStream(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                                 static_cast<std::uint32_t>(photon >> 32U))) {}

    double next() {
        if (used_ == 4) {
            four_ = shared::rngUniform4(key_);
            ++key_.y;
            used_ = 0;
        }
        return static_cast<double>(four_[used_++]);
    }
    /// Exponentially distributed, of the mean 1.
    double depth() { return -std::log(1.0 - next()); }

  private:
    glm::uvec4 key_;
    glm::vec4 four_{0.0F};
    int used_ = 4;
};

/// How clouds scatter.
struct CloudMedium {
    glm::dvec3 albedo{1.0};  ///< of what counts as scattered
    /// A cosine from a number in [0, 1).
    std::function<double(double)> sampleCosine{};
};

/// Where photons walk.
struct PairWorld {
    const CloudGrid& clouds;
    const CloudMedium& medium;
    const FogPaths& fog;
    const ChangeCells& cells;
    std::optional<double> ground;
    glm::dvec3 groundAlbedo{0.0};
};

/// Light on its way.
struct Photon {
    glm::dvec3 position{0.0}, direction{0.0, 1.0, 0.0};
    glm::dvec3 light{0.0};  ///< W, with a sign
    /// Of the sun's beam, which has not been scattered but by peaks of the fog: their optical depth by colour.
    std::optional<glm::dvec3> beam{};
};

/// Follows photons and leaves what passes through cells. What a cloud changes is the difference of two photons that
/// part where the first cloud scatters: one is scattered there, one goes on through the fog as if no cloud were there
/// until it leaves the box of the clouds. Of light that does not meet a cloud in the box nothing is left.
class PairWalk {
  public:
    PairWalk(const PairWorld& world, std::vector<Passing>& passing) : world_(world), passing_(passing) {}

    /// `lightOf` gives the power at the start and is asked only where a cloud is met.
    void follow(Photon photon, const std::function<glm::dvec3()>& lightOf, Numbers& numbers);
    /// One photon by itself, everywhere.
    void followAlone(const Photon& photon, Numbers& numbers);

  private:
    void walk(Photon photon, bool withoutCloud, Numbers& numbers);
    double reachOf(const Photon& photon, bool& toGround) const;
    void go(Photon& photon, double length, bool leave, Numbers& numbers);
    void leaveOnWay(const Photon& photon, double length, Numbers& numbers);
    void leaveOnPart(const Photon& photon, int level, double from, double to, Numbers& numbers);
    void scatterInFog(Photon& photon, std::size_t layer, Numbers& numbers) const;
    void scatterInCloud(Photon& photon, Numbers& numbers) const;

    const PairWorld& world_;
    std::vector<Passing>& passing_;
};

/// The unit vector at an angle from a unit vector, by a cosine and an azimuth [radians].
glm::dvec3 turned(const glm::dvec3& direction, double cosine, double azimuth);

}  // namespace lumulus::fog_change
