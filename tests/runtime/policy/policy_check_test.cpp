// Policy packs: every wrong value is refused with its own message, every damage with some message.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <variant>

#include "galactic/learned_policy.h"
#include "runtime/check/pack_damage.h"
#include "runtime/check/pack_offence.h"
#include "runtime/policy/policy_run.h"
#include "support/packs/policy_pack_builder.h"

namespace galactic::test::policy_check_test {
namespace {

using Fields = PolicyPackFields;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Layers of smallPolicy().
constexpr std::size_t kImage = 2;
constexpr std::size_t kSpaceToDepth = 3;
constexpr std::size_t kConvolution = 4;
constexpr std::size_t kGroupNorm = 5;
constexpr std::size_t kSum = 6;
constexpr std::size_t kPool = 8;
constexpr std::size_t kLinear = 9;
constexpr std::size_t kLayerNorm = 10;
constexpr std::size_t kNormalize = 11;
constexpr std::size_t kConcatenate = 12;
constexpr std::size_t kGru = 13;
constexpr std::size_t kSlice = 15;
constexpr std::size_t kConstant = 18;
constexpr std::size_t kClamp = 19;

template <class Kind>
Kind& kindOf(Fields& f, std::size_t layer) {
  return std::get<Kind>(f.content.layers[layer].kind);
}
PolicyInterface& needs(Fields& f) { return f.content.interface; }

TEST(PolicyPack, IsAcceptedAsItIsMade) {
  const AlignedBytes bytes = buildPack(Fields{});
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
  EXPECT_EQ(pack->kind(), PackKind::kPolicy);
}

TEST(PolicyPack, IsRefusedWithAWrongNameOptionOrObservation) {
  expectRefused<Fields>(
      Fields{},
      {{"policy.name", "is empty, expected the policy's name",
        [](Fields& f) { needs(f).name = ""; }},
       {"policy.options[1].name",
        "is \"hurry\", expected an option of the task, reward or robot of galactic-run",
        [](Fields& f) { needs(f).options[1].name = "hurry"; }},
       {"policy.options[1].name",
        "is \"task\", expected each option once, in the order of galactic-run's table",
        [](Fields& f) { needs(f).options[1] = needs(f).options[0]; }},
       {"policy.options[0].value", "is \"cook\", expected rearrange, pick or none for task",
        [](Fields& f) { needs(f).options[0].value = "cook"; }},
       {"policy.observation[1].name", "is empty or a repeated name, expected each part's own",
        [](Fields& f) { needs(f).observation[1].name = ""; }},
       {"policy.observation[1].name", "is empty or a repeated name, expected each part's own",
        [](Fields& f) { needs(f).observation[1].name = "grip_target"; }},
       {"policy.observation[0].size", "is 0, expected at least 1",
        [](Fields& f) { needs(f).observation[0].size = 0; }},
       {"policy.layers[0]", "reads an observation of 0 elements, expected 1 to 16777216",
        [](Fields& f) { needs(f).observation.clear(); }},
       {"policy.layers[0]", "reads an observation of 4294967296 elements, expected 1 to 16777216",
        [](Fields& f) { needs(f).observation[0].size = 4294967295U; }},
       {"policy.layers[11].mean", "has 4 elements, expected 5",
        [](Fields& f) { ++needs(f).observation[0].size; }}});
}

TEST(PolicyPack, IsRefusedWithAWrongImage) {
  const auto image = [](Fields& f) -> PolicyImage& { return *needs(f).image; };
  expectRefused<Fields>(
      Fields{},
      {{"policy.image.width", "is 0, expected 1 to 4096", [=](Fields& f) { image(f).width = 0; }},
       {"policy.image.height", "is 4097, expected 1 to 4096",
        [=](Fields& f) { image(f).height = 4097; }},
       {"policy.image.color", "and depth are false, expected one of them at least",
        [=](Fields& f) { image(f).color = image(f).depth = false; }},
       {"policy.image.color_scale", "is nan, expected a finite number",
        [=](Fields& f) { image(f).color_scale = kNan; }},
       {"policy.image.depth_limit", "is 0 m, expected a finite length above 0",
        [=](Fields& f) { image(f).depth_limit = 0; }},
       {"policy.image.depth_limit", "is inf m, expected a finite length above 0",
        [=](Fields& f) { image(f).depth_limit = kInfinity; }},
       {"policy.image.depth_scale", "is inf, expected a finite number",
        [=](Fields& f) { image(f).depth_scale = kInfinity; }},
       {"policy.image.camera", "is empty, expected a camera's name",
        [=](Fields& f) { image(f).camera = ""; }},
       {"policy.image.vertical_fov", "is -1 rad, expected 0 or more, less than pi",
        [=](Fields& f) { image(f).vertical_fov = -1; }},
       {"policy.image.vertical_fov", "is 4 rad, expected 0 or more, less than pi",
        [=](Fields& f) { image(f).vertical_fov = 4; }},
       {"policy.image.near", "is 0.001 m, expected 0.01 to 100, or 0",
        [=](Fields& f) { image(f).near = 0.001F; }},
       {"policy.image.near", "is nan m, expected 0.01 to 100, or 0",
        [=](Fields& f) { image(f).near = kNan; }},
       {"policy.image.place", "is 101 m away, expected -100 to 100",
        [=](Fields& f) { image(f).position[0] = 101; }},
       {"policy.image.place", "is nan m away, expected -100 to 100",
        [=](Fields& f) { image(f).position[1] = kNan; }},
       {"policy.image.place", "is -inf m away, expected -100 to 100",
        [=](Fields& f) { image(f).position[2] = -kInfinity; }},
       {"policy.image.place", "is turned by 361 degrees, expected -360 to 360",
        [=](Fields& f) { image(f).rpy_degrees[0] = 361; }},
       {"policy.image.place", "is turned by inf degrees, expected -360 to 360",
        [=](Fields& f) { image(f).rpy_degrees[1] = kInfinity; }},
       {"policy.image.place", "is turned by nan degrees, expected -360 to 360",
        [=](Fields& f) { image(f).rpy_degrees[2] = kNan; }},
       {"policy.layers[2]", "reads an image, expected Policy.image to say which",
        [](Fields& f) { needs(f).image.reset(); }},
       {"policy.layers[3].block", "is 2, expected a divisor of 6 x 5 pixels",
        [=](Fields& f) { image(f).height = 5; }},
       {"policy.layers[4].weight", "has 576 elements, expected 432",
        [=](Fields& f) { image(f).depth = false; }},
       {"policy.layers[2]",
        "has a value of 67108864 elements, and all layers up to it have 67108871, expected at most "
        "16777216",
        [=](Fields& f) { image(f).width = image(f).height = 4096; }}});
}

TEST(PolicyPack, IsRefusedWithWrongInputsOfALayer) {
  const auto inputs = [](Fields& f, std::size_t n) -> std::vector<std::uint32_t>& {
    return f.content.layers[n].inputs;
  };
  expectRefused<Fields>(
      Fields{},
      {{"policy.layers", "has 0 elements, expected 1 to 4096",
        [](Fields& f) { f.content.layers.clear(); }},
       {"policy.layers", "has 4097 elements, expected 1 to 4096",
        [](Fields& f) { f.content.layers.resize(4097); }},
       {"policy.layers[7].inputs[0]", "is 7, expected the number of a layer before this one",
        [=](Fields& f) { inputs(f, 7) = {7}; }},
       {"policy.layers[6].inputs[1]",
        "is 4294967295, expected the number of a layer before this one",
        [=](Fields& f) { inputs(f, kSum)[1] = 4294967295U; }},
       {"policy.layers[1].inputs", "has 1 elements, expected 0 for PreviousActionLayer",
        [=](Fields& f) { inputs(f, 1) = {0}; }},
       {"policy.layers[7].inputs", "has 0 elements, expected 1 for ReluLayer",
        [=](Fields& f) { inputs(f, 7) = {}; }},
       {"policy.layers[6].inputs", "has 1 elements, expected 2 for SumLayer",
        [=](Fields& f) { inputs(f, kSum) = {4}; }},
       {"policy.layers[12].inputs", "has 0 elements, expected 1 or more for ConcatenateLayer",
        [=](Fields& f) { inputs(f, kConcatenate) = {}; }},
       {"policy.layers[6].inputs",
        "have 4 x 2 x 3 and 16 x 2 x 3 elements, expected the same shape",
        [=](Fields& f) {
          inputs(f, kSum) = {4, 3};
        }},
       {"policy.layers[12].inputs[1]", "has 2 x 2 pixels, expected a vector",
        [=](Fields& f) { inputs(f, kConcatenate)[1] = kPool; }},
       {"policy.layers[10].inputs[0]", "has 2 x 2 pixels, expected a vector",
        [=](Fields& f) { inputs(f, kLayerNorm) = {kPool}; }},
       {"policy.layers[13].inputs[0]", "has 2 x 2 pixels, expected a vector",
        [=](Fields& f) { inputs(f, kGru) = {kPool}; }},
       {"policy.layers[15].inputs[0]", "has 6 x 4 pixels, expected a vector",
        [=](Fields& f) { inputs(f, kSlice) = {kImage}; }}});
}

TEST(PolicyPack, IsRefusedWithAWrongSizeOfALayer) {
  expectRefused<Fields>(
      Fields{},
      {{"policy.layers[3].block", "is 0, expected a divisor of 6 x 4 pixels",
        [](Fields& f) { kindOf<layer::SpaceToDepth>(f, kSpaceToDepth).block = 0; }},
       {"policy.layers[4].outputs", "is 0, expected 1 to 16777216",
        [](Fields& f) { kindOf<layer::Convolution>(f, kConvolution).outputs = 0; }},
       {"policy.layers[4].kernel", "is 0, expected 1 to 4096",
        [](Fields& f) { kindOf<layer::Convolution>(f, kConvolution).kernel = 0; }},
       {"policy.layers[4].kernel", "is 5 and finds no place on 3 x 2 pixels",
        [](Fields& f) { kindOf<layer::Convolution>(f, kConvolution).kernel = 5; }},
       {"policy.layers[4].stride", "is 0, expected at least 1",
        [](Fields& f) { kindOf<layer::Convolution>(f, kConvolution).stride = 0; }},
       {"policy.layers[4].padding", "is 3, expected less than the kernel of 3",
        [](Fields& f) { kindOf<layer::Convolution>(f, kConvolution).padding = 3; }},
       {"policy.layers[4].kernel",
        "is 4096, and 268435456 numbers of the input decide one of the result, expected at most "
        "134217728",
        [](Fields& f) {
          kindOf<layer::Convolution>(f, kConvolution).kernel = 4096;
          kindOf<layer::Convolution>(f, kConvolution).padding = 4095;
        }},
       {"policy.layers[8].kernel", "is 9 and finds no place on 3 x 2 pixels",
        [](Fields& f) { kindOf<layer::AveragePool>(f, kPool).kernel = 9; }},
       {"policy.layers[8].stride", "is 0, expected at least 1",
        [](Fields& f) { kindOf<layer::AveragePool>(f, kPool).stride = 0; }},
       {"policy.layers[8].padding", "is 2, expected less than the kernel of 2",
        [](Fields& f) { kindOf<layer::AveragePool>(f, kPool).padding = 2; }},
       {"policy.layers[9].weight", "has 80 elements, expected 20",
        [](Fields& f) { kindOf<layer::AveragePool>(f, kPool).stride = 4; }},
       {"policy.layers[5].groups", "is 3, expected a divisor of the 4 channels",
        [](Fields& f) { kindOf<layer::GroupNorm>(f, kGroupNorm).groups = 3; }},
       {"policy.layers[5].groups", "is 0, expected a divisor of the 4 channels",
        [](Fields& f) { kindOf<layer::GroupNorm>(f, kGroupNorm).groups = 0; }},
       {"policy.layers[9].outputs", "is 0, expected 1 to 16777216",
        [](Fields& f) { kindOf<layer::Linear>(f, kLinear).outputs = 0; }},
       {"policy.layers[9].weight", "has 80 elements, expected 96",
        [](Fields& f) { kindOf<layer::Linear>(f, kLinear).outputs = 6; }},
       {"policy.layers[13].size", "is 0, expected 1 to 65536",
        [](Fields& f) { kindOf<layer::Gru>(f, kGru).size = 0; }},
       {"policy.layers[13].size", "is 65537, expected 1 to 65536",
        [](Fields& f) { kindOf<layer::Gru>(f, kGru).size = 65537; }},
       {"policy.layers[15].size", "is 0 from element 0 on, expected 1 or more of the 4 elements",
        [](Fields& f) { kindOf<layer::Slice>(f, kSlice).size = 0; }},
       {"policy.layers[15].size", "is 2 from element 3 on, expected 1 or more of the 4 elements",
        [](Fields& f) { kindOf<layer::Slice>(f, kSlice).first = 3; }},
       {"policy.layers[15].size",
        "is 2 from element 4294967295 on, expected 1 or more of the 4 elements",
        [](Fields& f) { kindOf<layer::Slice>(f, kSlice).first = 4294967295U; }}});
}

TEST(PolicyPack, IsRefusedWithAWrongNumberInALayer) {
  expectRefused<Fields>(
      Fields{}, {{"policy.layers[5].epsilon", "is 0, expected a finite number above 0",
                  [](Fields& f) { kindOf<layer::GroupNorm>(f, kGroupNorm).epsilon = 0; }},
                 {"policy.layers[10].epsilon", "is nan, expected a finite number above 0",
                  [](Fields& f) { kindOf<layer::LayerNorm>(f, kLayerNorm).epsilon = kNan; }},
                 {"policy.layers[11].limit", "is inf, expected a finite number above 0",
                  [](Fields& f) { kindOf<layer::Normalize>(f, kNormalize).limit = kInfinity; }},
                 {"policy.layers[18].values", "is empty, expected at least one number",
                  [](Fields& f) { kindOf<layer::Constant>(f, kConstant).values.clear(); }},
                 {"policy.layers[19].upper",
                  "and lower are 2 and 3, expected finite numbers, lower the smaller",
                  [](Fields& f) { kindOf<layer::Clamp>(f, kClamp).lower = 3; }},
                 {"policy.layers[19].upper",
                  "and lower are inf and -5, expected finite numbers, lower the smaller",
                  [](Fields& f) { kindOf<layer::Clamp>(f, kClamp).upper = kInfinity; }}});
}

/// A list of weights, where it is, and how many there are.
struct Weights {
  std::string field;
  std::vector<float>& (*of)(Fields&);
};

TEST(PolicyPack, IsRefusedWhereAWeightIsMissingOrNoNumber) {
  const std::vector<Weights> all{
      {"layers[4].weight",
       [](Fields& f) -> std::vector<float>& {
         return kindOf<layer::Convolution>(f, kConvolution).weight;
       }},
      {"layers[4].bias",
       [](Fields& f) -> std::vector<float>& {
         return kindOf<layer::Convolution>(f, kConvolution).bias;
       }},
      {"layers[5].weight",
       [](Fields& f) -> std::vector<float>& {
         return kindOf<layer::GroupNorm>(f, kGroupNorm).weight;
       }},
      {"layers[5].bias",
       [](Fields& f) -> std::vector<float>& {
         return kindOf<layer::GroupNorm>(f, kGroupNorm).bias;
       }},
      {"layers[9].weight",
       [](Fields& f) -> std::vector<float>& { return kindOf<layer::Linear>(f, kLinear).weight; }},
      {"layers[14].bias",
       [](Fields& f) -> std::vector<float>& { return kindOf<layer::Linear>(f, 14).bias; }},
      {"layers[10].weight",
       [](Fields& f) -> std::vector<float>& {
         return kindOf<layer::LayerNorm>(f, kLayerNorm).weight;
       }},
      {"layers[10].bias",
       [](Fields& f) -> std::vector<float>& {
         return kindOf<layer::LayerNorm>(f, kLayerNorm).bias;
       }},
      {"layers[11].mean",
       [](Fields& f) -> std::vector<float>& {
         return kindOf<layer::Normalize>(f, kNormalize).mean;
       }},
      {"layers[11].inverse_deviation",
       [](Fields& f) -> std::vector<float>& {
         return kindOf<layer::Normalize>(f, kNormalize).inverse_deviation;
       }},
      {"layers[13].input_weight",
       [](Fields& f) -> std::vector<float>& { return kindOf<layer::Gru>(f, kGru).input_weight; }},
      {"layers[13].state_weight",
       [](Fields& f) -> std::vector<float>& { return kindOf<layer::Gru>(f, kGru).state_weight; }},
      {"layers[13].input_bias",
       [](Fields& f) -> std::vector<float>& { return kindOf<layer::Gru>(f, kGru).input_bias; }},
      {"layers[13].state_bias",
       [](Fields& f) -> std::vector<float>& { return kindOf<layer::Gru>(f, kGru).state_bias; }}};
  for (const Weights& weights : all) {
    Fields fields;
    const std::size_t size = weights.of(fields).size();
    ASSERT_GE(size, 2U);
    expectRefused<Fields>(
        Fields{},
        {{"policy." + weights.field, fmt::format("has {} elements, expected {}", size - 1, size),
          [&](Fields& f) { weights.of(f).pop_back(); }},
         {fmt::format("policy.{}[{}]", weights.field, size - 1), "is not finite, expected a number",
          [&](Fields& f) { weights.of(f).back() = kInfinity; }},
         {fmt::format("policy.{}[1]", weights.field), "is not finite, expected a number",
          [&](Fields& f) { weights.of(f)[1] = kNan; }}});
  }
}

TEST(PolicyPack, IsRefusedWithWrongActions) {
  expectRefused<Fields>(
      Fields{},
      {{"policy.discrete",
        "is empty, and there is no continuous action, expected an action at least",
        [](Fields& f) {
          f.content.continuous.reset();
          f.content.discrete.clear();
          f.content.layers.resize(1);
        }},
       {"policy.layers[13].input_weight", "has 108 elements, expected 117",
        [](Fields& f) { ++f.content.continuous->count; }},
       {"policy.layers[1]", "reads 4294967296 previous actions, expected 1 to 16777216",
        [](Fields& f) { f.content.continuous->count = 4294967295U; }},
       {"policy.continuous.mean", "leads to 3 x 1 x 1 elements, expected a vector of 2",
        [](Fields& f) { f.content.continuous->mean = kGru; }},
       {"policy.continuous.mean", "leads to 4 x 4 x 6 elements, expected a vector of 2",
        [](Fields& f) { f.content.continuous->mean = kImage; }},
       {"policy.continuous.log_deviation", "is 20, expected one of 20 layers",
        [](Fields& f) { f.content.continuous->log_deviation = 20; }},
       {"policy.discrete[0].logits", "leads to 3 x 1 x 1 elements, expected a vector of 2",
        [](Fields& f) { f.content.discrete[0].logits = kGru; }},
       {"policy.discrete[0].values", "has 1 elements, expected 2 or more",
        [](Fields& f) { f.content.discrete[0].values = {1}; }},
       {"policy.discrete[0].values", "holds nan, expected finite numbers",
        [](Fields& f) { f.content.discrete[0].values[1] = kNan; }}});
}

TEST(PolicyPack, IsRefusedWhenItWouldRunForEver) {
  // A pool over everything, again and again: few weights, few values, much to do.
  Fields fields;
  fields.content.layers.resize(3);
  for (std::uint32_t n = 0; n < 40; ++n) {
    fields.content.layers.push_back(
        {{2 + n}, layer::AveragePool{.kernel = 511, .stride = 1, .padding = 255}});
  }
  fields.content.interface.image->width = 300;
  fields.content.interface.image->height = 300;
  const AlignedBytes bytes = buildPack(fields);
  const auto pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_FALSE(pack.has_value());
  EXPECT_EQ(pack.error().where, "made.pack: policy.layers[3]");
  EXPECT_THAT(pack.error().message,
              testing::HasSubstr("brings the multiplications to 94003560000, expected at most "
                                 "8589934592; bake the pack again"));
}

TEST(DamagedPolicyPack, IsRefusedAtEachLengthOfATruncation) {
  expectEachTruncationRefused(buildPack(Fields{}));
}

TEST(DamagedPolicyPack, IsRefusedWithBytesTooMany) {
  expectBytesTooManyRefused(buildPack(Fields{}));
}

TEST(DamagedPolicyPack, IsRefusedAfterEachFlipOfASingleBit) {
  expectEachBitFlipRefused(buildPack(Fields{}));
}

TEST(DamagedPolicyPack, WithARecomputedHashIsRefusedOrRunsAfterEachFlip) {
  expectFlipsWithARightHashRefusedOrUsable(buildPack(Fields{}), PackKind::kPolicy,
                                           [](const PackFile& pack) { actTwice(pack); });
}

}  // namespace
}  // namespace galactic::test::policy_check_test
