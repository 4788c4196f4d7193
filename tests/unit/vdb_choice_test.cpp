// Which grid of a file becomes the cloud.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "unit/vdb_grids.h"
#include "vdb/choose_grid.h"
#include "vdb/describe.h"
#include "vdb/grid_rank.h"

namespace lumulus::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using vdb::GridLabel;

GridLabel floats(const std::string& name) {
    return {name, "float", true};
}

GridLabel emptyFloats(const std::string& name) {
    GridLabel label = floats(name);
    label.hasContent = [] { return false; };
    return label;
}

std::vector<GridLabel> named(const std::vector<std::string>& names) {
    std::vector<GridLabel> labels;
    for (const std::string& name : names) labels.push_back(floats(name));
    return labels;
}

vdb::GridChoice choose(const std::vector<GridLabel>& labels, const std::string& wanted = "") {
    return vdb::chooseGrid(labels, wanted, "a.vdb", "cloud.0.grid");
}

/// Name of the grid that is taken.
std::string taken(const std::vector<std::string>& names, const std::string& wanted = "") {
    return names[choose(named(names), wanted).index];
}

TEST(GridChoice, TakesTheNameOfADensity) {
    EXPECT_EQ(taken({"flame", "heat", "smoke"}), "smoke");
    EXPECT_EQ(taken({"smoke", "density"}), "density");
    EXPECT_EQ(taken({"temperature", "Density"}), "Density");
    EXPECT_EQ(taken({"temperature", "density "}), "density ");
    EXPECT_EQ(taken({"QVAPOR", "LWC"}), "LWC");
    EXPECT_EQ(taken({"T", "QVAPOR", "QCLOUD"}), "QCLOUD");
    EXPECT_EQ(taken({"fuel", "Burn", "cloud_density"}), "cloud_density");
    EXPECT_EQ(taken({"density_2", "cloud"}), "cloud");
    EXPECT_EQ(taken({"extinction", "smoke"}), "smoke");
}

TEST(GridChoice, LeavesOtherQuantitiesWhereThereIsAnother) {
    for (const char* other : {"temperature", "Temp", "heat", "flames", "fuel", "vel", "velocity.x", "v.x", "vel_y", "v",
                              "smoke_temperature", "flame_density", "QVAPOR", "pressure", "divergence", "wind_speed"}) {
        EXPECT_EQ(vdb::nameRank(other), vdb::otherQuantity) << other;
        EXPECT_EQ(taken({other, "g17"}), "g17") << other;
        EXPECT_EQ(taken({other, ""}), "") << other;
    }
    for (const char* silent : {"", "g0", "Dichte_ä雲", "volume", "value", "uniform", "tank"})
        EXPECT_LT(vdb::nameRank(silent), vdb::otherQuantity) << silent;
}

TEST(GridChoice, WarnsUnlessTheGridIsCalledDensity) {
    EXPECT_THAT(choose(named({"heat", "density"})).warnings, IsEmpty());
    EXPECT_THAT(
        choose(named({"heat", "smoke"})).warnings,
        ElementsAre(AllOf(HasSubstr("grid \"smoke\" is taken"), HasSubstr("cloud.0.grid"), HasSubstr("\"heat\""))));
    EXPECT_THAT(choose(named({"Density"})).warnings,
                ElementsAre(HasSubstr("grid \"Density\" is taken as \"density\"")));
    EXPECT_THAT(choose(named({"density "})).warnings, ElementsAre(HasSubstr("grid \"density \" is taken")));
    EXPECT_THAT(choose(named({"vel.x", "vel.y"})).warnings,
                ElementsAre(HasSubstr("no grid has the name of a density: grid \"vel.x\"")));
    EXPECT_THAT(choose(named({"heat", "smoke"}), "heat").warnings, IsEmpty()) << "it was asked for";
}

TEST(GridChoice, AnEmptyGridGivesWay) {
    const auto choice = choose({emptyFloats("density"), floats("temperature"), floats("smoke")});
    EXPECT_EQ(choice.index, 2U);
    EXPECT_THAT(choice.warnings, ElementsAre(HasSubstr("grid \"density\" is empty: grid \"smoke\" is taken")));
    EXPECT_EQ(choose({emptyFloats("density"), floats("temperature")}).index, 0U) << "but not to another quantity";
    EXPECT_EQ(choose({emptyFloats("density"), floats("smoke")}, "density").index, 0U) << "nor if it is asked for";
}

TEST(GridChoice, NamesInAnyCaseAndWithNumbers) {
    const std::vector<std::string> names{"heat", "density", "Density ", "density"};
    EXPECT_EQ(choose(named(names), "HEAT").index, 0U);
    EXPECT_EQ(choose(named(names), " density").index, 1U);
    EXPECT_EQ(choose(named(names), "density[0]").index, 1U);
    EXPECT_EQ(choose(named(names), "density[1]").index, 2U);
    EXPECT_EQ(choose(named(names), "DENSITY[2]").index, 3U);
    EXPECT_EQ(choose(named(names), "Density ").index, 2U) << "as it is written goes first";
    EXPECT_EQ(choose(named({"density", "density[1]"}), "density[1]").index, 1U) << "a grid may be called so";
    EXPECT_THAT(choose(named(names), "density").warnings,
                ElementsAre(AllOf(HasSubstr("3 grids are called \"density\""), HasSubstr("density[1]"))));
    EXPECT_THAT(choose(named(names)).warnings, ElementsAre(HasSubstr("3 grids are called \"density\"")));
    EXPECT_THAT(choose(named(names), "density[1]").warnings, IsEmpty());
}

TEST(GridChoice, WhatIsNotThere) {
    const auto message = [](const std::vector<GridLabel>& labels, const std::string& wanted) -> std::string {
        try {
            choose(labels, wanted);
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_THAT(message(named({"density", "density"}), "density[2]"),
                AllOf(HasSubstr("2 grids of the name \"density\""), HasSubstr("density[1]")));
    EXPECT_THAT(message(named({"density"}), "smoke[0]"), HasSubstr("no grid \"smoke[0]\""));
    EXPECT_THAT(message(named({"density"}), "[]"), HasSubstr("no grid"));
    std::vector<std::string> many(300, "g");
    EXPECT_THAT(message(named(many), "smoke"), HasSubstr("and 292 more"));
    EXPECT_THAT(message({{"v", "vec3s"}, {"surface", "float", true, true}}, ""),
                HasSubstr("\"surface\" is a level set"));
    EXPECT_THAT(message({{"v", "vec3s"}}, ""), HasSubstr("no float grid, but \"v\" (vec3s)"));
}

using GridChoiceFiles = GridFiles;

TEST_F(GridChoiceFiles, DoublesAreRead) {
    const auto grid = openvdb::DoubleGrid::create();
    grid->setName("density");
    grid->tree().setValue({1, 2, 3}, 0.1);
    grid->fill(openvdb::CoordBBox({8, 8, 8}, {15, 15, 15}), 2.5);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(4.0));
    const auto loaded = vdb::load(save({grid}), {});
    EXPECT_THAT(loaded.warnings, IsEmpty());
    EXPECT_EQ(loaded.volume.size, glm::ivec3(17, 16, 15));
    EXPECT_EQ(loaded.volume.maximum, 2.5F);
    EXPECT_NEAR(mass(loaded.volume), 64.0 * (512 * 2.5 + 0.1), 1e-5);
    EXPECT_EQ(vdb::describe(file()).at(0).type, "double");
}

TEST_F(GridChoiceFiles, TheSecondOfTwo) {
    const auto first = makeBlob({0, 0, 0});
    const auto second = makeGrid();
    second->tree().setValue({80, 0, 0}, 3.0F);
    vdb::LoadOptions options;
    options.grid = "density[1]";
    EXPECT_EQ(vdb::load(save({first, second}), options).volume.maximum, 3.0F);
    EXPECT_EQ(vdb::load(file(), {}).volume.maximum, 0.5F);
}

TEST_F(GridChoiceFiles, AGridOfZerosIsEmpty) {
    const auto zeros = makeGrid();
    zeros->fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(20)), 0.0F, true);
    const auto smoke = makeBlob({0, 0, 0});
    smoke->setName("smoke");
    EXPECT_EQ(vdb::load(save({zeros, smoke}), {}).volume.name, "smoke");
    const auto infos = vdb::describe(file());
    EXPECT_FALSE(infos[0].taken);
    EXPECT_TRUE(infos[1].taken);
}

}  // namespace
}  // namespace lumulus::test
