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
    )");
    Field expected{FieldKind::cirrus, "high", 0.5,          8000, {1, 2, 3}, {4000, 0, 5000}, 300, 900, 2.5, 3, 64, 9,
                   {10, 0, -5},       0.01,   {1, 0.9, 0.8}};
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
    EXPECT_THAT(messageOf("[[field]]\nname = \"a b\""), HasSubstr("cannot be the name of a field"));
    EXPECT_THAT(messageOf("[[field]]\nname = \"a\"\n[[field]]\nname = \"a\""), HasSubstr("another field"));
    EXPECT_THAT(messageOf("[[field]]\nname = \"a\"\n[[cloud]]\nname = \"a\""), HasSubstr("another cloud"));
}

}  // namespace
}  // namespace lumulus::scene
