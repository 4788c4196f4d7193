#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/load.h"

namespace lumulus::scene {
namespace {

using testing::HasSubstr;

Scene parse(const std::string& toml, const std::vector<std::string>& overrides = {}) {
    return parseScene(toml, "x.toml", overrides);
}

std::string messageOf(const std::string& toml, const std::vector<std::string>& overrides = {}) {
    try {
        parse(toml, overrides);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}

TEST(SceneField, EveryKeyArrives) {
    const Scene scene = parse(R"(
        [[field]]
        kind = "cirrus"
        name = "high"
        cover = 0.5
        base = 8000
        center = [1, 2, 3]
        area = [4000, 0, 5000]
        smallest = 300
        largest = 900
        exponent = 2.5
        variants = 3
        resolution = 64
        seed = 9
        wind = [10, 0, -5]
        extinction = 0.01
        albedo = [1, 0.9, 0.8]
        phase = { model = "mie", effective_radius = 7.0, effective_variance = 0.03 }
    )");
    Field expected{
        FieldKind::cirrus,     "high", 0.5,           8000, {1, 2, 3}, {4000, 0, 5000}, 300, 900, 2.5, 3, 64, 9,
        glm::dvec3(10, 0, -5), 0.01,   {1, 0.9, 0.8}, {}};
    expected.phase.model = PhaseModel::mie;
    expected.phase.effectiveRadius = 7.0;
    expected.phase.effectiveVariance = 0.03;
    ASSERT_EQ(scene.fields.size(), 1U);
    EXPECT_EQ(scene.fields[0], expected);
}

TEST(SceneField, TakesThePlaceOfTheDefaultCloud) {
    EXPECT_TRUE(parse("[[field]]\n").clouds.empty());
    EXPECT_EQ(parse("[[field]]\n[[cloud]]\n").clouds.size(), 1U);
    EXPECT_EQ(parse("").clouds.size(), 1U);
    EXPECT_TRUE(parse("").fields.empty());
    const Scene added = parse("", {"field.0.cover=0.7"});
    EXPECT_TRUE(added.clouds.empty());
    EXPECT_EQ(added.fields.at(0).cover, 0.7);
}

TEST(SceneField, RefusesWhatDoesNotFitTogether) {
    EXPECT_THAT(messageOf("[[field]]\ncover = 1.01"), HasSubstr("x.toml:2, field.0.cover"));
    EXPECT_THAT(messageOf("[[field]]\narea = [0, 0, 100]"), HasSubstr("above 0 and at most 2e+07 m along x and z"));
    EXPECT_THAT(messageOf("[[field]]\narea = [100, 0, 1e8]"), HasSubstr("x.toml:2, field.0.area"));
    EXPECT_THAT(messageOf("[[field]]\nsmallest = 3000"), HasSubstr("3000 m, is above the largest, 2000 m"));
    const std::string deck = "[[field]]\nkind = \"stratocumulus\"\nexponent = 2\n";
    EXPECT_THAT(messageOf(deck), HasSubstr("exponent has no effect"));
    EXPECT_EQ(messageOf("[[field]]\nexponent = 2\n", {"field.0.kind=stratocumulus"}), "no error");
    EXPECT_THAT(messageOf("[[field]]\nphase = { effective_radius = 7 }"),
                HasSubstr("field.0.phase.effective_radius has no effect"));
    EXPECT_THAT(messageOf("[[field]]\nname = \"a b\""), HasSubstr("cannot be the name of a field"));
    EXPECT_THAT(messageOf("[[field]]\nname = \"a\"\n[[field]]\nname = \"a\""), HasSubstr("another field"));
    EXPECT_THAT(messageOf("[[field]]\nname = \"a\"\n[[cloud]]\nname = \"a\""), HasSubstr("another cloud"));
}

TEST(SceneField, WindByHeight) {
    const Wind wind = parse("[[field]]\nwind = [[500, 4, 0, -2], [1500.0, 10, 1, -2]]\n").fields.at(0).wind;
    ASSERT_EQ(wind.levels.size(), 2U);
    for (const auto& [height, wanted] : {std::pair{-1e5, glm::dvec3(4, 0, -2)},
                                         {500.0, glm::dvec3(4, 0, -2)},
                                         {750.0, glm::dvec3(5.5, 0.25, -2)},
                                         {1500.0, glm::dvec3(10, 1, -2)},
                                         {9e9, glm::dvec3(10, 1, -2)}})
        EXPECT_LT(glm::distance(wind.at(height), wanted), 1e-12) << height;
    const Wind constant = parse("[[field]]\nwind = [3, 0, 1]").fields.at(0).wind;
    EXPECT_EQ(constant, Wind(glm::dvec3(3, 0, 1)));
    EXPECT_EQ(constant.at(1e4), glm::dvec3(3, 0, 1));
    EXPECT_EQ(Wind().at(0.0), glm::dvec3(0.0));
    EXPECT_EQ(parse("[[field]]", {"field.0.wind=[[0, 1, 2, 3]]"}).fields.at(0).wind.at(50.0), glm::dvec3(1, 2, 3));
    EXPECT_EQ(parse("[[cloud]]\nvelocity = [[0, 0, 0, 0], [10, 20, 0, 0]]").clouds.at(0).velocity->at(5.0).x, 10.0);
}

TEST(SceneField, WindsThatAreNone) {
    std::string many = "[[0, 0, 0, 0]";
    for (std::size_t i = 1; i <= Wind::mostLevels; ++i) many += ", [" + std::to_string(i) + ", 0, 0, 0]";
    for (const auto& [value, says] : {std::pair<std::string, const char*>{"[[500, 1, 0, 0], [500, 2, 0, 0]]", "rise"},
                                      {"[[500, 1, 0, 0], [200, 2, 0, 0]]", "got 200 behind 500 in row 2"},
                                      {"[[0, 1, 0, 0], [200, 2, 0]]", "an array of 3 as row 2"},
                                      {"[[0, 1, 0, 0], 5]", "an integer as row 2"},
                                      {"[[0, 1, 0, 0, 0]]", "an array of 5 as row 1"},
                                      {"[[nan, 1, 0, 0]]", "wind must lie in"},
                                      {"[[0, 1, inf, 0]]", "wind must lie in"},
                                      {"[[0, \"x\", 0, 0]]", "got a string"},
                                      {"[0, 1, 0, 0]", "an array of 4"},
                                      {"[0, [1, 0, 0, 0], 0]", "got an array"},
                                      {"[]", "wind must be [x, y, z], or rows of [height, x, y, z]"},
                                      {many + "]", "has 1001 rows, more than 1000"}})
        EXPECT_THAT(messageOf("[[field]]\nwind = " + value),
                    testing::AllOf(HasSubstr(says), HasSubstr("x.toml:2, field.0.wind")))
            << value.substr(0, 60);
    EXPECT_THAT(messageOf("[[field]]\n[animate]\n\"field.0.wind\" = [[0, [0, 0, 0]], [9, [5, 0, 0]]]"),
                testing::AllOf(HasSubstr("cannot change from frame to frame"), HasSubstr("x.toml:3")));
}

}  // namespace
}  // namespace lumulus::scene
