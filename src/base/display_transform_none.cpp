#include <cassert>
#include <cstdlib>
#include <string>

#include "base/display_transform.h"
#include "base/error.h"

// For a build without OpenColorIO.
namespace lumulus {

struct DisplayTransform::Processor {};

std::optional<DisplayTransform> DisplayTransform::ofEnvironment() {
    const char* const file = std::getenv("OCIO");
    if (file == nullptr || *file == '\0') return std::nullopt;
    throw InputError("this program was built without OpenColorIO", std::string("OCIO=") + file,
                     "unset OCIO, or build with libopencolorio-dev installed");
}

DisplayTransform::DisplayTransform(DisplayTransform&&) noexcept = default;
DisplayTransform& DisplayTransform::operator=(DisplayTransform&&) noexcept = default;
DisplayTransform::~DisplayTransform() = default;

void DisplayTransform::apply(std::vector<Colour>&) const {
    assert(false);  // there is no such transform
}

}  // namespace lumulus
