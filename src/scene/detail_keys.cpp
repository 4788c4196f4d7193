#include "scene/key_rows.h"

namespace lumulus::scene {

std::vector<Key> detailKeys() {
    return {
        other("preparation.level_of_detail", Type::boolean, "true",
              "Whether, of several clouds, those that are small in the picture have larger voxels, no larger than a "
              "pixel, and fewer leaves: 30 + 0.4 times the square of their size in pixels. One cloud alone, and "
              "the frame service, have all detail.",
              [](Draft& d, const Value& v) { d.scene.preparation.levelOfDetail = v.boolean; })};
}

}  // namespace lumulus::scene
