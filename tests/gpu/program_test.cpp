#include "gpu/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <stdexcept>

#include "gpu/reflection.h"
#include "gpu/shaders/interface.h"
#include "gpu/test_programs.h"
#include "support/vulkan_fixture.h"

namespace lumulus::gpu {
namespace {

using shared::Inner;
using shared::Outer;
using shared::ScalePush;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;
using ProgramTest = test::VulkanTest;

TEST(Reflection, SharedStructLiesAsInCpp) {
    const Reflection reflection = reflect(test::layout_comp);
    const StructLayout& outer = reflection.layout("Outer");
    EXPECT_EQ(outer.bytes, sizeof(Outer));
    EXPECT_THAT(outer.members, ElementsAre(MemberLayout{"first", offsetof(Outer, first), sizeof(Outer::first)},
                                           MemberLayout{"position", offsetof(Outer, position), sizeof(Outer::position)},
                                           MemberLayout{"total", offsetof(Outer, total), sizeof(Outer::total)},
                                           MemberLayout{"inner", offsetof(Outer, inner), sizeof(Outer::inner)},
                                           MemberLayout{"rotation", offsetof(Outer, rotation), sizeof(Outer::rotation)},
                                           MemberLayout{"cell", offsetof(Outer, cell), sizeof(Outer::cell)},
                                           MemberLayout{"last", offsetof(Outer, last), sizeof(Outer::last)}));
    const StructLayout& inner = reflection.layout("Inner");
    EXPECT_EQ(inner.bytes, sizeof(Inner));
    EXPECT_THAT(inner.members,
                ElementsAre(MemberLayout{"direction", offsetof(Inner, direction), sizeof(Inner::direction)},
                            MemberLayout{"weight", offsetof(Inner, weight), sizeof(Inner::weight)},
                            MemberLayout{"pair", offsetof(Inner, pair), sizeof(Inner::pair)}));
    EXPECT_THROW(reflection.layout("Nobody"), std::logic_error);
}

TEST(Reflection, BlockEndsWithItsArrayOfUnknownLength) {
    const Reflection reflection = reflect(test::layout_comp);
    EXPECT_THAT(reflection.layout("Records").members,
                ElementsAre(MemberLayout{"count", 0, 4}, MemberLayout{"records", 8, 0}));
}

TEST(Reflection, SizeIsRoundedAsSizeofIs) {
    EXPECT_EQ(sizeof(ScalePush), 16U);
    EXPECT_EQ(reflect(test::scale_comp).pushBytes, 16U);
}

TEST(Reflection, NamesAndQualifiersOfBindings) {
    const Reflection copy = reflect(test::copy_comp);
    ASSERT_EQ(copy.bindings.size(), 2U);
    EXPECT_EQ(copy.bindings[0].name, "source");  // the instance, not the block
    EXPECT_TRUE(copy.bindings[0].reads);
    EXPECT_FALSE(copy.bindings[0].writes);
    EXPECT_EQ(copy.bindings[1].name, "target");
    EXPECT_FALSE(copy.bindings[1].reads);
    EXPECT_TRUE(copy.bindings[1].writes);

    const Reflection scale = reflect(test::scale_comp);
    ASSERT_EQ(scale.bindings.size(), 1U);
    EXPECT_EQ(scale.bindings[0].name, "Numbers");  // the block, which has no instance
    EXPECT_TRUE(scale.bindings[0].reads);
    EXPECT_TRUE(scale.bindings[0].writes);
}

TEST(Reflection, KindsOfImages) {
    const Reflection reflection = reflect(test::fetch_integers_comp);
    ASSERT_EQ(reflection.bindings.size(), 2U);
    const BindingInfo& sampled = reflection.bindings[0];
    EXPECT_EQ(sampled.name, "picture");
    EXPECT_EQ(sampled.kind, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    EXPECT_TRUE(sampled.reads);
    EXPECT_FALSE(sampled.writes);
    const BindingInfo& stored = reflection.bindings[1];
    EXPECT_EQ(stored.name, "doubled");
    EXPECT_EQ(stored.kind, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    EXPECT_EQ(stored.dimensions, 2);
    EXPECT_FALSE(stored.reads);
    EXPECT_TRUE(stored.writes);
    EXPECT_EQ(reflect(test::sample_volume_comp).bindings.front().dimensions, 3);
}

TEST(Reflection, UniformBlockIsRefused) {
    EXPECT_THAT([] { reflect(test::unsupported_comp); }, ThrowsMessage<std::logic_error>(HasSubstr("uniform blocks")));
}

TEST(Reflection, WordsThatAreNotSpirvAreRefused) {
    const std::uint32_t words[] = {1, 2, 3, 4, 5};
    EXPECT_THROW(reflect(words), std::logic_error);
}

TEST_F(ProgramTest, PushConstantsOfAnotherSizeAreRefused) {
    EXPECT_THAT([&] { Program<std::uint32_t>(context, "scale", test::scale_comp); },
                ThrowsMessage<std::logic_error>(AllOf(HasSubstr("scale"), HasSubstr("4 bytes"), HasSubstr("16"))));
    EXPECT_THROW(Program<NoPush>(context, "scale", test::scale_comp), std::logic_error);
    EXPECT_THROW(Program<ScalePush>(context, "copy", test::copy_comp), std::logic_error);
}

TEST_F(ProgramTest, UnknownSpecialisationConstantIsRefused) {
    EXPECT_THAT([&] { Program<ScalePush>(context, "scale", test::scale_comp, {SpecConstant::of(9, 1)}); },
                ThrowsMessage<std::logic_error>(HasSubstr("constant_id 9")));
}

}  // namespace
}  // namespace lumulus::gpu
