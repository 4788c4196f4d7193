#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/tone_curves.h"

namespace lumulus {

/// The way from linear Rec. 709 radiance to a display as a configuration of OpenColorIO has it: its default view on its
/// default display. It stands in the place of tone map and transfer function.
class DisplayTransform {
  public:
    /// The transform of the configuration that the environment variable OCIO names; nothing where it is not set or
    /// empty. Errors: InputError for a configuration that cannot be used, and where the program was built without
    /// OpenColorIO.
    static std::optional<DisplayTransform> ofEnvironment();

    DisplayTransform(DisplayTransform&&) noexcept;
    DisplayTransform& operator=(DisplayTransform&&) noexcept;
    ~DisplayTransform();

    /// Replaces radiance by encoded values in [0,1]. Negative channels and those that are not numbers count as 0. May
    /// be called by several threads at once.
    void apply(std::vector<Colour>& pixels) const;

  private:
    struct Processor;
    explicit DisplayTransform(std::unique_ptr<Processor> processor);
    std::unique_ptr<Processor> processor_;
};

}  // namespace lumulus
