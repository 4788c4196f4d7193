// Trees of a mesh in one run and on the same cores: ours on the host, and Embree's: mesh_bench FILE.glb [RAYS]. Rays
// start above the box of the mesh and look at points in it, and then leave in directions that have nothing in common.
#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstdlib>
#include <random>
#include <vector>

#include "mesh/bvh/world.h"
#include "mesh/gltf.h"

namespace lumulus::bench {
namespace {

/// Time of all cores, which other work on the machine lengthens less than that of the clock.
double cpuSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

template <class Work>
double secondsOf(const Work& work) {
    const double start = cpuSeconds();
    work();
    return cpuSeconds() - start;
}

std::vector<shared::MeshRay> raysAt(const bvh::Box& box, std::size_t count, bool alike) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> share(0.0F, 1.0F), along(-1.0F, 1.0F);
    const glm::vec3 size = box.upper - box.lower, eye = box.middle() + glm::vec3(0.1F, 0.8F, 0.6F) * glm::length(size);
    std::vector<shared::MeshRay> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t row = i / 1024;
        const glm::vec3 to = box.lower + size * (alike ? glm::vec3(static_cast<float>(i % 1024) / 1024.0F, 0.5F,
                                                                   static_cast<float>(row % 1024) / 1024.0F)
                                                       : glm::vec3(share(random), share(random), share(random)));
        rays[i] = {alike ? eye : to,
                   0.0F,
                   glm::normalize(alike ? to - eye : glm::vec3(along(random), along(random), along(random))),
                   1e30F,
                   -1,
                   -1};
    }
    return rays;
}

RTCScene embreeScene(RTCDevice device, const mesh::Model& model) {
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), model.vertices.size()));
    auto* triangles = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), model.triangles.size()));
    for (std::size_t i = 0; i < model.vertices.size(); ++i) vertices[i] = model.vertices[i].position;
    for (std::size_t i = 0; i < model.triangles.size(); ++i) triangles[i] = model.triangles[i].vertices;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    return scene;
}

float embreeDistance(RTCScene scene, const shared::MeshRay& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit call{};
    call.ray.org_x = ray.origin.x, call.ray.org_y = ray.origin.y, call.ray.org_z = ray.origin.z;
    call.ray.dir_x = ray.direction.x, call.ray.dir_y = ray.direction.y, call.ray.dir_z = ray.direction.z;
    call.ray.tfar = ray.most;
    call.ray.mask = ~0U;
    call.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &call);
    return call.hit.geomID == RTC_INVALID_GEOMETRY_ID ? ray.most : call.ray.tfar;
}

template <class Trace>
void measure(const char* name, std::span<const shared::MeshRay> rays, const Trace& trace) {
    std::atomic<std::size_t> met = 0;
    const double seconds = secondsOf([&] {
        tbb::parallel_for(std::size_t{0}, rays.size() / 1024, [&](std::size_t part) {
            std::size_t here = 0;
            for (std::size_t i = part * 1024; i < (part + 1) * 1024; ++i) here += trace(rays[i]) < rays[i].most;
            met += here;
        });
    });
    fmt::print("  {}: {:.2f} million rays a second and core, {} hits\n", name,
               1e-6 * static_cast<double>(rays.size()) / seconds, met.load());
}

void run(const char* file, std::size_t count) {
    mesh::Placed placed;
    fmt::print("reading: {:.2f} s\n", secondsOf([&] { placed.models.push_back(mesh::loadGltf(file)); }));
    placed.instances.push_back({0, glm::dmat4(1.0)});
    bvh::World world;
    fmt::print("{} triangles; seconds of a core\n", placed.models[0].triangles.size());
    const double ours = secondsOf([&] { world = bvh::buildWorld(placed, [] {}); });
    fmt::print("our tree: {:.2f} s, {:.1f} MiB\n", ours,
               static_cast<double>(world.nodes.size() * sizeof(shared::MeshNode) +
                                   world.triangles.size() * (sizeof(shared::MeshTriangle) + 4)) *
                   0x1p-20);
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = nullptr;
    fmt::print("Embree's tree: {:.2f} s\n", secondsOf([&] { scene = embreeScene(device, placed.models[0]); }));
    for (const bool alike : {true, false}) {
        fmt::print("{}\n", alike ? "rays of a picture" : "rays without order");
        const std::vector<shared::MeshRay> rays = raysAt(world.box, count, alike);
        for (int repeat = 0; repeat < 2; ++repeat) {
            measure("ours", rays, [&](const shared::MeshRay& ray) { return bvh::nearest(world, ray).distance; });
            measure("Embree", rays, [&](const shared::MeshRay& ray) { return embreeDistance(scene, ray); });
        }
    }
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
}

}  // namespace
}  // namespace lumulus::bench

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    lumulus::bench::run(argv[1], argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 2'000'000);
    return 0;
}
