#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cloud/atlas.h"
#include "cloud/instance.h"
#include "light/shadow_volume.h"
#include "shared/instance.h"

namespace lumulus::light {

/// An instance that shades others, and its own shadow volume; null where it has none.
struct Shading {
    const cloud::Instance* instance = nullptr;
    const ShadowVolume* shadow = nullptr;
    std::uint64_t version = 0;  ///< of the shadow volume
};

/// Shadow volumes of several instances that shade each other: at each texel of an instance's volume the optical depth
/// to the sun through all of them. Optical depths add up, where instances overlap too, so that it is a sum of look-ups.
class SharedShadow {
  public:
    explicit SharedShadow(gpu::Context& context);

    /// Whether the volumes are those of these instances, at the places where they are.
    bool isUpToDate(std::span<const Shading> all) const { return madeFor_ == keyOf(all); }
    /// Records what fills the volumes anew, from the own ones of all (after a barrier), for light that travels along
    /// `sunTravel`.
    void record(gpu::Commands& commands, std::span<const Shading> all, const glm::dvec3& sunTravel);

    /// Valid after record(): all volumes in one image, and where each begins.
    const gpu::Image& image() const { return together_->image(); }
    const glm::ivec3& origin(std::size_t number) const { return together_->origin(number); }
    glm::vec3 inverseSize() const { return together_->inverseSize(); }

  private:
    static std::vector<glm::dvec4> keyOf(std::span<const Shading> all);
    void fit(std::span<const gpu::Image* const> images);

    gpu::Context& context_;
    gpu::Program<shared::SharedShadowPush> program_;
    gpu::Image none_;  ///< stands for the volume of an instance that has none
    std::optional<cloud::Atlas> own_, together_;
    std::optional<gpu::Buffer> occluders_;
    std::vector<glm::dvec4> madeFor_;  ///< version and place of each instance
};

/// For each shaded instance, the others of which something may lie between it and the sun, and how their volumes are
/// found. `atlas` origins and sizes of the volumes are filled in by the caller of the GPU.
struct Occluders {
    std::vector<std::uint32_t> first;  ///< of each instance, and the end
    std::vector<std::uint32_t> numbers;
    std::vector<shared::Occluder> places;
};
Occluders findOccluders(std::span<const Shading> all, const glm::dvec3& sunTravel);

}  // namespace lumulus::light
