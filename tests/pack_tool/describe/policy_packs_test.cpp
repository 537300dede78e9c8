// What info, check and diff tell about policies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "pack_tool/describe/info_text.h"
#include "pack_tool/describe/pack_description.h"
#include "pack_tool/verbs/verbs.h"
#include "support/packs/policy_pack_builder.h"
#include "support/packs/world_pack_builder.h"
#include "support/scratch_folder.h"

namespace galactic::pack_tool::policy_packs_test {
namespace {

using test::PolicyPackFields;
using test::ScratchFolder;
using testing::AllOf;
using testing::HasSubstr;

Json describe(const PolicyPackFields& fields) {
  const auto bytes = test::buildPack(fields);
  const auto pack = PackFile::view(bytes.bytes(), "made.pack");
  if (!pack) {
    ADD_FAILURE() << pack.error().text();
    return {};
  }
  return describePack(*pack);
}

TEST(DescribePolicy, TellsWhatItNeedsAndEachLayer) {
  const Json policy = describe({}).at("policy");
  EXPECT_EQ(policy.at("name"), "picker");
  EXPECT_EQ(policy.at("robot"), "helper");
  EXPECT_EQ(policy.at("options").at(0), Json::parse(R"({"name": "task", "value": "pick"})"));
  EXPECT_EQ(policy.at("observation").at(0), Json::parse(R"({"name": "grip_target", "size": 3})"));
  EXPECT_EQ(policy.at("image").at("camera"), "head");
  EXPECT_EQ(policy.at("image").at("depth_limit"), 10.0);
  ASSERT_EQ(policy.at("layers").size(), 20U);
  EXPECT_EQ(policy.at("layers").at(0), Json::parse(R"({"kind": "Observation", "inputs": []})"));
  const Json& convolution = policy.at("layers").at(4);
  EXPECT_EQ(convolution.at("kind"), "Convolution");
  EXPECT_EQ(convolution.at("inputs"), Json::parse("[3]"));
  EXPECT_EQ(convolution.at("padding"), 1);
  EXPECT_EQ(convolution.at("weight").at("count"), 576);
  EXPECT_EQ(policy.at("layers").at(9).at("bias"), nullptr);
  EXPECT_EQ(policy.at("layers").at(19).at("lower"), -5.0);
  EXPECT_EQ(policy.at("continuous").at("mean"), 16);
  EXPECT_EQ(policy.at("discrete"), Json::parse(R"([{"logits": 17, "values": [0.0, 1.0]}])"));
  // 576 + 4, 4 + 4, 80, 5 + 5, 4 + 4, 9 x 12 + 9 x 3 + 9 + 9, 12 + 4, 2.
  EXPECT_EQ(policy.at("weights"), 857);
}

TEST(InfoText, TellsAPolicyLayerByLayer) {
  const std::string text = infoText(describe({}));
  EXPECT_THAT(text, AllOf(HasSubstr("PLCY, format version 1\n"), HasSubstr("picker\n"),
                          HasSubstr("task pick, episode-steps 300\n"),
                          HasSubstr("grip_target (3), is_holding (1)\n"),
                          HasSubstr("6 x 4, color and depth to 10 m, camera head\n"),
                          HasSubstr("2 continuous, 1 discrete\n")));
  EXPECT_THAT(text, AllOf(HasSubstr("4 Convolution"), HasSubstr("outputs 4, kernel 3, stride 1"),
                          HasSubstr("857\n")));
}

TEST(InfoText, TellsWhereTheCameraOfAPolicyIs) {
  PolicyPackFields fields;
  PolicyImage& image = *fields.content.interface.image;
  image.position = {-0.1F, 0, 0.25F};
  image.near = 0.02F;
  EXPECT_THAT(infoText(describe(fields)),
              HasSubstr("camera head, at -0.1, 0, 0.25 m ahead, left, up, drawn from 0.02 m\n"));
  image = {.width = 6, .height = 4, .rpy_degrees = {0, 25, -90}};
  EXPECT_THAT(infoText(describe(fields)),
              HasSubstr("camera head, turned by 0, 25, -90 degrees of roll, pitch, yaw\n"));
  const Json json = describe(fields).at("policy").at("image");
  EXPECT_EQ(json.at("rpy_degrees"), Json::parse("[0.0, 25.0, -90.0]"));
  EXPECT_EQ(json.at("position"), Json::parse("[0.0, 0.0, 0.0]"));
  EXPECT_EQ(json.at("near"), 0.0);
}

/// galactic-pack diff of two policies, and its exit code.
std::pair<std::string, int> diffAfter(const std::function<void(PolicyContent&)>& change) {
  const ScratchFolder folder;
  PolicyPackFields fields;
  const auto a = folder.write("a.pack", test::textOf(test::buildPack(fields)));
  change(fields.content);
  const auto b = folder.write("b.pack", test::textOf(test::buildPack(fields)));
  std::ostringstream out;
  std::ostringstream err;
  DiffOptions options;
  options.a = a;
  options.b = b;
  const int code = runDiff(options, Console{out, err});
  EXPECT_EQ(err.str(), "");
  return {out.str(), code};
}

TEST(DiffOfPolicies, FindsWeightsSizesAndOptions) {
  EXPECT_EQ(diffAfter([](PolicyContent&) {}).second, kExitOk);
  const auto weight = diffAfter([](PolicyContent& content) {
    std::get<layer::Linear>(content.layers[9].kind).weight[3] += 1;
  });
  EXPECT_EQ(weight.second, kExitDiffers);
  EXPECT_THAT(weight.first, HasSubstr("layers.9.weight.hash"));
  const auto option =
      diffAfter([](PolicyContent& content) { content.interface.options[1].value = "400"; });
  EXPECT_EQ(option.second, kExitDiffers);
  const auto camera =
      diffAfter([](PolicyContent& content) { content.interface.image->position[2] = 0.5F; });
  EXPECT_EQ(camera.second, kExitDiffers);
  EXPECT_THAT(camera.first, HasSubstr("image.position.2"));
  EXPECT_THAT(option.first, AllOf(HasSubstr("episode-steps"), HasSubstr("300"), HasSubstr("400")));
}

TEST(DiffOfPolicies, FindsPartsOfTheObservationInAnotherOrder) {
  const auto order = diffAfter([](PolicyContent& content) {
    auto& parts = content.interface.observation;
    std::rotate(parts.begin(), parts.begin() + 1, parts.end());
  });
  EXPECT_EQ(order.second, kExitDiffers);
  EXPECT_THAT(order.first, HasSubstr("observation.order: grip_target, is_holding | "
                                     "is_holding, grip_target\n"));
}

TEST(CheckOfPolicies, SaysOkAndWhatIsWrong) {
  const ScratchFolder folder;
  const auto good = folder.write("good.pack", test::textOf(test::buildPack(PolicyPackFields{})));
  PolicyPackFields fields;
  fields.content.discrete[0].logits = 99;
  const auto bad = folder.write("bad.pack", test::textOf(test::buildPack(fields)));
  const auto check = [](const std::filesystem::path& path) {
    std::ostringstream out;
    std::ostringstream err;
    CheckOptions options;
    options.packs = {path};
    const int code = runCheck(options, Console{out, err});
    return std::pair(out.str() + err.str(), code);
  };
  EXPECT_EQ(check(good).second, kExitOk);
  const auto refused = check(bad);
  EXPECT_EQ(refused.second, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_THAT(refused.first,
              HasSubstr("policy.discrete[0].logits: is 99, expected one of 20 layers"));
}

}  // namespace
}  // namespace galactic::pack_tool::policy_packs_test
