// Which channels of an EXR file are the colours and the depth, by the names that renderers and compositors give them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "cli/exr_layers.h"

namespace lumulus::cli {
namespace {

using testing::ElementsAre;

ExrPart part(std::vector<std::string> channels, std::string name = {}) {
    ExrPart result;
    result.name = std::move(name);
    result.channels = std::move(channels);
    return result;
}

/// What Blender writes.
const std::vector<ExrPart> viewLayer{
    part({"ViewLayer.Combined.A", "ViewLayer.Combined.B", "ViewLayer.Combined.G", "ViewLayer.Combined.R",
          "ViewLayer.Depth.Z", "ViewLayer.DiffDir.B", "ViewLayer.DiffDir.G", "ViewLayer.DiffDir.R", "ViewLayer.Mist.Z",
          "ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"})};

TEST(ExrLayers, PlainNamesComeFirst) {
    const std::vector<ExrPart> parts{part({"A", "B", "G", "R", "beauty.B", "beauty.G", "beauty.R", "depth.Z", "Z"})};
    const ColourChannels colour = findColour(parts, "", "a.exr");
    EXPECT_THAT(colour.names, ElementsAre("R", "G", "B"));
    EXPECT_EQ(colour.alpha, "A");
    EXPECT_EQ(findDepth(parts, colour.layer, "a.exr").name, "Z");
    EXPECT_THAT(findColour(parts, "beauty", "a.exr").names, ElementsAre("beauty.R", "beauty.G", "beauty.B"));
    EXPECT_FALSE(findColour(parts, "beauty", "a.exr").alpha);
}

TEST(ExrLayers, EndsOfNames) {
    for (const char* wanted : {"", "Combined", "ViewLayer", "ViewLayer.Combined"}) {
        const ColourChannels colour = findColour(viewLayer, wanted, "a.exr");
        EXPECT_EQ(colour.names[0], "ViewLayer.Combined.R") << wanted;
        EXPECT_EQ(colour.alpha, "ViewLayer.Combined.A");
        EXPECT_EQ(findDepth(viewLayer, colour.layer, "a.exr").name, "ViewLayer.Depth.Z");
    }
    EXPECT_EQ(findColour(viewLayer, "DiffDir", "a.exr").names[2], "ViewLayer.DiffDir.B");
    EXPECT_THROW(findColour(viewLayer, "DiffInd", "a.exr"), InputError);
    EXPECT_THROW(findColour(viewLayer, "View", "a.exr"), InputError) << "words are whole";
}

TEST(ExrLayers, AllParts) {
    const std::vector<ExrPart> parts{part({"diffuse.B", "diffuse.G", "diffuse.R"}, "diffuse"),
                                     part({"A", "B", "G", "R"}, "rgba"), part({"Z"}, "depth"), part({}, "deep")};
    const ColourChannels colour = findColour(parts, "", "a.exr");
    EXPECT_EQ(colour.part, 1U);
    EXPECT_EQ(findDepth(parts, colour.layer, "a.exr").part, 2U);
    EXPECT_EQ(findColour(parts, "diffuse", "a.exr").part, 0U);
}

TEST(ExrLayers, DepthOfTheSameViewLayer) {
    std::vector<std::string> channels;
    for (const std::string layer : {"Back", "Front"})
        for (const char* channel : {".Combined.R", ".Combined.G", ".Combined.B", ".Depth.Z"})
            channels.push_back(layer + channel);
    const std::vector<ExrPart> parts{part(channels)};
    EXPECT_THROW(findColour(parts, "", "a.exr"), InputError) << "nobody knows which of the two";
    const ColourChannels colour = findColour(parts, "Front", "a.exr");
    EXPECT_EQ(colour.names[1], "Front.Combined.G");
    EXPECT_EQ(findDepth(parts, colour.layer, "a.exr").name, "Front.Depth.Z");
    EXPECT_THROW(findDepth(parts, "", "a.exr"), InputError);
}

TEST(ExrLayers, OtherNamesOfDepth) {
    for (const char* name : {"Z", "depth.Z", "Depth.Z", "VRayZDepth.Z", "x.depth.V", "Z.Z"})
        EXPECT_EQ(findDepth({part({"B", "G", "R", name})}, "", "a.exr").name, name);
    for (const char* name : {"N.Z", "Mist.Z", "P.V"})
        EXPECT_THROW(findDepth({part({"B", "G", "R", name})}, "", "a.exr"), InputError) << name;
}

}  // namespace
}  // namespace lumulus::cli
