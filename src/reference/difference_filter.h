#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace lumulus::reference {

/// What paths found in the pixels of a picture, rows from the top. Radiances in W·m⁻²·sr⁻¹.
struct DifferenceMap {
    int width = 0, height = 0;
    std::vector<float> counted;         ///< 1 for pixels that paths were traced through, else 0
    std::vector<glm::vec3> light;       ///< what a difference is in proportion to; 0 where not counted, as all below
    std::vector<glm::vec3> difference;  ///< truth less picture, with the noise of the paths
    std::vector<float> variance;        ///< of that noise, in the mean of the three channels
};

/// The difference without most of its noise: the ratio of difference to light is divided into bands of detail (means
/// over larger and larger surroundings), and of each band there is kept, place by place, what stands above the noise
/// that the variances let expect (shrinkage as in wavelets, Donoho and Johnstone 1994, by the energy of the
/// surroundings). With many paths it is the difference itself, with few its mean. The sum over all pixels stays,
/// channel by channel.
std::vector<glm::vec3> filterDifference(const DifferenceMap& map);

}  // namespace lumulus::reference
