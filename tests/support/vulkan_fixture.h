#pragma once

#include <gtest/gtest.h>

#include "gpu/context.h"

namespace lumulus::test {

/// A context with validation and synchronisation validation; any message of theirs fails the test, as does a machine
/// without a device.
class VulkanTest : public testing::Test {
  protected:
    void TearDown() override {
        for (const std::string& message : context.validationMessages()) {
            ADD_FAILURE() << message;
        }
    }

    gpu::Context context{{.device = "", .validation = true}};
};

}  // namespace lumulus::test
