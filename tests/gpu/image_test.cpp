#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <numeric>
#include <vector>

#include "gpu/commands.h"
#include "gpu/test_programs.h"
#include "gpu/transfer.h"
#include "support/vulkan_fixture.h"

namespace lumulus::gpu {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StrEq;
using testing::ThrowsMessage;

class ImageTest : public test::VulkanTest {
  protected:
    glm::vec4 sample(const Binding& picture, float level) {
        const Program<float> program(context, "sample level", test::sample_level_comp);
        const Buffer value(context, "value", sizeof(glm::vec4), Memory::host);
        commands.begin();
        commands.dispatch(program, {picture, {"Value", value}}, level, {1, 1, 1});
        commands.submit();
        commands.wait();
        return value.mapped<glm::vec4>()[0];
    }

    Commands commands{context};
};

TEST_F(ImageTest, EveryFormatIsStoredByShaders) {
    const Program<NoPush> program(context, "store formats", test::store_formats_comp);
    ASSERT_EQ(program.bindings().size(), std::size(texelSizes));
    const auto image = [&](const char* name, VkFormat format) {
        return Image(context, name, glm::ivec2(3, 2), format);
    };
    std::vector<Image> images;
    images.push_back(image("r8", VK_FORMAT_R8_UNORM));
    images.push_back(image("r16f", VK_FORMAT_R16_SFLOAT));
    images.push_back(image("r16ui", VK_FORMAT_R16_UINT));
    images.push_back(image("r32f", VK_FORMAT_R32_SFLOAT));
    images.push_back(image("r32ui", VK_FORMAT_R32_UINT));
    images.push_back(image("rg16f", VK_FORMAT_R16G16_SFLOAT));
    images.push_back(image("rg32f", VK_FORMAT_R32G32_SFLOAT));
    images.push_back(image("rg32ui", VK_FORMAT_R32G32_UINT));
    images.push_back(image("rgba8", VK_FORMAT_R8G8B8A8_UNORM));
    images.push_back(image("r11f_g11f_b10f", VK_FORMAT_B10G11R11_UFLOAT_PACK32));
    images.push_back(image("rgba16f", VK_FORMAT_R16G16B16A16_SFLOAT));
    images.push_back(image("rgba32f", VK_FORMAT_R32G32B32A32_SFLOAT));
    std::vector<Binding> bindings;
    for (const Image& one : images) bindings.emplace_back(one.name(), one);
    commands.begin();
    commands.dispatch(program, bindings, {}, {3, 2, 1});
    commands.submit();
    commands.wait();

    const auto last = [&]<class T>(std::size_t index, T) { return download<T>(context, images[index]).back(); };
    EXPECT_EQ(last(0, std::uint8_t{}), 255);
    EXPECT_EQ(last(1, std::uint16_t{}), 0x3C00);
    EXPECT_EQ(last(2, std::uint16_t{}), 40000);
    EXPECT_EQ(last(3, float{}), 1.0F);
    EXPECT_EQ(last(4, std::uint32_t{}), 40000U);
    EXPECT_EQ(last(5, std::uint32_t{}), 0x38003C00U);
    EXPECT_EQ(last(6, glm::vec2{}), glm::vec2(1.0F, 0.5F));
    EXPECT_EQ(last(7, glm::uvec2{}), glm::uvec2(40000, 7));
    EXPECT_EQ(last(8, std::uint32_t{}) & 0xFF0000FFU, 0x000000FFU);
    // exponents 15, 14 and 13, no mantissa: 6, 6 and 5 bits of it from the lowest bit on
    EXPECT_EQ(last(9, std::uint32_t{}), (15U << 6U) | (14U << 17U) | (13U << 27U));
    EXPECT_EQ(last(10, std::uint64_t{}), 0x0000340038003C00ULL);
    EXPECT_EQ(last(11, glm::vec4{}), glm::vec4(1.0F, 0.5F, 0.25F, 0.0F));
    // and all but the integers are filtered
    for (const std::size_t i : {0U, 1U, 3U, 5U, 6U, 8U, 9U, 10U, 11U})
        EXPECT_EQ(sample({"picture", images[i], Sampler::linear}, 0.0F).x, 1.0F) << images[i].name();
}

TEST_F(ImageTest, LevelsAndLayersAreTransferredApart) {
    Image array(context, "array", glm::ivec2(5, 3), VK_FORMAT_R32_UINT, {.levels = 3, .layers = 4});
    ASSERT_EQ(array.bytes(), 4U * 4U * (15 + 2 + 1));  // 5x3, 2x1, 1x1
    std::vector<std::uint32_t> values(array.bytes() / 4);
    std::iota(values.begin(), values.end(), 100U);
    upload(context, array, values);
    EXPECT_EQ(download<std::uint32_t>(context, array), values);
    EXPECT_THAT(download<std::uint32_t>(context, array.level(1)), ElementsAre(160, 161, 162, 163, 164, 165, 166, 167));
    EXPECT_THAT(download<std::uint32_t>(context, array.level(1, 2)), ElementsAre(164, 165));
    upload(context, array.level(1, 2), std::vector<std::uint32_t>{7, 8});
    EXPECT_THAT(download<std::uint32_t>(context, array.level(1)), ElementsAre(160, 161, 162, 163, 7, 8, 166, 167));
    EXPECT_THROW(upload(context, array.level(2), values), std::logic_error);
}

TEST_F(ImageTest, LayersLargerThanTheStagingBufferAreTransferredByRows) {
    const Image picture(context, "picture", glm::ivec2(1024, 4100), VK_FORMAT_R32_UINT, {.layers = 2});
    ASSERT_GT(picture.bytes() / 2, stagingBytes);
    std::vector<std::uint32_t> texels(picture.bytes() / sizeof(std::uint32_t));
    std::iota(texels.begin(), texels.end(), 1U);
    upload(context, picture, texels);
    EXPECT_EQ(download<std::uint32_t>(context, picture), texels);
    const std::vector<std::uint32_t> second(texels.begin() + 1024 * 4100, texels.end());
    EXPECT_EQ(download<std::uint32_t>(context, picture.level(0, 1)), second);
}

TEST_F(ImageTest, LevelsOfAVolumeAreTransferred) {
    Image volume(context, "volume", glm::ivec3(4, 3, 5), VK_FORMAT_R16_UINT, {.levels = 3});
    EXPECT_EQ(volume.level(1).extent(), glm::ivec3(2, 1, 2));
    std::vector<std::uint16_t> values(60 + 4 + 1);
    std::iota(values.begin(), values.end(), std::uint16_t{1});
    upload(context, volume, values);
    EXPECT_EQ(download<std::uint16_t>(context, volume), values);
    EXPECT_THAT(download<std::uint16_t>(context, volume.level(1)), ElementsAre(61, 62, 63, 64));
}

TEST_F(ImageTest, ImpossiblePartsAreRefused) {
    const auto make = [&](auto extent, ImageParts parts) {
        Image(context, "image", extent, VK_FORMAT_R8_UNORM, parts);
    };
    EXPECT_EQ(mipLevels({8, 1, 1}), 4);
    EXPECT_EQ(mipLevels({5, 9, 1}), 4);
    EXPECT_NO_THROW(make(glm::ivec2(8, 1), {.levels = 4}));
    EXPECT_THROW(make(glm::ivec2(8, 1), {.levels = 5}), std::logic_error);
    EXPECT_THROW(make(glm::ivec2(8, 1), {.levels = 0}), std::logic_error);
    EXPECT_THROW(make(glm::ivec3(8, 8, 8), {.layers = 2}), std::logic_error);
    const Image image(context, "image", glm::ivec2(8, 8), VK_FORMAT_R8_UNORM, {.levels = 2, .layers = 2});
    EXPECT_THROW(image.level(2), std::logic_error);
    EXPECT_THROW(image.level(0, 2), std::logic_error);
}

TEST_F(ImageTest, MipChainOfAnArrayIsBuiltLevelByLevel) {
    const Program<NoPush> program(context, "halve", test::halve_layers_comp);
    Image array(context, "sky", glm::ivec2(16, 16), VK_FORMAT_R32_SFLOAT, {.levels = 5, .layers = 3});
    std::vector<float> finest(16 * 16 * 3);
    for (std::size_t i = 0; i < finest.size(); ++i)
        finest[i] = static_cast<float>(i / 256) * 10 + static_cast<float>(i % 16);
    upload(context, array.level(0), finest);
    commands.begin();
    for (int level = 1; level < array.levels(); ++level) {
        commands.dispatch(program,
                          {{"finer", array.level(level - 1), Sampler::linearClamp}, {"coarser", array.level(level)}},
                          {}, {2, 2, 3});
        commands.barrier("level");
    }
    commands.submit();
    commands.wait();
    EXPECT_THAT(download<float>(context, array.level(4)), ElementsAre(7.5F, 17.5F, 27.5F));  // the mean of 0 to 15
    EXPECT_THAT(download<float>(context, array.level(3, 1)), ElementsAre(13.5F, 21.5F, 13.5F, 21.5F));
    EXPECT_EQ(download<float>(context, array.level(0)), finest);
}

TEST_F(ImageTest, HazardsAreFoundByLevel) {
    const Program<NoPush> program(context, "halve", test::halve_layers_comp);
    const Image array(context, "sky", glm::ivec2(16, 16), VK_FORMAT_R32_SFLOAT, {.levels = 4, .layers = 1});
    const auto halve = [&](int from, int to) {
        commands.dispatch(program, {{"finer", array.level(from), Sampler::linearClamp}, {"coarser", array.level(to)}},
                          {}, {1, 1, 1});
    };
    commands.begin();
    halve(0, 1);
    EXPECT_THAT([&] { halve(1, 2); },
                ThrowsMessage<std::logic_error>(StrEq("missing barrier: halve reads sky level 1 written by halve")));
    halve(2, 3);  // has nothing to do with the first
    EXPECT_THROW(halve(0, 2), std::logic_error);
    commands.barrier("levels");
    halve(1, 2);
    commands.submit();
    commands.wait();
}

TEST_F(ImageTest, SamplersMixLevels) {
    Image picture(context, "picture", glm::ivec2(2, 2), VK_FORMAT_R32_SFLOAT, {.levels = 2});
    upload(context, picture, std::vector<float>{1, 1, 1, 1, 5});
    EXPECT_EQ(sample({"picture", picture, Sampler::linear}, 0.0F).x, 1.0F);
    EXPECT_EQ(sample({"picture", picture, Sampler::linear}, 0.5F).x, 3.0F);
    EXPECT_EQ(sample({"picture", picture, Sampler::linearClamp}, 9.0F).x, 5.0F);
    EXPECT_EQ(sample({"picture", picture, Sampler::nearest}, 0.9F).x, 5.0F);
    EXPECT_EQ(sample({"picture", picture.level(1), Sampler::linear}, 0.0F).x, 5.0F);
}

TEST_F(ImageTest, BindingsAreCheckedForLevelsAndLayers) {
    const Program<NoPush> program(context, "halve", test::halve_layers_comp);
    const Image array(context, "array", glm::ivec2(4, 4), VK_FORMAT_R32_SFLOAT, {.levels = 2, .layers = 2});
    const Image flat(context, "flat", glm::ivec2(4, 4), VK_FORMAT_R32_SFLOAT);
    commands.begin();
    const auto refuses = [&](const Binding& finer, const Binding& coarser, const char* why) {
        EXPECT_THAT(
            [&] {
                commands.dispatch(program, {finer, coarser}, {}, {1, 1, 1});
            },
            ThrowsMessage<std::logic_error>(HasSubstr(why)));
    };
    refuses({"finer", flat, Sampler::linear}, {"coarser", array.level(1)}, "needs a 2D image array with a sampler");
    refuses({"finer", array.level(0), Sampler::linear}, {"coarser", array}, "needs one level of the image");
    refuses({"finer", array.level(0), Sampler::linear}, {"coarser", array.level(1, 0)}, "cannot be one layer");
    commands.submit();
    commands.wait();
}

}  // namespace
}  // namespace lumulus::gpu
