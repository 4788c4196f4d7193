#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/progress.h"
#include "scene/scene.h"

namespace lumulus {

struct RendererOptions {
    std::string device;        ///< name (part of it) or index; empty: the best one
    bool validation = false;   ///< Vulkan validation and synchronisation validation; messages end up in `Statistics`
    Report report = noReport;  ///< told of loading, preparing and drawing
    /// The photons are not counted beforehand: generations may go on beyond the scene's, and preview() can be asked.
    bool progressive = false;
};

struct PassTime {
    std::string name;
    double milliseconds = 0.0;
};

/// What `--stats` reports.
struct Statistics {
    std::string device;
    double loadSeconds = 0.0, prepareSeconds = 0.0, traceSeconds = 0.0, drawSeconds = 0.0;
    std::uint64_t photons = 0;      ///< emitted by all generations in the ring
    std::uint64_t generations = 0;  ///< in the ring
    std::uint64_t events = 0;       ///< real collisions
    std::uint64_t nullCollisions = 0;
    std::uint64_t absorbed = 0, escaped = 0, lost = 0;  ///< photons by their end
    std::uint64_t saturated = 0;                        ///< coefficients that met the fixed-point limit
    std::uint64_t collectors = 0;
    std::uint64_t gpuBytes = 0;
    std::vector<PassTime> passes;  ///< sums over all generations, in the order of the frame
    std::vector<std::string> warnings;
    std::vector<std::string> validationMessages;
};

/// Some rows of the picture by the photons of the even and of the odd generations, which have none in common: what they
/// differ by is noise.
struct Preview {
    LayeredImage even, odd;
    std::vector<int> rows;                        ///< that are drawn
    int evenGenerations = 0, oddGenerations = 0;  ///< in the two pictures
    double forecastSeconds = 0.0;                 ///< that draw() would take now
};

/// Owns the device, the cloud and the photon map, and makes frames.
/// Errors: InputError for bad scenes, Error for what fails while running and where interrupted.
class Renderer {
  public:
    Renderer(const scene::Scene& scene, const RendererOptions& options);
    ~Renderer();

    /// Generations that the scene asks for (0 where no photon is needed).
    int generationsWanted() const;
    /// Traces one generation into the oldest slot of the ring.
    void traceGeneration();
    /// Draws the view of the scene: layers as in the documented EXR contract.
    LayeredImage draw();
    /// For progressive rendering, from two generations on after the last draw().
    Preview preview();

    Statistics statistics() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace lumulus
