#include <gtest/gtest.h>

#include <atomic>

#include "cloud/asset.h"
#include "support/cloud_cases.h"
#include "support/vulkan_fixture.h"
#include "vdb/procedural.h"

namespace lumulus::cloud {
namespace {

using PrepareCheck = test::VulkanTest;

struct Ended {};

/// The preparation of a large field asks again and again whether to go on, from the first piece to the last, so that a
/// load ends when its time is over or its client leaves.
TEST_F(PrepareCheck, EndsWhereverItIsAsked) {
    const vdb::Volume volume = vdb::makeCloud({"cumulus", 160, 1});
    PrepareOptions options = test::prepareOptions(2000);
    options.reducedExtinction = 0.05;
    std::atomic<int> asked = 0;
    options.check = [&] { ++asked; };
    const Asset whole = prepare(context, volume, options);
    const int all = asked;
    // a piece is 65,536 voxels of the quantisation or four slices of the sums, and the tree asks for each leaf
    EXPECT_GT(all, 200);
    for (const int last : {1, all / 3, 2 * all / 3, all - 1}) {
        asked = 0;
        options.check = [&] {
            if (++asked >= last) throw Ended{};
        };
        EXPECT_THROW(prepare(context, volume, options), Ended) << last << " of " << all;
    }
}

}  // namespace
}  // namespace lumulus::cloud
