#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "light/light_field.h"
#include "light/photon/air_light.h"
#include "light/shadow_volume.h"

namespace lumulus::light {

/// Light cells of one size, and whether what no view changes is up to date.
struct CountedCells {
    std::optional<LightCells> cells;
    bool counted = false;
};

/// The light in one instance, whatever the view. Each part exists only where the scene needs it.
struct InstanceLight {
    scene::Sun sun;                         ///< that reaches the instance; in an atmosphere the most of it
    std::optional<photon::AirLight> air;    ///< where the sky is an atmosphere
    std::optional<std::size_t> part;        ///< of the world's photon map; none where no photon would be of use
    std::optional<ShadowVolume> shadow;     ///< none without a sun
    int shadowTexel = 1;                    ///< edge of its texels across the light, over that along it
    int shadowReduction = 0;                ///< of the shadow volume that is up to date (1: whole); 0: it is not
    bool sharpening = false;                ///< a whole shadow volume is in the making
    std::uint64_t shadowVersion = 0;        ///< of the shadow volume that is shown
    double fewestCells = fewestLightCells;  ///< along the longest side of the light field
    CountedCells fine, coarse;              ///< of whole pictures, of those to be enlarged
    std::shared_ptr<CellLayouts> layouts = std::make_shared<CellLayouts>();  ///< shared by all lights of the asset
    std::uint64_t version = 1;  ///< of the photons' light: views know by it whether their light fields are up to date

    /// The photons' light is not what light fields were made of.
    void changed() {
        ++version;
        fine.counted = coarse.counted = false;
    }
};

}  // namespace lumulus::light
