#include "base/display_transform.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <utility>

#include "base/error.h"

namespace lumulus {

namespace ocio = OCIO_NAMESPACE;

struct DisplayTransform::Processor {
    ocio::ConstCPUProcessorRcPtr cpu;
};

namespace {

constexpr float brightest = 65504.0F;  // of half floats: lookup tables of configurations end there or before

/// The colour space of our pictures: one that the configuration knows by a usual name of linear Rec. 709, or its role
/// for scene-linear colours.
const char* sceneSpace(const ocio::ConstConfigRcPtr& config) {
    for (const char* name : {"Linear Rec.709 (sRGB)", "lin_rec709", "Linear Rec.709", "Utility - Linear - sRGB",
                             "lin_srgb", "Linear sRGB", "Linear"})
        if (config->getColorSpace(name) != nullptr) return name;
    return ocio::ROLE_SCENE_LINEAR;
}

}  // namespace

std::optional<DisplayTransform> DisplayTransform::ofEnvironment() {
    const char* const file = std::getenv("OCIO");
    if (file == nullptr || *file == '\0') return std::nullopt;
    try {
        const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(file);
        const char* const display = config->getDefaultDisplay();
        const char* const view = config->getDefaultView(display);
        const auto processor = config->getProcessor(sceneSpace(config), display, view, ocio::TRANSFORM_DIR_FORWARD);
        return DisplayTransform(std::make_unique<Processor>(Processor{processor->getDefaultCPUProcessor()}));
    } catch (const ocio::Exception& e) {
        throw InputError(std::string("OpenColorIO: ") + e.what(), std::string("OCIO=") + file,
                         "name a configuration that can be used, or unset OCIO");
    }
}

DisplayTransform::DisplayTransform(std::unique_ptr<Processor> processor) : processor_(std::move(processor)) {}
DisplayTransform::DisplayTransform(DisplayTransform&&) noexcept = default;
DisplayTransform& DisplayTransform::operator=(DisplayTransform&&) noexcept = default;
DisplayTransform::~DisplayTransform() = default;

void DisplayTransform::apply(std::vector<Colour>& pixels) const {
    std::vector<float> values(pixels.size() * 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto value = static_cast<float>(pixels[i / 3][i % 3]);
        values[i] = value > 0.0F ? std::min(value, brightest) : 0.0F;
    }
    ocio::PackedImageDesc description(values.data(), static_cast<long>(pixels.size()), 1, 3);
    processor_->cpu->apply(description);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double value = static_cast<double>(values[i]);
        pixels[i / 3][i % 3] = value > 0.0 ? std::min(value, 1.0) : 0.0;
    }
}

}  // namespace lumulus
