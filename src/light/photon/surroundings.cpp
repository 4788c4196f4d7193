#include "light/photon/surroundings.h"

#include "sky/sky_cells.h"

namespace lumulus::photon {

using gpu::SpecConstant;

std::vector<SpecConstant> withSurroundings(std::vector<SpecConstant> constants, const Options& options, bool starts) {
    if (options.ground) constants.push_back(SpecConstant::of(6, true));
    if (starts && options.meshes) constants.push_back(SpecConstant::of(26, true));
    if (options.fog) constants.push_back(SpecConstant::of(19, true));
    if (options.skyCells != sky::SkyCells{}.size) {
        constants.push_back(SpecConstant::of(16, options.skyCells.x));
        constants.push_back(SpecConstant::of(17, options.skyCells.y));
    }
    return constants;
}

}  // namespace lumulus::photon
