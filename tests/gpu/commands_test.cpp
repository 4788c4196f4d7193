#include "gpu/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "gpu/shaders/interface.h"
#include "gpu/test_programs.h"
#include "gpu/transfer.h"
#include "support/vulkan_fixture.h"

namespace lumulus::gpu {
namespace {

using shared::ScalePush;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StrEq;
using testing::ThrowsMessage;

class CommandsTest : public test::VulkanTest {
  protected:
    template <class T>
    Buffer filled(const std::string& name, const std::vector<T>& values) {
        Buffer buffer(context, name, values.size() * sizeof(T), Memory::device);
        upload(context, buffer, values);
        return buffer;
    }

    void run() {
        commands.submit();
        commands.wait();
    }

    Commands commands{context};
    Program<NoPush> copyProgram{context, "copy", test::copy_comp};
};

TEST_F(CommandsTest, SpecialisedProgramScalesABuffer) {
    const Program<ScalePush> plain(context, "double", test::scale_comp, {SpecConstant::of(0, 8)});
    const Program<ScalePush> special(
        context, "special", test::scale_comp,
        {SpecConstant::of(0, 16), SpecConstant::of(1, -3), SpecConstant::of(2, 0.5F), SpecConstant::of(3, true)});
    const Buffer numbers = filled<float>("numbers", {1, 2, 3, 4});
    commands.begin();
    commands.dispatch(plain, {{"Numbers", numbers}}, {.bias = 10, .count = 3}, {1, 1, 1});
    commands.barrier("numbers");
    commands.dispatch(special, {{"Numbers", numbers}}, {.bias = 0, .count = 4}, {1, 1, 1});
    run();
    // double: 2x + 10 for the first three; special: -(-3x + 1/2)
    EXPECT_THAT(download<float>(context, numbers), ElementsAre(35.5F, 41.5F, 47.5F, 11.5F));
}

TEST_F(CommandsTest, IndirectDispatchReadsItsGroups) {
    const Buffer source = filled<std::uint32_t>("source", std::vector<std::uint32_t>(32, 7));
    const Buffer target = filled<std::uint32_t>("target", std::vector<std::uint32_t>(32, 0));
    const Buffer arguments = filled<std::uint32_t>("arguments", {99, 3, 1, 1});  // three groups of eight
    commands.begin();
    commands.dispatchIndirect(copyProgram, {{"source", source}, {"target", target}}, {}, arguments, 4);
    EXPECT_THROW(commands.dispatchIndirect(copyProgram, {{"source", source}, {"target", target}}, {}, arguments, 8),
                 std::logic_error);
    run();
    const auto values = download<std::uint32_t>(context, target);
    EXPECT_EQ(std::accumulate(values.begin(), values.end(), 0U), 7U * 24U);
}

TEST_F(CommandsTest, Int64AtomicsAddUp) {
    const Program<NoPush> program(context, "sum", test::sum_comp);
    const Buffer sum = filled<std::uint64_t>("sum", {5});
    commands.begin();
    commands.dispatch(program, {{"sum", sum}}, {}, {100, 1, 1});
    run();
    const std::uint64_t n = 6400;
    EXPECT_EQ(download<std::uint64_t>(context, sum)[0], 5 + (n << 32U) + n * (n - 1) / 2);
}

TEST_F(CommandsTest, VolumeIsSampledLinearlyWithAZeroBorder) {
    Image volume(context, "volume", glm::ivec3(2, 2, 2), VK_FORMAT_R32_SFLOAT);
    upload(context, volume, std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8});
    const Program<std::uint32_t> program(context, "sample", test::sample_volume_comp);
    // coordinates 0 to 1: texel centres at 1/4 and 3/4
    const Buffer positions = filled<glm::vec3>("positions", {{0.25F, 0.25F, 0.25F},    // a centre
                                                             {0.5F, 0.25F, 0.25F},     // half way along x
                                                             {0.5F, 0.5F, 0.5F},       // the mean of all
                                                             {0.0F, 0.25F, 0.25F},     // on the face: half of it border
                                                             {0.0F, 0.0F, 0.0F},       // at the corner: an eighth of it
                                                             {-0.3F, 0.25F, 0.25F}});  // outside
    const auto sample = [&](Sampler sampler) {
        const Buffer values = filled<float>("values", std::vector<float>(6, -1.0F));
        commands.begin();
        commands.dispatch(program, {{"Positions", positions}, {"Values", values}, {"volume", volume, sampler}}, 6,
                          {1, 1, 1});
        run();
        return download<float>(context, values);
    };
    EXPECT_THAT(sample(Sampler::linear), ElementsAre(1, 1.5F, 4.5F, 0.5F, 0.125F, 0));
    const auto clamped = sample(Sampler::linearClamp);
    EXPECT_THAT(clamped, ElementsAre(1, 1.5F, 4.5F, 1, 1, 1));
    EXPECT_EQ(sample(Sampler::nearest)[5], 0.0F);
}

TEST_F(CommandsTest, HalfFloatVolumeIsLoadedAndStored) {
    const std::uint16_t one = 0x3C00;  // halves: 1, and below 1 to 3
    Image volume(context, "volume", glm::ivec3(3, 1, 2), VK_FORMAT_R16_SFLOAT);
    upload(context, volume, std::vector<std::uint16_t>(6, one));
    const Program<NoPush> program(context, "store", test::store_half_comp);
    commands.begin();
    commands.dispatch(program, {{"volume", volume}}, {}, {1, 1, 2});
    run();
    EXPECT_THAT(download<std::uint16_t>(context, volume), ElementsAre(one, 0x4000, 0x4200, one, 0x4000, 0x4200));
}

TEST_F(CommandsTest, IntegerPictureIsFetched) {
    Image picture(context, "picture", glm::ivec2(3, 2), VK_FORMAT_R16_UINT);
    Image doubled(context, "doubled", glm::ivec2(3, 2), VK_FORMAT_R32_UINT);
    upload(context, picture, std::vector<std::uint16_t>{1, 2, 3, 40000, 5, 6});
    const Program<NoPush> program(context, "fetch", test::fetch_integers_comp);
    commands.begin();
    commands.dispatch(program, {{"picture", picture, Sampler::nearest}, {"doubled", doubled}}, {}, {1, 2, 1});
    EXPECT_THROW(commands.dispatch(program, {{"picture", picture}, {"doubled", doubled}}, {}, {1, 2, 1}),
                 std::logic_error);
    run();
    EXPECT_THAT(download<std::uint32_t>(context, doubled), ElementsAre(2, 4, 6, 80000, 10, 12));
}

TEST_F(CommandsTest, BindingsMustBeThoseOfTheShader) {
    const Buffer source = filled<std::uint32_t>("a", {1});
    const Buffer target = filled<std::uint32_t>("b", {1});
    const Image image(context, "image", glm::ivec3(2, 2, 2), VK_FORMAT_R32_UINT);
    commands.begin();
    const auto refuses = [&](std::initializer_list<Binding> bindings, const char* why) {
        EXPECT_THAT(
            [&] {
                commands.dispatch(copyProgram, bindings, {}, {1, 1, 1});
            },
            ThrowsMessage<std::logic_error>(HasSubstr(why)));
    };
    refuses({{"source", source}}, "copy: binding target is missing");
    refuses({{"source", source}, {"target", target}, {"more", target}}, "copy: binding more is not in the shader");
    refuses({{"source", source}, {"target", target}, {"target", target}}, "given twice");
    refuses({{"source", image}, {"target", target}}, "is a buffer in the shader");
    EXPECT_TRUE(commands.steps().empty());
    run();
}

TEST_F(CommandsTest, ImagesMustFitTheirBinding) {
    const Program<NoPush> program(context, "store", test::store_half_comp);
    const Image flat(context, "flat", glm::ivec2(4, 4), VK_FORMAT_R16_SFLOAT);
    const Image volume(context, "volume", glm::ivec3(4, 4, 4), VK_FORMAT_R16_SFLOAT);
    const Buffer buffer(context, "buffer", 16, Memory::device);
    commands.begin();
    EXPECT_THROW(commands.dispatch(program, {{"volume", flat}}, {}, {1, 1, 1}), std::logic_error);
    EXPECT_THROW(commands.dispatch(program, {{"volume", volume, Sampler::linear}}, {}, {1, 1, 1}), std::logic_error);
    EXPECT_THROW(commands.dispatch(program, {{"volume", buffer}}, {}, {1, 1, 1}), std::logic_error);
    run();
}

TEST_F(CommandsTest, TooManyGroupsAreRefused) {
    const Buffer source = filled<std::uint32_t>("a", {1});
    const Buffer target = filled<std::uint32_t>("b", {1});
    commands.begin();
    const std::uint32_t limit = context.limits().maxComputeWorkGroupCount[1];
    EXPECT_THROW(commands.dispatch(copyProgram, {{"source", source}, {"target", target}}, {}, {1, limit + 1, 1}),
                 std::logic_error);
    run();
}

TEST_F(CommandsTest, MissingBarriersAreFound) {
    Buffer a = filled<std::uint32_t>("a", std::vector<std::uint32_t>(8, 1));
    Buffer b = filled<std::uint32_t>("b", std::vector<std::uint32_t>(8, 2));
    Buffer c = filled<std::uint32_t>("c", std::vector<std::uint32_t>(8, 3));
    commands.begin();
    commands.dispatch(copyProgram, {{"source", a}, {"target", b}}, {}, {1, 1, 1});
    const auto refuses = [&](const auto& call, const char* why) {
        EXPECT_THAT(call, ThrowsMessage<std::logic_error>(StrEq(why)));
    };
    refuses(
        [&] {
            commands.dispatch(copyProgram, {{"source", b}, {"target", c}}, {}, {1, 1, 1});
        },
        "missing barrier: copy reads b written by copy");
    refuses(
        [&] {
            commands.dispatch(copyProgram, {{"source", c}, {"target", b}}, {}, {1, 1, 1});
        },
        "missing barrier: copy writes b written by copy");
    refuses([&] { commands.fill(a, 0); }, "missing barrier: fill a writes a read by copy");
    refuses(
        [&] {
            commands.dispatchIndirect(copyProgram, {{"source", a}, {"target", c}}, {}, b);
        },
        "missing barrier: copy reads b written by copy");
    commands.dispatch(copyProgram, {{"source", a}, {"target", c}}, {}, {1, 1, 1});  // reads only what was read
    commands.barrier("a to b");
    commands.fill(a, 9);
    commands.dispatch(copyProgram, {{"source", b}, {"target", c}}, {}, {1, 1, 1});
    run();
    EXPECT_EQ(download<std::uint32_t>(context, c), std::vector<std::uint32_t>(8, 1));
    EXPECT_EQ(download<std::uint32_t>(context, a), std::vector<std::uint32_t>(8, 9));
}

TEST_F(CommandsTest, HostMemoryShowsTheResultAfterWait) {
    const Buffer source = filled<std::uint32_t>("source", std::vector<std::uint32_t>(8, 6));
    Buffer result(context, "result", 32, Memory::host);
    commands.begin();
    commands.dispatch(copyProgram, {{"source", source}, {"target", result}}, {}, {1, 1, 1});
    run();
    EXPECT_EQ(result.mapped<std::uint32_t>()[7], 6U);
}

TEST_F(CommandsTest, StepsAreAValue) {
    Buffer a = filled<std::uint32_t>("a", std::vector<std::uint32_t>(8, 1));
    Buffer b(context, "b", 32, Memory::device);
    const Buffer groups = filled<std::uint32_t>("groups", {1, 1, 1});
    commands.begin();
    commands.pass("clear");
    commands.fill(b, 0);
    commands.barrier("b is clear");
    commands.pass("work");
    commands.dispatch(copyProgram, {{"source", a}, {"target", b}}, {}, {1, 1, 1});
    commands.barrier("b is done");
    commands.dispatchIndirect(copyProgram, {{"source", a}, {"target", b}}, {}, groups);
    run();
    EXPECT_THAT(commands.steps(), ElementsAre(Step{StepKind::pass, "clear"}, Step{StepKind::fill, "fill b"},
                                              Step{StepKind::barrier, "b is clear"}, Step{StepKind::pass, "work"},
                                              Step{StepKind::dispatch, "copy"}, Step{StepKind::barrier, "b is done"},
                                              Step{StepKind::indirect, "copy"}));
}

TEST_F(CommandsTest, ManyPassesAreTimedByName) {
    Buffer buffer(context, "buffer", 1 << 20, Memory::device);
    for (const int passes : {300, 2}) {  // again with fewer: the times are those of the last submission
        commands.begin();
        for (int i = 0; i < passes; ++i) {
            commands.pass("pass " + std::to_string(i));
            commands.fill(buffer, 1);
            commands.barrier("filled");
        }
        run();
        ASSERT_EQ(commands.times().size(), static_cast<std::size_t>(passes));
        double sum = 0.0;
        for (int i = 0; i < passes; ++i) {
            const PassTime& time = commands.times()[static_cast<std::size_t>(i)];
            EXPECT_EQ(time.name, "pass " + std::to_string(i));
            EXPECT_GE(time.milliseconds, 0.0);
            sum += time.milliseconds;
        }
        EXPECT_GT(sum, 0.0);
        EXPECT_LT(sum, 60e3);
    }
}

TEST_F(CommandsTest, CallsOutOfOrderAreRefused) {
    Buffer buffer(context, "buffer", 16, Memory::device);
    EXPECT_THROW(commands.fill(buffer, 0), std::logic_error);
    EXPECT_THROW(commands.submit(), std::logic_error);
    EXPECT_THROW(commands.wait(), std::logic_error);
    commands.begin();
    commands.submit();
    EXPECT_THROW(commands.begin(), std::logic_error);
    commands.wait();
}

}  // namespace
}  // namespace lumulus::gpu
