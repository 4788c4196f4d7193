#pragma once

#include <cstdint>
#include <optional>

#include "light/light_field.h"
#include "light/shadow_volume.h"

namespace lumulus::light {

/// The light in one instance, whatever the view. Each part exists only where the scene needs it.
struct InstanceLight {
    scene::Sun sun;                      ///< that reaches the instance
    std::optional<std::size_t> part;     ///< of the world's photon map; none where no photon would be of use
    std::optional<ShadowVolume> shadow;  ///< none without a sun
    int shadowReduction = 0;             ///< of the shadow volume that is up to date (1: whole); 0: it is not
    bool sharpening = false;             ///< a whole shadow volume is in the making
    std::uint64_t shadowVersion = 0;     ///< of the shadow volume that is shown
    std::optional<LightCells> cells;
    bool counted = false;       ///< what of `cells` no view changes is up to date
    std::uint64_t version = 1;  ///< of the photons' light: views know by it whether their light fields are up to date

    /// The photons' light is not what light fields were made of.
    void changed() {
        ++version;
        counted = false;
    }
};

}  // namespace lumulus::light
