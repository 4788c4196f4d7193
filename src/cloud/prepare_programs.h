#pragma once

#include "gpu/program.h"
#include "shared/cloud.h"

namespace lumulus::cloud {

/// Programs that prepare() runs for a dense field. They share what is compiled with all others of one context that live
/// at the same time: who makes several assets holds one, so that nothing is compiled for each.
struct PreparePrograms {
    explicit PreparePrograms(gpu::Context& context);

    gpu::Program<shared::BlockPush> blockMajorant, fineMajorant, gradientBound;
    gpu::Program<shared::SamplePush> sample;
    gpu::Program<shared::LeafPush> leafStatistics, leafIndex;
};

/// That of PreparePrograms, alone.
gpu::Program<shared::LeafPush> leafIndexProgram(gpu::Context& context);

/// Edge of the fine blocks, voxels.
inline constexpr int fineEdge = 2;

}  // namespace lumulus::cloud
