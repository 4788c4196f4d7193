// Exposure over time: half a second to bright, two to dark, and none for a frame by itself.
#include "service/render/exposure_desk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/exposure.h"

namespace lumulus::service {
namespace {

using std::chrono::milliseconds;

TEST(Adaptation, FollowsInItsTime) {
    Adaptation eye;
    const Clock::time_point start{};
    EXPECT_EQ(eye.follow(10.0, start), 10.0);
    EXPECT_NEAR(eye.follow(12.0, start + milliseconds(500)), 12.0 - 2.0 * std::exp(-1.0), 1e-9);
    Adaptation dark;
    dark.follow(10.0, start);
    EXPECT_NEAR(dark.follow(8.0, start + milliseconds(2000)), 8.0 + 2.0 * std::exp(-1.0), 1e-9);
}

TEST(Adaptation, DoesNotDependOnTheRateOfFrames) {
    Adaptation slow, fast;
    const Clock::time_point start{};
    slow.follow(3.0, start);
    fast.follow(3.0, start);
    for (int i = 1; i <= 30; ++i) fast.follow(7.0, start + milliseconds(20 * i));
    EXPECT_NEAR(fast.follow(7.0, start + milliseconds(600)), slow.follow(7.0, start + milliseconds(600)), 1e-9);
}

std::vector<ViewResult> viewsOf(float radiance) {
    ViewResult view;
    view.image.width = view.image.height = 4;
    for (const char* name : {"R", "G", "B"}) view.image.layer(name, radiance);
    view.image.layer("A", 1.0F);
    std::vector<ViewResult> views;
    views.push_back(std::move(view));
    return views;
}

TEST(ExposureDesk, StreamsAdaptAndSingleFramesDoNot) {
    ExposureDesk desk;
    scene::Image image;
    image.exposureMode = scene::ExposureMode::automatic;
    Job job;
    job.stream = true;
    const Clock::time_point start{};
    const double first = desk.toneOf(image, job, viewsOf(1.0F), true, start).gain;
    EXPECT_NEAR(first, 0.18, 1e-6);
    EXPECT_NEAR(desk.toneOf(image, job, viewsOf(4.0F), true, start).gain, 0.18, 1e-6);
    EXPECT_NEAR(std::log2(desk.toneOf(image, job, viewsOf(4.0F), true, start + milliseconds(500)).gain / 0.18),
                -2.0 * (1.0 - std::exp(-1.0)), 1e-5);
    Job other = job;
    other.client = 7;
    EXPECT_NEAR(desk.toneOf(image, other, viewsOf(4.0F), true, start).gain, 0.045, 1e-6);
    job.stream = false;
    EXPECT_NEAR(desk.toneOf(image, job, viewsOf(4.0F), true, start).gain, 0.045, 1e-6);
    image.exposureMode = scene::ExposureMode::stops;
    EXPECT_EQ(desk.toneOf(image, other, viewsOf(4.0F), true, start).gain, 1.0);
}

/// A sky beside a cloud that covers the right half of it.
std::vector<ViewResult> cloudBefore(float sky, float cloud) {
    std::vector<ViewResult> views = viewsOf(sky);
    LayeredImage& image = views.front().image;
    for (const char* name : {"R", "G", "B"}) image.layer(std::string("cloud.") + name, 0.0F);
    image.layer("cloud.A", 0.0F);
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        if (i % 4 < 2) continue;
        image.layers["cloud.A"][i] = 1.0F;
        for (const char* name : {"R", "G", "B"})
            image.layers[name][i] = image.layers[std::string("cloud.") + name][i] = cloud;
    }
    return views;
}

/// Dusk becomes noon: the sky is a thousand times as bright at once, the clouds only when photons have come.
TEST(ExposureDesk, CloudsOfAnotherSunDoNotCount) {
    ExposureDesk desk;
    scene::Image image;
    image.exposureMode = scene::ExposureMode::automatic;
    const Job job;
    const Clock::time_point start{};
    EXPECT_NEAR(desk.toneOf(image, job, cloudBefore(0.3F, 1.6F), true, start).gain, 0.5, 1e-5);
    EXPECT_NEAR(desk.toneOf(image, job, cloudBefore(300.0F, 1.6F), false, start).gain, 0.0005, 1e-8);
    EXPECT_NEAR(desk.toneOf(image, job, cloudBefore(300.0F, 1600.0F), true, start).gain, 0.0005, 1e-8);
    // and back
    EXPECT_NEAR(desk.toneOf(image, job, cloudBefore(0.3F, 1600.0F), false, start).gain, 0.5, 1e-5);
}

}  // namespace
}  // namespace lumulus::service
