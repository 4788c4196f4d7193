#pragma once

#include "base/interrupt.h"
#include "lamp/clouds.h"
#include "query/media.h"
#include "render/world.h"

namespace lumulus {

/// What light meets in a world as it is now, on the host. The densities of assets are read back from the GPU where no
/// question has needed them yet, and stay with the world. Errors: what `check` throws.
query::Media mediaOf(gpu::Context& context, World& world, const Check& check);

/// The same for light that the photon walk takes for straight: what scatters by less than `forward_cut` goes on, as far
/// as no channel absorbs it.
query::Media straightMediaOf(gpu::Context& context, World& world, const Check& check);

/// The clouds of a world that have a density, read back as above. Errors: as above.
std::vector<query::CloudField> fieldsOf(gpu::Context& context, World& world, const Check& check);

/// The clouds of a world as lamps light them, read back as above. Errors: as above.
std::vector<lamp::Cloud> cloudsForLamps(gpu::Context& context, World& world, const Check& check);

}  // namespace lumulus
