#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/load.h"
#include "support/temporary_folder.h"

namespace lumulus::scene {
namespace {

using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Overrides = std::vector<std::string>;

Scene parse(const std::string& toml, const Overrides& overrides = {}) {
    return parseScene(toml, "x.toml", overrides);
}

/// The one line that a person would see.
std::string messageOf(const std::string& toml, const Overrides& overrides = {}) {
    try {
        parse(toml, overrides);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-12);
}

TEST(SceneFile, APipeByTheNameOfACloudIsNotWaitedFor) {
    const TemporaryFolder folder;
    const std::filesystem::path pipe = folder / "cloud.vdb";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(loadScene(pipe, Overrides{}, std::nullopt).clouds.at(0).vdb, pipe);
}

TEST(SceneFile, EmptyIsTheProceduralCumulus) {
    const Scene scene = parse("");
    EXPECT_EQ(scene.image.width, 1280);
    EXPECT_EQ(scene.image.height, 720);
    ASSERT_EQ(scene.clouds.size(), 1U);
    EXPECT_EQ(scene.clouds[0].procedural, "cumulus");
    EXPECT_TRUE(scene.clouds[0].vdb.empty());
    EXPECT_FALSE(scene.camera.position.has_value());
    EXPECT_FALSE(scene.camera.target.has_value());
    EXPECT_FALSE(scene.preparation.influenceRadius.has_value());
    EXPECT_GT(scene.sun.irradiance.x, 0.0);
    EXPECT_NEAR(glm::length(scene.sun.directionTo), 1.0, 1e-12);
    EXPECT_EQ(scene.source, "x.toml");
}

TEST(SceneFile, ASceneThatNamesNoSkyHasAnAtmosphere) {
    for (const char* toml : {"", "[sun]\nelevation = 10\n", "[[cloud]]\nprocedural = \"stratus\"\n"}) {
        const Scene scene = parse(toml);
        EXPECT_EQ(scene.sky.model, SkyModel::atmosphere) << toml;
        EXPECT_TRUE(scene.sky.groundBelowClouds) << toml;
        EXPECT_EQ(scene.sun.irradiance, glm::dvec3(210.45, 189.23, 185.23)) << toml;
        EXPECT_EQ(scene.image.exposureMode, ExposureMode::automatic) << toml;
    }
    EXPECT_FALSE(parse("[ground]\nheight = -20\n").sky.groundBelowClouds);
    EXPECT_FALSE(parse("[sky]\nmodel = \"atmosphere\"\n").sky.groundBelowClouds);
}

TEST(SceneFile, ASceneThatGivesARadianceHasAConstantSky) {
    for (const Scene& scene : {parse("[sky]\nradiance = 0.5\n"), parse("", {"sky.radiance=0.5"}),
                               parse("cloud = []\n[[fog.media]]\nscattering = 0.001\nbottom = 0\ntop = 100\n")}) {
        EXPECT_EQ(scene.sky.model, SkyModel::constant);
        EXPECT_EQ(scene.sun.irradiance, glm::dvec3(5.0, 4.8, 4.4));
        EXPECT_EQ(scene.image.exposureMode, ExposureMode::stops);
    }
    const Scene hazy = parse("[[fog.media]]\nscattering = 0.001\ntop = 100\n");
    EXPECT_EQ(hazy.sky.model, SkyModel::atmosphere);
    EXPECT_TRUE(hazy.sky.groundBelowClouds);
    const Scene blue = parse("[sky]\nmodel = \"constant\"\n");
    EXPECT_EQ(blue.sky.radiance, glm::dvec3(0.12, 0.22, 0.42));
}

constexpr const char* everyKey = R"(
        image = { width = 640, height = 480, exposure = -1.5 }
        [camera]
        position = [1, 2, 3.5]
        target = [4, 5, 6]
        up = [0, 0, 1]
        vertical_fov = 30
        projection = "panorama"
        [sun]
        direction_to = [0, 0, 5]
        irradiance = 2
        angular_diameter = 1
        [sky]
        model = "constant"
        radiance = [0.1, 0.2, 0.3]
        [[cloud]]
        procedural = "sphere"
        grid = "density"
        clamp = true
        resolution = 32
        seed = 9
        transform = [[0, -2, 0, 10], [2, 0, 0, 20], [0, 0, 2, 30]]
        density_scale = 2
        extinction = 0.25
        albedo = [0.9, 0.8, 0.7]
        phase = { model = "droplet", droplet_diameter = 12 }
        [preparation]
        samples = 1e3
        density_threshold = 0.2
        influence_radius = 5
        max_leaves = 64
        memory_budget = 100
        [photon_map]
        photons = 12
        generations = 3
        first_generation = 4
        bands = 2
        forward_cut = 12
        majorant = "local"
        memory_budget = 50.5
        seed = 9007199254740991
        [draw]
        mode = "march"
    )";

TEST(SceneFile, EveryKeyArrives) {
    Scene expected;
    expected.image = {640, 480, -1.5};
    expected.camera = {glm::dvec3(1, 2, 3.5), glm::dvec3(4, 5, 6), {0, 0, 1}, 30.0, Projection::panorama};
    expected.sun = {{0, 0, 1}, {2, 2, 2}, 1.0};
    expected.sky.radiance = {0.1, 0.2, 0.3};
    Cloud cloud;
    cloud.procedural = "sphere";
    cloud.grid = "density";
    cloud.clamp = true;
    cloud.resolution = 32;
    cloud.seed = 9;
    cloud.transform = glm::dmat4{{0, 2, 0, 0}, {-2, 0, 0, 0}, {0, 0, 2, 0}, {10, 20, 30, 1}};
    cloud.densityScale = 2.0;
    cloud.extinction = 0.25;
    cloud.albedo = {0.9, 0.8, 0.7};
    cloud.phase.model = PhaseModel::droplet;
    cloud.phase.dropletDiameter = 12.0;
    expected.clouds = {cloud};
    expected.preparation = {1000, 0.2, 5.0, 64, 100.0};
    expected.photonMap = {12, 3, 4, 2, 12.0, Majorant::local, 50.5, 9007199254740991ULL, false, false, 0, true, true};
    expected.draw = {DrawMode::march};
    expected.source = "x.toml";
    EXPECT_EQ(parse(everyKey), expected);
}

TEST(SceneFile, SunByAngles) {
    const auto direction = [](const std::string& keys) { return parse("[sun]\n" + keys).sun.directionTo; };
    expectNear(direction("azimuth = 0\nelevation = 0"), {0, 0, -1});
    expectNear(direction("azimuth = 90\nelevation = 0"), {1, 0, 0});
    expectNear(direction("azimuth = 17\nelevation = 90"), {0, 1, 0});
    expectNear(direction("elevation = 35"), parse("").sun.directionTo);
    expectNear(direction("direction_to = [0, -3, 4]"), {0, -0.6, 0.8});
}

TEST(SceneFile, NoCloud) {
    EXPECT_TRUE(parse("cloud = []").clouds.empty());
    EXPECT_EQ(parse("[[cloud]]").clouds.size(), 1U);
    EXPECT_EQ(parse("cloud = []", {"cloud.0.extinction=1"}).clouds.size(), 1U);
    EXPECT_TRUE(parse("[[cloud]]\nextinction = 3", {"cloud=[]"}).clouds.empty());
}

TEST(SceneFile, MessagesNameKeyLineAndMend) {
    EXPECT_EQ(messageOf("\n[[cloud]]\n\nalbedo = 1.2\n"),
              "albedo must lie in 0…1, got 1.2 (x.toml:4, cloud.0.albedo): give such a value, or leave it out for 1.0");
    EXPECT_EQ(messageOf("[image]\nwidht = 3"),
              "unknown key \"widht\" (x.toml:2, image.widht): did you mean \"width\"?");
    EXPECT_EQ(messageOf("[imag]\nwidth = 3"), "unknown key \"imag\" (x.toml:1, imag): did you mean \"image\"?");
    EXPECT_THAT(messageOf("[[cloud]]\nphase.g = 1.0"), HasSubstr("g must be above -1, below 1, got 1 (x.toml:2"));
    EXPECT_THAT(messageOf("[[cloud]]\nphase = { model = \"mist\" }"), HasSubstr("cloud.0.phase.model"));
    EXPECT_THAT(messageOf("[image]\nwidth = 1.5"), HasSubstr("width must be a whole number, got 1.5"));
    EXPECT_THAT(messageOf("[image]\nwidth = 1\n\nwidth = 2"), HasSubstr("(x.toml:4)"));
    EXPECT_THAT(messageOf("image = 3"), HasSubstr("image must be a table, got an integer (x.toml:1, image)"));
}

TEST(SceneFile, CloudShapes) {
    EXPECT_THAT(messageOf("[cloud]\nextinction = 1"), HasSubstr("write [[cloud]] with two brackets"));
    EXPECT_THAT(messageOf("cloud = [3]"), HasSubstr("cloud must be a table"));
    EXPECT_THAT(messageOf("[[cloud]]\n[[cloud.phase]]\ng = 0"), HasSubstr("phase must be a table"));
}

TEST(SceneFile, KeysThatContradict) {
    EXPECT_THAT(messageOf("[sun]\ndirection_to = [0, 1, 0]\nazimuth = 3"), HasSubstr("exclude each other (x.toml:3"));
    EXPECT_THAT(messageOf("[sun]\ndirection_to = [0, 0, 0]"), HasSubstr("direction_to must have a length (x.toml:2"));
    EXPECT_THAT(messageOf("[camera]\nposition = [1, 2, 3]\ntarget = [1, 2, 3]"),
                HasSubstr("(x.toml:3, camera.target)"));
    EXPECT_THAT(messageOf("[camera]\nposition = [0, 0, 0]\ntarget = [0, -5, 0]"), HasSubstr("parallel to the view"));
    EXPECT_THAT(messageOf("[camera]\nup = [0, 0, 0]"), HasSubstr("up must have a length (x.toml:2"));
    EXPECT_THAT(messageOf("[image]\nwidth = 16384\nheight = 16384"), HasSubstr("pixels, more than 33554432 (x.toml:2"));
    EXPECT_EQ(messageOf("[image]\nwidth = 7680\nheight = 4320"), "no error");
}

TEST(SceneFile, TransformMustBeAnInvertibleAffineMatrix) {
    const auto transform = [](const std::string& rows) { return messageOf("[[cloud]]\ntransform = " + rows); };
    EXPECT_EQ(transform("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"), "no error");
    EXPECT_EQ(transform("[[1e-6,0,0,1e7],[0,1e-6,0,0],[0,0,1e-6,0]]"), "no error");
    EXPECT_THAT(transform("[[1,0,0,0],[1,0,0,0],[0,0,1,0]]"), HasSubstr("must be invertible (x.toml:2"));
    EXPECT_THAT(transform("[[0,0,0,0],[0,0,0,0],[0,0,0,0]]"), HasSubstr("must be invertible"));
    EXPECT_THAT(transform("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[1,0,0,1]]"), HasSubstr("last row"));
    EXPECT_THAT(transform("[[1,0,0],[0,1,0],[0,0,1]]"), HasSubstr("rows of four numbers"));
}

TEST(SceneFile, PathsAreRelativeToTheSceneFile) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "scenes");
    test::writeAll(folder / "cloud.vdb", "not read here");
    test::writeAll(folder / "scenes/a.toml", "[[cloud]]\nvdb = \"../cloud.vdb\"\n");
    EXPECT_EQ(loadScene(folder / "scenes/a.toml").clouds.at(0).vdb, folder / "cloud.vdb");
    const std::string absolute = (folder / "cloud.vdb").string();
    EXPECT_EQ(parse("[[cloud]]\nvdb = \"" + absolute + "\"").clouds.at(0).vdb, absolute);
}

TEST(SceneFile, MissingFiles) {
    const TemporaryFolder folder;
    EXPECT_THAT(messageOf("[[cloud]]\nvdb = \"no.vdb\""), HasSubstr("no.vdb does not exist (x.toml:2, cloud.0.vdb)"));
    EXPECT_THAT(messageOf("[[cloud]]\nvdb = \"/\""), HasSubstr("is a folder (x.toml:2, cloud.0.vdb)"));
    EXPECT_THAT(messageOf("[[cloud]]\nvdb = \"\""), HasSubstr("x.toml:2, cloud.0.vdb"));
    EXPECT_THROW(loadScene(folder / "missing.toml"), InputError);
    EXPECT_THROW(loadScene(folder.path()), InputError);
}

TEST(SceneFile, ParametersThatThePhaseFunctionDoesNotHave) {
    const std::string fog = "[[cloud]]\nphase = { model = \"droplet\", droplet_diameter = 9 }";
    const std::string ice = "[[cloud]]\nphase = { model = \"schlick\", g = 0.5 }";
    EXPECT_THAT(messageOf("[[cloud]]\nphase = { model = \"droplet\", g = 0.5 }"),
                StartsWith("cloud.0.phase.g has no effect: the phase function is droplet (x.toml:2, cloud.0.phase.g)"));
    EXPECT_THAT(messageOf("[[cloud]]\nphase.model = \"hazy\"\nphase.g = 0.5"), HasSubstr("the phase function is hazy"));
    EXPECT_THAT(messageOf("[[cloud]]\nphase.droplet_diameter = 9"),
                HasSubstr("cloud.0.phase.droplet_diameter has no effect: the phase function is henyey-greenstein"));
    EXPECT_THAT(messageOf(fog, {"cloud.0.phase.g=0.5"}), HasSubstr("(--set cloud.0.phase.g)"));
    EXPECT_EQ(parse(fog, {"cloud.0.phase.model=hg", "cloud.0.phase.g=0.5"}).clouds.at(0).phase.g, 0.5);
    EXPECT_EQ(parse(ice, {"cloud.0.phase.model=rayleigh"}).clouds.at(0).phase.model, PhaseModel::rayleigh);
}

TEST(Overrides, ReplaceTheFile) {
    const Scene scene = parse("[photon_map]\nbands = 2\n[draw]\nmode = \"march\"",
                              {"photon_map.bands=3", "photon_map.bands=4", "draw.mode=billboards",
                               "cloud.0.phase.g = 0.5", "camera.position=[1, 2, 3]", "cloud.0.albedo=0.5"});
    EXPECT_EQ(scene.photonMap.bands, 4);
    EXPECT_EQ(scene.draw.mode, DrawMode::billboards);
    EXPECT_EQ(scene.clouds.at(0).phase.g, 0.5);
    EXPECT_EQ(scene.clouds.at(0).albedo, glm::dvec3(0.5));
    EXPECT_EQ(scene.camera.position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(parse("", {"image={width = 5, height = 6}"}).image.width, 5);
}

TEST(Overrides, TakeTheOtherAlternativeOut) {
    const std::string file = "[sun]\ndirection_to = [0, 1, 0]\n[[cloud]]\nvdb = \"missing.vdb\"";
    const Scene scene = parse(file, {"sun.elevation=0", "sun.azimuth=90", "cloud.0.procedural=slab"});
    expectNear(scene.sun.directionTo, {1, 0, 0});
    EXPECT_TRUE(scene.clouds.at(0).vdb.empty());
    EXPECT_THAT(messageOf("", {"sun.azimuth=3", "sun.direction_to=[0,1,0]"}), HasSubstr("exclude each other"));
}

TEST(Overrides, Messages) {
    EXPECT_THAT(messageOf("", {"cloud.0.albedo=1.2"}), HasSubstr("got 1.2 (--set cloud.0.albedo)"));
    EXPECT_THAT(messageOf("", {"cloud.extinction=1"}), HasSubstr("write cloud.0.extinction"));
    EXPECT_THAT(messageOf("", {"cloud.0=1"}), HasSubstr("(--set cloud.0)"));
    EXPECT_THAT(messageOf("", {"image.widht=3"}), HasSubstr("did you mean image.width?"));
    EXPECT_THAT(messageOf("", {"nosection.x=1"}),
                AllOf(HasSubstr("unknown section \"nosection\""), HasSubstr("the sections are camera, cloud")));
    EXPECT_THAT(messageOf("", {"imag.width=1"}), HasSubstr("did you mean image.width?"));
    EXPECT_THAT(messageOf("", {"image.width.x=1"}), HasSubstr("write image.width alone"));
    for (const char* index : {"x", "00", "-1", "+0", "", "0x0"}) {
        EXPECT_THAT(messageOf("", {"cloud." + std::string(index) + ".extinction=1"}),
                    AllOf(HasSubstr("must be a plain number or the name of one, got \"" + std::string(index) + "\""),
                          HasSubstr("write cloud.0.extinction")));
    }
    for (const char* text : {"", "=", "image.width", "=3"}) {
        EXPECT_THAT(messageOf("", {text}), HasSubstr("write section.key=value")) << text;
    }
    EXPECT_THAT(messageOf("", {"image.width=1\nimage.height=2"}), HasSubstr("width must be a whole number"));
    EXPECT_THAT(messageOf("", {"camera.target=[1, 2"}), HasSubstr("got a string"));
}

/// The advice for an override is a path that makes a scene with the same value.
TEST(Overrides, AdviceWorks) {
    const auto adviceFor = [](const std::string& toml, const std::string& override) {
        const std::string message = messageOf(toml, {override}), start = "did you mean ";
        const std::size_t at = message.find(start);
        if (at == std::string::npos) return std::string();
        const std::string advice = message.substr(at + start.size(), message.rfind('?') - at - start.size());
        const std::string first = advice.substr(0, advice.find(' '));
        EXPECT_NO_THROW(parseScene(toml, "x.toml", Overrides{first + override.substr(override.find('='))})) << advice;
        return advice;
    };
    EXPECT_EQ(adviceFor("", "extinction=1"), "cloud.0.extinction");
    EXPECT_EQ(adviceFor("", "extintion=1"), "cloud.0.extinction");
    EXPECT_EQ(adviceFor("", "phase.g=0.5"), "cloud.0.phase.g");
    EXPECT_EQ(adviceFor("", "width=64"), "image.width");
    EXPECT_EQ(adviceFor("", "clod.0.albedo=1"), "cloud.0.albedo");
    EXPECT_EQ(adviceFor("[[cloud]]\n[[cloud]]\n", "cloud.1.albdeo=1"), "cloud.1.albedo");
    EXPECT_EQ(adviceFor("", "seed=7"), "cloud.0.seed or photon_map.seed");
    EXPECT_EQ(adviceFor("", "visibility=1000"), "fog.media.0.visibility");
    // no key takes this value, so none is advised; and nobody is sent to a key that does not exist
    EXPECT_EQ(adviceFor("", "width=-1"), "");
    EXPECT_THAT(messageOf("", {"cloud.veil.nonsense=1"}), Not(HasSubstr("write")));
    EXPECT_THAT(messageOf("", {"cloud.phase.nonsense=1"}), Not(HasSubstr("write")));
}

TEST(SceneFile, AFileOfCloudsStandsForASceneOfIt) {
    const TemporaryFolder folder;
    const std::string openVdb(" BDV\0\0\0\0 and more", 17);
    for (const char* name : {"a.vdb", "no suffix", "quote\" and \\ back.nvdb"}) {
        test::writeAll(folder / name, openVdb);
        const Scene scene = loadScene(folder / name, Overrides{"cloud.0.extinction=3"});
        ASSERT_EQ(scene.clouds.size(), 1U);
        EXPECT_EQ(scene.clouds[0].vdb, folder / name);
        EXPECT_EQ(scene.clouds[0].extinction, 3.0);
        EXPECT_EQ(scene.image.width, 1280);
        EXPECT_EQ(scene.source, (folder / name).string());
    }
    for (const char* content : {"\x1f\x8b", ""}) {  // the loader says what is wrong
        test::writeAll(folder / "wrong.VDB", content);
        EXPECT_EQ(loadScene(folder / "wrong.VDB").clouds[0].vdb, folder / "wrong.VDB");
    }
}

TEST(SceneFile, OtherKindsOfFilesAreNamed) {
    const TemporaryFolder folder;
    const auto message = [&](const std::string& text) -> std::string {
        test::writeAll(folder / "a.toml", text);
        try {
            readSceneText(folder / "a.toml");
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_THAT(message(std::string(" BDV\0\0\0\0", 8)), HasSubstr("an OpenVDB file, not a scene"));
    EXPECT_THAT(message("\x1f\x8b" + std::string(1 << 21, 'x')), HasSubstr("a gzip archive, not a scene"));
    EXPECT_THAT(message(std::string(1 << 21, 'x')), HasSubstr("larger than 1 MiB"));
}

TEST(Quality, PresetsStandBelowTheFile) {
    const auto map = [](const std::string& toml, Quality quality, const Overrides& overrides = {}) {
        return parseScene(toml, "x.toml", overrides, quality).photonMap;
    };
    EXPECT_EQ(map("", Quality::draft).photons, 200000);
    EXPECT_EQ(map("", Quality::draft).bands, 3);
    EXPECT_EQ(map("", Quality::interactive).generations, 20);
    EXPECT_EQ(map("", Quality::final).photons, 24000000);
    EXPECT_EQ(map("", Quality::final).forwardCut, 10.0);
    EXPECT_EQ(map("[photon_map]\nforward_cut = 3", Quality::final).forwardCut, 3.0);
    const PhotonMap mixed = map("[photon_map]\nbands = 7", Quality::draft, {"photon_map.photons=5"});
    EXPECT_EQ(mixed.bands, 7);
    EXPECT_EQ(mixed.photons, 5);
    EXPECT_EQ(mixed.generations, 10);
}

}  // namespace
}  // namespace lumulus::scene
