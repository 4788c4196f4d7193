#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/load.h"
#include "support/temporary_folder.h"

// Scenes of several clouds.
namespace lumulus::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using Overrides = std::vector<std::string>;

const std::string two = "[[cloud]]\nextinction = 1\n[[cloud]]\nname = \"veil\"\nextinction = 2\n";

Scene parse(const std::string& toml, const Overrides& overrides = {}) {
    return parseScene(toml, "x.toml", overrides);
}

std::string messageOf(const std::string& toml, const Overrides& overrides = {}) {
    try {
        parse(toml, overrides);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
}

TEST(SceneClouds, EachHasItsOwnKeys) {
    const Scene scene = parse(two + "phase = { model = \"droplet\", droplet_diameter = 9 }\n");
    ASSERT_EQ(scene.clouds.size(), 2U);
    EXPECT_EQ(scene.clouds[0].extinction, 1.0);
    EXPECT_EQ(scene.clouds[1].extinction, 2.0);
    EXPECT_EQ(scene.clouds[0].phase.model, PhaseModel::henyeyGreenstein);
    EXPECT_EQ(scene.clouds[1].phase.dropletDiameter, 9.0);
    EXPECT_EQ(nameOf(scene, 0), "0");
    EXPECT_EQ(nameOf(scene, 1), "veil");
    EXPECT_NE(scene, parse(two, {"cloud.1.name=other"}));
}

TEST(SceneClouds, FilesAreRelativeToTheSceneForEach) {
    const test::TemporaryFolder folder;
    test::writeAll(folder / "a.vdb", "not read here");
    test::writeAll(folder / "b.vdb", "not read here");
    test::writeAll(folder / "x.toml", "[[cloud]]\nvdb = \"a.vdb\"\n[[cloud]]\nvdb = \"b.vdb\"\n");
    const Scene scene = loadScene(folder / "x.toml");
    EXPECT_EQ(scene.clouds.at(0).vdb, folder / "a.vdb");
    EXPECT_EQ(scene.clouds.at(1).vdb, folder / "b.vdb");
}

TEST(SceneClouds, OverridesByIndexAndByName) {
    EXPECT_EQ(parse(two, {"cloud.1.extinction=3"}).clouds.at(1).extinction, 3.0);
    EXPECT_EQ(parse(two, {"cloud.veil.extinction=4"}).clouds.at(1).extinction, 4.0);
    EXPECT_EQ(parse(two, {"cloud.veil.phase.g=0.5"}).clouds.at(1).phase.g, 0.5);
    EXPECT_EQ(parse(two, {"cloud.0.name=base", "cloud.base.extinction=5"}).clouds.at(0).extinction, 5.0);
    EXPECT_EQ(parse(two, {"cloud.1.name=base", "cloud.base.extinction=5"}).clouds.at(1).extinction, 5.0);
    EXPECT_EQ(parse(two, {"cloud.2.extinction=6"}).clouds.size(), 3U);
    EXPECT_EQ(parse("", {"cloud.1.procedural=slab"}).clouds.size(), 2U);
    EXPECT_THAT(messageOf(two, {"cloud.3.extinction=6"}), HasSubstr("there is no cloud.2 (--set cloud.3.extinction)"));
    EXPECT_THAT(messageOf(two, {"cloud.fog.extinction=6"}), HasSubstr("or the name of one, got \"fog\""));
    EXPECT_THAT(messageOf(two, {"cloud.veil.albedo=2"}), HasSubstr("(--set cloud.1.albedo)"));
    EXPECT_THAT(messageOf(two, {"cloud.extinction=1"}), HasSubstr("write cloud.0.extinction"));
}

TEST(SceneClouds, MessagesNameTheCloud) {
    EXPECT_THAT(messageOf(two + "albedo = 1.5"), HasSubstr("(x.toml:6, cloud.1.albedo)"));
    EXPECT_THAT(messageOf(two + "vdb = \"no.vdb\""), HasSubstr("does not exist (x.toml:6, cloud.1.vdb)"));
    EXPECT_THAT(messageOf(two + "phase = { model = \"hazy\", g = 0.5 }"),
                StartsWith("cloud.1.phase.g has no effect: the phase function is hazy (x.toml:6, cloud.1.phase.g)"));
    EXPECT_THAT(messageOf(two + "vdb = \"no.vdb\"\nprocedural = \"slab\""),
                HasSubstr("cloud.1.vdb and cloud.1.procedural exclude each other"));
}

TEST(SceneClouds, NamesAreUniqueAndLookLikeNames) {
    EXPECT_EQ(messageOf(two + "[[cloud]]\nname = \"veil\"\n"),
              "cloud.1 has the name \"veil\" already (x.toml:7, cloud.2.name): give every cloud a name of its own");
    for (const char* name : {"", "0", "7veils", "a.b", "a b", "extinction", "phase", "ö"}) {
        EXPECT_THAT(messageOf("[[cloud]]\nname = \"" + std::string(name) + "\""),
                    AllOf(HasSubstr("cannot be the name of a cloud (x.toml:2, cloud.0.name)"), HasSubstr("a letter")))
            << name;
    }
    EXPECT_EQ(messageOf("[[cloud]]\nname = \"" + std::string(64, 'a') + "\""), "no error");
    EXPECT_THAT(messageOf("[[cloud]]\nname = \"" + std::string(65, 'a') + "\""), HasSubstr("cannot be the name"));
}

TEST(SceneClouds, TheirNumberHasALimit) {
    EXPECT_EQ(parse(repeated("[[cloud]]\n", 256)).clouds.size(), 256U);
    EXPECT_THAT(messageOf(repeated("[[cloud]]\n", 300)),
                HasSubstr("a scene has at most 256 clouds, this one has 300 (x.toml:257, cloud.256)"));
    EXPECT_THAT(messageOf("", {"cloud.256.extinction=1"}),
                HasSubstr("there is no cloud.256: a scene has at most 256 clouds (--set cloud.256.extinction)"));
}

}  // namespace
}  // namespace lumulus::scene
