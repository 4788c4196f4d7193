#include "volume/place_clouds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "base/error.h"
#include "support/temporary_folder.h"
#include "vdb/procedural.h"
#include "volume/field_places.h"
#include "volume/load.h"

namespace lumulus {
namespace {

using testing::AllOf;
using testing::HasSubstr;

scene::Field fieldOf(scene::FieldKind kind, double cover) {
    scene::Field field;
    field.kind = kind;
    field.cover = cover;
    field.area = {6000.0, 0.0, 8000.0};
    field.center = {500.0, 0.0, -700.0};
    field.smallest = 300.0;
    field.largest = 1200.0;
    field.resolution = 64;
    field.variants = 3;
    if (kind == scene::FieldKind::cirrus) field.extinction = 0.02;
    return field;
}

scene::Scene sceneOf(const scene::Field& field) {
    scene::Scene scene;
    scene.fields = {field};
    return scene;
}

/// Share of the field's area with an optical thickness above the least that is seen, by the voxels of all its clouds.
double coverOf(const scene::Field& field) {
    const CloudVolumes loaded = loadClouds(placeClouds(sceneOf(field)));
    std::vector<std::vector<double>> columns;
    for (const auto& each : loaded.volumes) {
        const vdb::Volume& volume = *each;
        std::vector<double>& sums = columns.emplace_back(static_cast<std::size_t>(volume.size.x * volume.size.z));
        for (int z = 0; z < volume.size.z; ++z)
            for (int y = 0; y < volume.size.y; ++y)
                for (int x = 0; x < volume.size.x; ++x)
                    sums[static_cast<std::size_t>(z * volume.size.x + x)] +=
                        static_cast<double>(volume.density[volume.index(x, y, z)]);
    }
    constexpr int across = 120;
    int covered = 0;
    for (int i = 0; i < across * across; ++i) {
        const glm::dvec3 at = field.center + field.area * glm::dvec3((i % across + 0.5) / across - 0.5, 0.0,
                                                                     (i / across + 0.5) / across - 0.5);
        double thickness = 0.0;
        for (const CloudVolumes::Cloud& cloud : loaded.clouds) {
            const glm::dvec3 voxel = glm::inverse(cloud.toWorld.linear) * (at - cloud.toWorld.translation);
            const vdb::Volume& volume = *loaded.volumes[cloud.volume];
            if (voxel.x < 0.0 || voxel.z < 0.0 || voxel.x >= volume.size.x || voxel.z >= volume.size.z) continue;
            const auto place =
                static_cast<std::size_t>(static_cast<int>(voxel.z) * volume.size.x + static_cast<int>(voxel.x));
            thickness += columns[cloud.volume][place] * field.extinction * glm::length(cloud.toWorld.linear[1]);
        }
        covered += thickness > visibleThickness ? 1 : 0;
    }
    return static_cast<double>(covered) / (across * across);
}

TEST(Fields, CoverWhatIsAsked) {
    for (const double cover : {0.1, 0.3, 0.6})
        EXPECT_NEAR(coverOf(fieldOf(scene::FieldKind::cumulus, cover)), cover, 0.03) << cover;
    for (const double cover : {0.4, 0.8})
        EXPECT_NEAR(coverOf(fieldOf(scene::FieldKind::stratocumulus, cover)), cover, 0.03) << cover;
    EXPECT_NEAR(coverOf(fieldOf(scene::FieldKind::cirrus, 0.3)), 0.3, 0.03);
}

TEST(Fields, ADeckOfCoverOneIsClosed) {
    EXPECT_GT(coverOf(fieldOf(scene::FieldKind::stratocumulus, 1.0)), 0.98);
    EXPECT_GT(coverOf(fieldOf(scene::FieldKind::cumulus, 1.0)), 0.95);
    EXPECT_TRUE(placeClouds(sceneOf(fieldOf(scene::FieldKind::cumulus, 0.0))).clouds.empty());
}

TEST(Fields, SizesFollowThePowerLaw) {
    scene::Field field = fieldOf(scene::FieldKind::cumulus, 0.25);
    field.area = {30e3, 0.0, 30e3};
    field.largest = 3000.0;
    std::vector<double> native;  // the diameter of each variant at scale 1, from the largest cloud of all
    const std::vector<FieldPlace> places = placesOf(field, "field0", 100000);
    ASSERT_GT(places.size(), 200U);
    // Of n(D) ∝ D^-b the share of clouds above D is (D^(1-b) − l^(1-b)) / (s^(1-b) − l^(1-b)). Scales are diameters
    // over those of the variants, which differ little; the median of each third of the range is compared.
    std::vector<double> scales;
    for (const FieldPlace& one : places) scales.push_back(one.place.scale);
    std::ranges::sort(scales);
    const auto at = [&](double share) {
        return scales[static_cast<std::size_t>(share * static_cast<double>(scales.size() - 1))];
    };
    const auto quantile = [&](double u) {
        const double p = 1.0 - field.exponent;
        return std::pow(glm::mix(std::pow(field.smallest, p), std::pow(field.largest, p), u), 1.0 / p);
    };
    for (const double u : {0.2, 0.5, 0.8, 0.95})
        EXPECT_NEAR((at(u) / at(0.05)) / (quantile(u) / quantile(0.05)), 1.0, 0.12) << u;
}

TEST(Fields, NoCloudRepeats) {
    scene::Field field = fieldOf(scene::FieldKind::cumulus, 0.3);
    field.area = {14e3, 0.0, 14e3};
    field.variants = 6;
    const std::vector<FieldPlace> places = placesOf(field, "field0", 100000);
    ASSERT_GT(places.size(), 150U);
    std::map<int, int> uses;
    for (std::size_t i = 0; i < places.size(); ++i) {
        ++uses[places[i].variant];
        EXPECT_EQ(places[i].place.position.y, field.base);
        for (std::size_t j = 0; j < i; ++j) {
            if (places[j].variant != places[i].variant) continue;
            const double turned = std::abs(std::remainder(places[i].place.yaw - places[j].place.yaw, 360.0));
            const double scaled = std::abs(std::log(places[i].place.scale / places[j].place.scale));
            const double apart = glm::distance(places[i].place.position, places[j].place.position);
            // neighbours of one variant differ in turn or size
            EXPECT_TRUE(apart > 1000.0 || turned > 3.0 || scaled > 0.03) << i << " and " << j;
        }
    }
    EXPECT_EQ(uses.size(), static_cast<std::size_t>(field.variants));
    for (const auto& [variant, count] : uses) EXPECT_LT(count, static_cast<int>(places.size()) / 3) << variant;
}

TEST(Fields, FibresOfCirrusLieAlongTheWind) {
    scene::Field field = fieldOf(scene::FieldKind::cirrus, 0.3);
    const glm::dvec3 wind(10.0, 0.0, 10.0);
    field.wind = wind;
    for (const FieldPlace& one : placesOf(field, "field0", 1000)) {
        const glm::dvec3 along(one.place.transform() * glm::dvec4(1.0, 0.0, 0.0, 0.0));
        EXPECT_GT(glm::dot(glm::normalize(along), glm::normalize(wind)), 0.97);
    }
}

/// A wind that grows linearly with height carries each cloud as far as the middle of its voxels is high.
TEST(Fields, DriftWithTheWindAtTheirMiddle) {
    scene::Field field = fieldOf(scene::FieldKind::cumulus, 0.2);
    scene::Scene scene = sceneOf(field);
    constexpr double shear = 0.01, seconds = 600.0;
    scene.fields[0].wind.levels = {{0.0, glm::dvec3(0.0)}, {4000.0, {4000.0 * shear, 0.0, -2000.0 * shear}}};
    scene.seconds = seconds;
    scene::Scene along = scene;  // rows of clouds lie along the wind whenever
    along.seconds = 0.0;
    const scene::Scene first = placeClouds(along), moved = placeClouds(scene);
    const CloudVolumes volumes = loadClouds(first);
    ASSERT_EQ(moved.clouds.size(), first.clouds.size());
    double least = 1e9, most = 0.0;
    for (std::size_t i = 0; i < moved.clouds.size(); ++i) {
        const glm::dvec3 way(moved.clouds[i].transform[3] - first.clouds[i].transform[3]);
        const vdb::Volume& volume = *volumes.volumes[volumes.clouds[i].volume];
        const double voxel = volumes.clouds[i].toWorld.linear[1].y;
        int top = 0;
        for (std::size_t at = 0; at < volume.density.size(); ++at)
            if (volume.density[at] > 0.0F)
                top = std::max(top, static_cast<int>(at) / volume.size.x % volume.size.y + 1);
        const double height = volumes.clouds[i].toWorld.point({0.0, top, 0.0}).y;
        EXPECT_NEAR(way.x / (shear * seconds), 0.5 * (field.base + height), 2.0 * voxel) << i;
        EXPECT_NEAR(way.z, -0.5 * way.x, 1e-6) << i;
        EXPECT_EQ(way.y, 0.0);
        least = std::min(least, way.x), most = std::max(most, way.x);
    }
    EXPECT_GT(most - least, 0.1 * shear * seconds * field.largest) << "large clouds reach higher, and move faster";
}

/// All as one: a constant wind, one level, and heights beyond the last level.
TEST(Fields, DriftAsOneWhereTheWindIsTheSame) {
    scene::Scene scene = sceneOf(fieldOf(scene::FieldKind::stratocumulus, 0.5));
    const glm::dvec3 wind(12.0, 0.5, -3.0);
    scene.fields[0].wind = wind;
    const scene::Scene first = placeClouds(scene);
    scene.seconds = 10.0;
    const scene::Scene moved = placeClouds(scene);
    for (std::size_t i = 0; i < moved.clouds.size(); ++i)
        EXPECT_LT(glm::distance(glm::dvec3(moved.clouds[i].transform[3] - first.clouds[i].transform[3]), 10.0 * wind),
                  1e-9);
    scene.fields[0].wind.levels = {{5000.0, wind}};
    EXPECT_EQ(placeClouds(scene).clouds, moved.clouds);
    scene.fields[0].wind.levels = {{-100.0, glm::dvec3(1.0)}, {scene.fields[0].base, wind}};
    EXPECT_EQ(placeClouds(scene).clouds, moved.clouds);
}

TEST(Fields, KnownPlacesAreThoseOfTheField) {
    KnownPlaces known;
    scene::Scene scene = sceneOf(fieldOf(scene::FieldKind::cumulus, 0.2));
    for (const double seconds : {0.0, 5.0, 10.0})
        for (const double cover : {0.2, 0.3}) {
            scene.fields[0].cover = cover;
            scene.seconds = seconds;
            EXPECT_EQ(placeClouds(scene, &known), placeClouds(scene)) << seconds << ", " << cover;
        }
}

TEST(Fields, AreTheSameEachTimeAndDifferBySeed) {
    scene::Field field = fieldOf(scene::FieldKind::cumulus, 0.2);
    const scene::Scene first = placeClouds(sceneOf(field));
    EXPECT_EQ(first, placeClouds(sceneOf(field)));
    EXPECT_EQ(first, placeClouds(first));
    field.seed = 2;
    EXPECT_FALSE(first == placeClouds(sceneOf(field)));
    EXPECT_EQ(first.clouds.at(3).name, "field0[3]");
}

TEST(Fields, TooManyCloudsAreRefusedWithBothNumbers) {
    scene::Field field = fieldOf(scene::FieldKind::cumulus, 0.9);
    field.area = {1e6, 0.0, 1e6};
    field.smallest = 20.0;
    for (const scene::FieldKind kind : {scene::FieldKind::cumulus, scene::FieldKind::stratocumulus}) {
        field.kind = kind;
        if (kind == scene::FieldKind::stratocumulus) field.largest = 20.0;
        try {
            placeClouds(sceneOf(field));
            FAIL();
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), AllOf(HasSubstr("the field needs "), HasSubstr("has room for 186413")));
        }
    }
}

class Instances : public testing::Test {
  protected:
    scene::Scene sceneWith(const std::string& rows) {
        test::writeAll(folder_ / "places.csv", "x,y,z,yaw,scale,extinction\n" + rows);
        scene::Scene scene;
        scene.clouds.resize(2);
        scene.clouds[0].procedural = "sphere";
        scene.clouds[0].resolution = 16;
        scene.clouds[0].transform[3] = {5.0, 0.0, 0.0, 1.0};
        scene.clouds[0].instances = folder_ / "places.csv";
        scene.clouds[1].procedural = "slab";
        scene.clouds[1].resolution = 12;
        return scene;
    }
    test::TemporaryFolder folder_;
};

TEST_F(Instances, ShareTheFieldAndStandInTheirPlaces) {
    const scene::Scene scene = placeClouds(sceneWith("100,200,300,90,2,0.5\n-1e7,0,0,0,1,1\n"));
    ASSERT_EQ(scene.clouds.size(), 3U);
    EXPECT_EQ(scene.clouds[0].name, "0[0]");
    EXPECT_EQ(scene.clouds[1].name, "0[1]");
    EXPECT_EQ(scene.clouds[2].name, "1");
    EXPECT_DOUBLE_EQ(scene.clouds[0].extinction, 0.04);
    const CloudVolumes loaded = loadClouds(scene);
    ASSERT_EQ(loaded.volumes.size(), 2U);
    EXPECT_EQ(loaded.clouds[0].volume, loaded.clouds[1].volume);
    const glm::dvec3 middle = 0.5 * glm::dvec3(loaded.volumes[0]->size);
    const glm::dvec3 own = loaded.volumes[0]->toWorld.point(middle);
    // the transform moves the ball by 5 m along x; the row doubles that, turns it towards +Z, and moves it
    EXPECT_LT(glm::distance(loaded.clouds[0].toWorld.point(middle), glm::dvec3(100.0, 200.0 + 2.0 * own.y, 310.0)),
              1e-6);
    EXPECT_LT(glm::distance(loaded.clouds[1].toWorld.point(middle), glm::dvec3(-1e7 + 5.0, own.y, 0.0)), 1e-6);
}

TEST_F(Instances, MoreThanTheBudgetAreRefusedWithBothNumbers) {
    std::string rows;
    for (int i = 0; i < 1000000; ++i) rows += "0,0,0,0,1,1\n";
    try {
        placeClouds(sceneWith(rows));
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), AllOf(HasSubstr("1000000 instances need at least 5494 MiB"), HasSubstr("has 1024 MiB")));
    }
}

TEST(PlaceClouds, CloudsOfAFieldScatterAsItSays) {
    scene::Field field = fieldOf(scene::FieldKind::cumulus, 0.2);
    field.albedo = {1.0, 0.9, 0.8};
    field.phase.model = scene::PhaseModel::mie;
    field.phase.effectiveRadius = 7.0;
    const scene::Scene placed = placeClouds(sceneOf(field));
    ASSERT_FALSE(placed.clouds.empty());
    for (const scene::Cloud& cloud : placed.clouds) {
        EXPECT_EQ(cloud.phase, field.phase);
        EXPECT_EQ(cloud.albedo, field.albedo);
    }
}

TEST(PlaceClouds, LeavesOtherScenesAlone) {
    scene::Scene scene;
    scene.clouds.resize(2);
    EXPECT_EQ(placeClouds(scene), scene);
}

}  // namespace
}  // namespace lumulus
