#include "bench/measure.h"

#include <fmt/format.h>

#include <utility>

#include "base/error.h"
#include "base/tonemap.h"
#include "reference/flip.h"
#include "reference/metrics.h"

namespace lumulus::bench {

Truth makeTruth(LayeredImage image, std::string name, int width, int height, double exposure) {
    if (image.width != width || image.height != height) {
        throw InputError(
            fmt::format("the reference is {}×{}, the scene {}×{}", image.width, image.height, width, height), name,
            fmt::format("add --set image.width={} --set image.height={}", image.width, image.height));
    }
    reference::requireComparable({image, name}, {image, name});
    const reference::Comparison itself = reference::compare(image, image);
    if (itself.meanReference == 0.0) {
        throw InputError("the reference is black: no error can be relative to it", name, "give the scene some light");
    }
    return {std::move(image), std::move(name), exposure, itself.referenceNoise};
}

Errors measure(const LayeredImage& image, const Truth& truth) {
    reference::requireComparable({image, "picture"}, {truth.image, truth.name});
    const reference::Comparison c = reference::compare(image, truth.image);
    Errors errors;
    errors.relMse = c.relMse.value - truth.floor.value_or(0.0);
    errors.rmse = c.rmse.value;
    errors.bias = c.bias.value;
    errors.relativeBias = c.relativeBias.value;
    errors.flip = reference::flipMean(reference::flip(toneMap(image, truth.exposure),
                                                      toneMap(truth.image, truth.exposure), image.width, image.height));
    return errors;
}

}  // namespace lumulus::bench
