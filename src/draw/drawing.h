#pragma once

#include <span>
#include <vector>

#include "gpu/commands.h"
#include "gpu/transfer.h"
#include "medium/scattering_tables.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// What there is to draw: nothing is compiled or bound for the rest.
struct DrawFeatures {
    bool forwardCut = false;  ///< the forward peak is cut
    bool sun = false;
    bool photons = false;
    bool grey = false;         ///< albedo and phase function of each cloud are the same for all colours
    bool coloured = false;     ///< the phase function of a cloud differs between colours
    bool many = false;         ///< more than one instance
    bool ground = false;       ///< rays of a march end at a ground
    bool mesh = false;         ///< rays of a march end at meshes
    bool sparse = false;       ///< densities are in bricks
    bool air = false;          ///< the sky is an atmosphere
    bool skyReturn = false;    ///< a backward peak sends light of the sky to and fro along rays
    bool thickVoxels = false;  ///< of a march: voxels are so thick that the sun's light differs within one

    std::vector<gpu::SpecConstant> constants() const {
        return {gpu::SpecConstant::of(0, forwardCut), gpu::SpecConstant::of(1, sun),
                gpu::SpecConstant::of(2, photons),    gpu::SpecConstant::of(3, grey),
                gpu::SpecConstant::of(4, many),       gpu::SpecConstant::of(5, air),
                gpu::SpecConstant::of(8, coloured),   gpu::SpecConstant::of(9, skyReturn),
                gpu::SpecConstant::of(15, sparse)};
    }
};

/// Phase functions of the drawing passes on the GPU: the tables of all media, one after the other (InstanceParams has
/// their numbers).
struct PhaseTables {
    PhaseTables(gpu::Context& context, std::span<const phase::ScatteringTables* const> media, const DrawFeatures& how);
    gpu::Buffer phase;
    gpu::Image before, after;  ///< single-scattering tables H and K; a single texel where no peak is cut
};

/// The volumes that rays go through: those of the one instance, or atlases of all.
struct Volumes {
    const gpu::Image& density;
    const gpu::Image& bricks;  ///< their index; any image of integers where the density is dense
    const gpu::Image& majorants;
    const gpu::Image& lightField;
    const gpu::Image& shadowVolume;
    const gpu::Image& sunColours;  ///< of an atmosphere; a texel where there is none
    const gpu::Image& skyReturn;   ///< shared/sky_return.h; a texel where there is none
};

/// What every drawing pass reads and writes. `params` holds one shared::DrawParams, `instances` a
/// shared::InstanceParams each, `squares` the list of DRAW_SQUARES or DRAW_REFINED.
struct DrawInputs {
    const gpu::Buffer& params;
    const gpu::Buffer& instances;
    const PhaseTables& phase;
    const Volumes& volumes;
    const gpu::Buffer& pixels;
    const gpu::Buffer& squares;

    std::vector<gpu::Binding> bindings() const {
        return {{"Params", params},
                {"Instances", instances},
                {"PhaseTable", phase.phase},
                {"singleScatterH", phase.before},
                {"singleScatterK", phase.after},
                {"density", volumes.density, gpu::Sampler::linear},
                {"bricks", volumes.bricks, gpu::Sampler::nearest},
                {"lightField", volumes.lightField, gpu::Sampler::linearClamp},
                {"shadowVolume", volumes.shadowVolume, gpu::Sampler::linearClamp},
                {"sunColours", volumes.sunColours, gpu::Sampler::linearClamp},
                {"skyReturn", volumes.skyReturn, gpu::Sampler::linearClamp},
                {"Pixels", pixels},
                {"Blocks", squares}};
    }
};

/// Room for so many pixels, as structs and as texels.
inline gpu::Buffer pixelBuffer(gpu::Context& context, const char* name, std::uint64_t count) {
    return {context, name, count * static_cast<std::uint64_t>(shared::PIXEL_TEXELS), VK_FORMAT_R32G32B32A32_SFLOAT,
            gpu::Memory::device};
}

using DrawProgram = gpu::Program<shared::DrawPush>;

/// Records the drawing of pixels, sampling points or what is listed.
inline void dispatchDrawing(gpu::Commands& commands, const DrawProgram& program,
                            const std::vector<gpu::Binding>& bindings, const gpu::Buffer& squares,
                            const shared::DrawPush& push) {
    if (push.what == shared::DRAW_SQUARES || push.what == shared::DRAW_REFINED)
        commands.dispatchIndirect(program, bindings, push, squares);
    else
        commands.dispatch(program, bindings, push,
                          {(static_cast<std::uint32_t>(push.count.x) + 15) / 16,
                           (static_cast<std::uint32_t>(push.count.y) + 3) / 4, 1});
}

}  // namespace lumulus::draw
