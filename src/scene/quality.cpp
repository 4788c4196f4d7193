#include "scene/quality.h"

namespace lumulus::scene {

void applyQuality(Scene& scene, Quality quality) {
    PhotonMap& map = scene.photonMap;
    switch (quality) {
        case Quality::draft:
            map.photons = 200000;
            map.generations = 10;
            map.bands = 3;
            break;
        case Quality::interactive:
            map.photons = 1000000;
            map.generations = 20;
            map.bands = 4;
            break;
        case Quality::final:
            map.photons = 16000000;
            map.generations = 40;
            map.bands = 4;
            break;
    }
}

}  // namespace lumulus::scene
