#include "cloud/prepare_programs.h"

namespace lumulus::cloud {

namespace {

namespace spirv {
#include "spirv/cloud/block_majorant.comp.h"
#include "spirv/cloud/gradient_bound.comp.h"
#include "spirv/cloud/leaf_index.comp.h"
#include "spirv/cloud/leaf_statistics.comp.h"
#include "spirv/cloud/sample.comp.h"
}  // namespace spirv

}  // namespace

PreparePrograms::PreparePrograms(gpu::Context& context)
    : blockMajorant(context, "block_majorant", spirv::block_majorant_comp),
      fineMajorant(context, "block_majorant", spirv::block_majorant_comp, {gpu::SpecConstant::of(23, fineEdge)}),
      gradientBound(context, "gradient_bound", spirv::gradient_bound_comp),
      sample(context, "sample", spirv::sample_comp, {gpu::SpecConstant::of(15, false)}),
      leafStatistics(context, "leaf_statistics", spirv::leaf_statistics_comp),
      leafIndex(leafIndexProgram(context)) {}

gpu::Program<shared::LeafPush> leafIndexProgram(gpu::Context& context) {
    return {context, "leaf_index", spirv::leaf_index_comp};
}

}  // namespace lumulus::cloud
