#include "scene/tone.h"

#include "base/exposure.h"

namespace lumulus::scene {
namespace {

ToneCurve curveOf(ToneMap map) {
    switch (map) {
        case ToneMap::filmic:
            return ToneCurve::filmic;
        case ToneMap::agx:
            return ToneCurve::agx;
        case ToneMap::aces:
            return ToneCurve::aces;
        case ToneMap::neutral:
            return ToneCurve::neutral;
        case ToneMap::linear:
            break;
    }
    return ToneCurve::linear;
}

}  // namespace

Tone toneOf(const Image& image, std::span<const LayeredImage* const> pictures) {
    Tone tone{image.exposure, 1.0, curveOf(image.toneMap)};
    if (image.exposureMode == ExposureMode::ev100) tone.gain = gainOfEv100(image.ev100);
    if (image.exposureMode == ExposureMode::automatic) tone.gain = meteredGain(pictures);
    return tone;
}

}  // namespace lumulus::scene
