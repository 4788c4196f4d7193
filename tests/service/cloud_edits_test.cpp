#include "service/render/cloud_edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "service/values/request_error.h"

namespace lumulus::service {
namespace {

using glm::dvec3;
using testing::ElementsAre;
using Kind = CloudEdit::Kind;

/// Two clouds, of which the second has no name.
scene::Scene twoClouds() {
    scene::Scene scene;
    scene.clouds.resize(2);
    scene.clouds[0].name = "west";
    return scene;
}

CloudEdit edit(Kind kind, CloudReference cloud, std::string name = {}) {
    CloudEdit edit;
    edit.kind = kind;
    edit.cloud = std::move(cloud);
    edit.name = std::move(name);
    return edit;
}

std::vector<std::string> namesOf(const scene::Scene& scene) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) names.push_back(scene::nameOf(scene, i));
    return names;
}

/// "code: place" of the error.
std::string refusal(const scene::Scene& scene, const std::vector<CloudEdit>& edits) {
    try {
        editClouds(scene, edits);
    } catch (const RequestError& e) {
        return e.code + ": " + e.where;
    }
    return "taken";
}

TEST(CloudEdits, NamesStayWhateverComesAndGoes) {
    CloudEdit east = edit(Kind::add, "west", "east");
    east.move = dvec3(1.0, 2.0, 3.0);
    east.yaw = 90.0;
    east.scale = 2.0;
    CloudEdit north = edit(Kind::add, "east", "north");
    north.move = dvec3(10.0, 0.0, 0.0);
    north.scale = 3.0;
    const EditedClouds edited =
        editClouds(twoClouds(), std::vector{east, edit(Kind::remove, "west"), north, edit(Kind::remove, 0U)});
    EXPECT_THAT(namesOf(edited.scene), ElementsAre("east", "north"));
    EXPECT_TRUE(edited.rebuilds);
    ASSERT_EQ(edited.origins.size(), 2U);
    EXPECT_TRUE(edited.origins[0].added);
    EXPECT_EQ(edited.origins[0].from, 0U);
    EXPECT_EQ(edited.origins[0].move, dvec3(1.0, 2.0, 3.0));
    EXPECT_DOUBLE_EQ(edited.origins[0].yaw, 0.5 * std::numbers::pi);
    EXPECT_EQ(edited.origins[1].move, dvec3(11.0, 2.0, 3.0));
    EXPECT_EQ(edited.origins[1].scale, 6.0);
    EXPECT_THAT(namesOf(editClouds(twoClouds(), std::vector{edit(Kind::remove, "west")}).scene), ElementsAre("1"));
}

TEST(CloudEdits, OnlyASubstanceIsMadeAnew) {
    CloudEdit one = edit(Kind::alter, "1");
    one.extinction = 0.5;
    one.move = dvec3(1.0, 0.0, 0.0);
    EditedClouds edited = editClouds(twoClouds(), std::vector{one});
    EXPECT_FALSE(edited.rebuilds);
    EXPECT_EQ(edited.scene.clouds[1].extinction, 0.5);
    EXPECT_EQ(edited.moves[1], dvec3(1.0, 0.0, 0.0));
    EXPECT_FALSE(edited.moves[0]);
    one.albedo = dvec3(0.5);
    one.asymmetry = 0.2;
    edited = editClouds(twoClouds(), std::vector{one});
    EXPECT_TRUE(edited.rebuilds);
    EXPECT_TRUE(edited.origins[1].substance);
    EXPECT_FALSE(edited.origins[0].substance);
    EXPECT_EQ(edited.scene.clouds[1].phase.g, 0.2);
}

TEST(CloudEdits, Refusals) {
    const scene::Scene scene = twoClouds();
    EXPECT_EQ(refusal(scene, {edit(Kind::remove, "north")}), "not_found: clouds[0].remove");
    EXPECT_EQ(refusal(scene, {edit(Kind::remove, 2U)}), "not_found: clouds[0].remove");
    EXPECT_EQ(refusal(scene, {edit(Kind::add, "north", "a")}), "not_found: clouds[0].like");
    EXPECT_EQ(refusal(scene, {edit(Kind::remove, "west"), edit(Kind::alter, "west")}), "not_found: clouds[1].cloud");
    EXPECT_EQ(refusal(scene, {edit(Kind::add, 0U, "west")}), "bad_request: clouds[0].add");
    EXPECT_EQ(refusal(scene, {edit(Kind::add, 0U, "1")}), "bad_request: clouds[0].add") << "that is the second's name";
    EXPECT_EQ(refusal(scene, {edit(Kind::add, 0U, "a"), edit(Kind::add, 0U, "a")}), "bad_request: clouds[1].add");
    scene::Scene droplets = scene;
    droplets.clouds[0].phase.model = scene::PhaseModel::mie;
    CloudEdit grey = edit(Kind::alter, 0U);
    grey.asymmetry = 0.5;
    EXPECT_EQ(refusal(droplets, {grey}), "bad_request: clouds[0].g");
    std::vector<CloudEdit> many;
    for (int i = 0; i < 254; ++i) many.push_back(edit(Kind::add, 0U, "copy " + std::to_string(i)));
    EXPECT_EQ(refusal(scene, many), "taken");
    many.push_back(edit(Kind::add, 0U, "one too many"));
    EXPECT_EQ(refusal(scene, many), "too_large: clouds[254].add");
}

}  // namespace
}  // namespace lumulus::service
