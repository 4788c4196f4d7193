#pragma once

#include <string>

namespace lumulus {

/// What a pass of the renderer works for. The costs of a frame are told by stage.
enum class Stage {
    photons,       ///< once a generation
    light,         ///< once a view, whatever its size
    shadowVolume,  ///< once a direction of the sun
    draw,          ///< for each pixel
    fog,           ///< for each pixel
};

/// Time that a pass took on the device, summed over the times that it ran.
struct PassTime {
    std::string name;
    double milliseconds = 0.0;
    Stage stage = Stage::draw;
};

}  // namespace lumulus
