#include "service/render/pending_changes.h"

namespace lumulus::service {

SceneLight PendingChanges::after(SceneLight light, const SlotPointer& slot) const {
    for (const Change& change : changes_) {
        if (change.slot != slot) continue;
        light.sunDirection = change.light.sunDirection.value_or(light.sunDirection);
        light.sunIrradiance = change.light.sunIrradiance.value_or(light.sunIrradiance);
        if (light.extinction && change.light.extinction && change.cloud.value_or(0) == 0)
            light.extinction = change.light.extinction;
    }
    return light;
}

}  // namespace lumulus::service
