#include "surface/mesh/ray_tracer.h"

#include <algorithm>

#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::surface {
namespace {

namespace spirv {
#include "spirv/mesh/rays.comp.h"
}  // namespace spirv

constexpr std::size_t together = std::size_t{1} << 18U;  ///< rays of a dispatch
constexpr int mostHoles = 64;                            ///< that a ray goes through, one behind the other

}  // namespace

RayTracer::RayTracer(gpu::Context& context, const MeshScene& scene)
    : scene_(scene),
      program_(context, "mesh rays", spirv::rays_comp),
      nodes_(gpu::filledBuffer(context, "mesh nodes", scene.world.nodes)),
      triangles_(gpu::filledBuffer(context, "mesh triangles", scene.world.triangles)),
      instances_(gpu::filledBuffer(context, "mesh instances", scene.world.instances)),
      rays_(context, "mesh rays", together * sizeof(shared::MeshRay), gpu::Memory::host),
      hits_(context, "mesh hits", together * sizeof(shared::MeshHit), gpu::Memory::host) {}

void RayTracer::trace(std::span<const shared::MeshRay> rays, std::span<shared::MeshHit> hits, bool any,
                      const RunGpu& run, const Check& check) {
    for (std::size_t first = 0; first < rays.size(); first += together) {
        check();
        const std::size_t count = std::min(together, rays.size() - first);
        std::ranges::copy(rays.subspan(first, count), rays_.mapped<shared::MeshRay>().begin());
        run([&](gpu::Commands& commands) {
            commands.pass("mesh rays");
            commands.dispatch(program_,
                              {{"Nodes", nodes_},
                               {"Triangles", triangles_},
                               {"MeshInstances", instances_},
                               {"Rays", rays_},
                               {"Hits", hits_}},
                              {static_cast<std::uint32_t>(count), any ? 1 : 0}, gpu::linearGroups(count, 64));
        });
        std::ranges::copy(hits_.mapped<const shared::MeshHit>().first(count),
                          hits.begin() + static_cast<std::ptrdiff_t>(first));
    }
}

std::vector<shared::MeshHit> RayTracer::nearest(std::span<const shared::MeshRay> rays, const RunGpu& run,
                                                const Check& check) {
    std::vector<shared::MeshHit> hits(rays.size());
    trace(rays, hits, false, run, check);
    if (!scene_.masked) return hits;
    std::vector<std::size_t> open(rays.size());
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
    for (int hole = 0; hole < mostHoles && !open.empty(); ++hole) {
        std::vector<shared::MeshRay> further;
        std::vector<std::size_t> of;
        for (const std::size_t i : open) {
            if (hits[i].instance < 0 || scene_.isThere(hits[i])) continue;
            further.push_back(rays[i]);
            further.back().least = hits[i].distance;
            further.back().fromInstance = hits[i].instance;
            further.back().fromTriangle = hits[i].triangle;
            of.push_back(i);
        }
        std::vector<shared::MeshHit> found(further.size());
        trace(further, found, false, run, check);
        for (std::size_t i = 0; i < of.size(); ++i) hits[of[i]] = found[i];
        open = std::move(of);
    }
    return hits;
}

std::vector<bool> RayTracer::blocked(std::span<const shared::MeshRay> rays, const RunGpu& run, const Check& check) {
    std::vector<shared::MeshHit> hits;
    if (scene_.masked) {
        hits = nearest(rays, run, check);
    } else {
        hits.resize(rays.size());
        trace(rays, hits, true, run, check);
    }
    std::vector<bool> met;
    met.reserve(hits.size());
    for (const shared::MeshHit& hit : hits) met.push_back(hit.instance >= 0);
    return met;
}

}  // namespace lumulus::surface
