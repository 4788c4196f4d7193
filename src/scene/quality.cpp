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
            // a smaller cut needs more bands; both lower the bias and raise the noise, which more photons lower again
            map.photons = 24000000;
            map.generations = 40;
            map.bands = 6;
            map.forwardCut = 10.0;
            break;
    }
}

}  // namespace lumulus::scene
