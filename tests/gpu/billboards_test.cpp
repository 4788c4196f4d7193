#include "draw/billboards.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>
#include <vector>

#include "support/cloud_cases.h"
#include "support/vulkan_fixture.h"
#include "view/bounds.h"

namespace lumulus::draw {
namespace {

using glm::dvec3;
using shared::Billboard;

/// Numbers in the place of the collectors' shares: they tell which billboard is whose.
std::vector<float> numbers(std::size_t count) {
    std::vector<float> result(count);
    std::iota(result.begin(), result.end(), 0.0F);
    return result;
}

std::size_t collectorOf(const Billboard& billboard) {
    return static_cast<std::size_t>(billboard.share);
}

class MakeBillboards : public test::VulkanTest {
  protected:
    vdb::Volume volume = test::cloudCases()[2].volume;
    cloud::Asset cloud = cloud::prepare(context, volume, test::prepareOptions(1000));
    cloud::Instance instance = placed(volume.toWorld);

    cloud::Instance placed(const vdb::Affine& place) {
        cloud::Instance result;
        result.asset = &cloud;
        result.voxelToMetres = place.linear;
        result.origin = place.translation;
        return result;
    }
    std::vector<Billboard> billboardsOf(const Camera& camera) {
        const cloud::Instance* instances[] = {&instance};
        const std::vector<float> shares[] = {numbers(cloud.collectors.size())};
        return makeBillboards(instances, shares, camera);
    }

    static Camera cameraAt(const dvec3& position, scene::Projection projection) {
        scene::Camera camera;
        camera.position = position;
        camera.target = position + dvec3(0.3, 0.2, -1.0);
        camera.projection = projection;
        return makeCamera(camera, {64, 64}, Bounds{});
    }
};

TEST_F(MakeBillboards, StandWhereTheirLeavesHaveDensity) {
    const dvec3 eye(10.0, 20.0, 200.0);
    const auto billboards = billboardsOf(cameraAt(eye, scene::Projection::perspective));
    ASSERT_EQ(billboards.size(), cloud.collectors.size());
    for (const Billboard& b : billboards) {
        const cloud::Collector& collector = cloud.collectors[collectorOf(b)];
        const double sphere = 4.0 / 3.0 * std::numbers::pi * std::pow(static_cast<double>(b.radius), 3);
        const double filled = std::max(collector.occupiedVoxels(), static_cast<double>(collector.mass));
        const double filledVolume = static_cast<double>(shared::BILLBOARD_OVERLAP) * filled * cloud.voxelVolume;
        ASSERT_NEAR(sphere, filledVolume, 1e-5 * filledVolume);
        const dvec3 place = instance.toWorld(dvec3(collector.centre)) - eye;
        ASSERT_LT(glm::distance(dvec3(b.centre), place), 1e-4);
    }
}

/// Nearest first: by distance from the eye, along the view where all rays are parallel.
TEST_F(MakeBillboards, AreSortedForTheProjection) {
    for (const auto projection :
         {scene::Projection::perspective, scene::Projection::orthographic, scene::Projection::panorama}) {
        const Camera camera = cameraAt({30.0, 30.0, 30.0}, projection);  // inside
        const auto billboards = billboardsOf(camera);
        double last = -1e300;
        for (const Billboard& b : billboards) {
            const dvec3 centre = instance.toWorld(dvec3(cloud.collectors[collectorOf(b)].centre)) - camera.position;
            const double order =
                projection == scene::Projection::orthographic ? glm::dot(centre, camera.axes[2]) : glm::length(centre);
            ASSERT_GE(order, last - 1e-9);
            last = order;
        }
    }
}

/// Billboards of two instances of one asset are in one order, and each knows whose it is.
TEST_F(MakeBillboards, OfTwoInstancesAreSortedTogether) {
    cloud::Instance other = instance;
    other.offset = {5.0, 0.0, -3.0};
    const cloud::Instance* instances[] = {&instance, &other};
    const std::vector<float> each = numbers(cloud.collectors.size()), shares[] = {each, each};
    const Camera camera = cameraAt({10.0, 20.0, 200.0}, scene::Projection::perspective);
    const auto billboards = makeBillboards(instances, shares, camera);
    ASSERT_EQ(billboards.size(), 2 * cloud.collectors.size());
    double last = 0.0;
    for (const Billboard& b : billboards) {
        const cloud::Instance& whose = b.instance == 0.0F ? instance : other;
        const dvec3 place = whose.toWorld(dvec3(cloud.collectors[collectorOf(b)].centre)) - camera.position;
        ASSERT_LT(glm::distance(dvec3(b.centre), place), 1e-4);
        ASSERT_GE(glm::length(place), last - 1e-9);
        last = glm::length(place);
    }
}

TEST_F(MakeBillboards, TiesAreBrokenByIndex) {
    const dvec3 eye(1.0, 2.0, 3.0);
    instance = placed({});
    const cloud::Collector some = cloud.collectors[0];
    cloud.collectors.assign(600, some);
    // mirror images of one place about the eye, at three distances, in no order of distance
    for (std::size_t i = 0; i < cloud.collectors.size(); ++i) {
        const double distance = 4.0 + static_cast<double>((i * 7) % 3);
        const dvec3 sign(i & 1U ? 1 : -1, i & 2U ? 1 : -1, i & 4U ? 1 : -1);
        cloud.collectors[i].centre = glm::vec3(eye + distance * sign);
    }
    const auto billboards = billboardsOf(cameraAt(eye, scene::Projection::perspective));
    ASSERT_EQ(billboards.size(), 600U);
    for (std::size_t i = 1; i < billboards.size(); ++i) {
        if (i % 200 == 0) continue;  // the next distance
        ASSERT_LT(collectorOf(billboards[i - 1]), collectorOf(billboards[i]));
    }
}

}  // namespace
}  // namespace lumulus::draw
