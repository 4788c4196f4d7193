#include "draw/light_params.h"

namespace lumulus::draw {

shared::LightParams lightParams(const scene::Sun& sun) {
    return {glm::vec3(-sun.directionTo)};
}

}  // namespace lumulus::draw
