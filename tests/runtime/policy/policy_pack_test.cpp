// Writing policy packs: the same bytes on any machine, nothing that could not be read.
#include "galactic/policy_pack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "galactic/schema/pack_generated.h"
#include "galactic/world.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/packs/policy_pack_builder.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test::policy_pack_test {
namespace {

std::string textOf(const std::vector<std::byte>& file) {
  return {reinterpret_cast<const char*>(file.data()), file.size()};
}

TEST(GoldenPolicyPack, IsMadeAgainByteForByte) {
  const std::filesystem::path golden = test::sourceFolder() / "packs" / "golden" / "policy.pack";
  const std::vector<std::byte> made = encodePolicyPack(smallPolicy(), smallPolicyProvenance());
  if (std::getenv("GALACTIC_WRITE_GOLDEN") != nullptr) {
    ASSERT_TRUE(writePolicyPack(golden, smallPolicy(), smallPolicyProvenance()).has_value());
  }
  EXPECT_TRUE(textOf(made) == fileContent(golden))
      << "the bytes of a policy changed: if on purpose, see packs/golden/README.md";
}

TEST(PolicyPackWriter, WritesWhatIsReadBack) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "picker.pack";
  const PolicyContent content = smallPolicy();
  const auto written = writePolicyPack(path, content, smallPolicyProvenance());
  ASSERT_TRUE(written.has_value()) << written.error().text();
  const auto pack = PackFile::open(path);
  ASSERT_TRUE(pack.has_value()) << pack.error().message;
  const auto needs = policyInterface(*pack);
  ASSERT_TRUE(needs.has_value());
  EXPECT_EQ(needs->name, "picker");
  EXPECT_EQ(needs->robot, "helper");
  EXPECT_EQ(needs->options, content.interface.options);
  EXPECT_EQ(needs->observation, content.interface.observation);
  ASSERT_TRUE(needs->image.has_value());
  EXPECT_EQ(needs->image->width, 6U);
  EXPECT_EQ(needs->image->height, 4U);
  EXPECT_EQ(needs->image->camera, "head");
  EXPECT_EQ(needs->continuous_actions, 2U);
  EXPECT_EQ(needs->discrete_actions, 1U);
  const schema::Provenance& provenance = *pack->root().provenance();
  EXPECT_EQ(provenance.tool()->str(), "galactic.export");
  EXPECT_EQ(provenance.options()->Get(0)->value()->str(), "state");
  EXPECT_EQ(provenance.sources()->Get(0)->name()->str(), "best.pt");
  EXPECT_EQ(provenance.sources()->Get(0)->bytes(), 12U);
}

TEST(PolicyPackWriter, KeepsWhereTheCameraIs) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "picker.pack";
  const auto imageOf = [&](const PolicyContent& content) {
    EXPECT_TRUE(writePolicyPack(path, content, smallPolicyProvenance()).has_value());
    return *policyInterface(*PackFile::open(path))->image;
  };
  PolicyContent content = smallPolicy();
  EXPECT_EQ(imageOf(content).position, (std::array<float, 3>{}));
  EXPECT_EQ(imageOf(content).rpy_degrees, (std::array<float, 3>{}));
  EXPECT_EQ(imageOf(content).near, 0);
  PolicyImage& image = *content.interface.image;
  image.position = {-0.1F, 0.2F, 33.3F};
  EXPECT_EQ(imageOf(content).position, image.position);
  image.position = {};
  image.rpy_degrees = {0.1F, -20, 359.9F};
  image.near = 0.07F;
  EXPECT_EQ(imageOf(content).position, image.position);
  EXPECT_EQ(imageOf(content).rpy_degrees, image.rpy_degrees);
  EXPECT_EQ(imageOf(content).near, image.near);
}

TEST(PolicyPackWriter, WritesNothingThatWouldBeRefused) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "picker.pack";
  PolicyContent content = smallPolicy();
  content.discrete[0].values.pop_back();
  const auto written = writePolicyPack(path, content, smallPolicyProvenance());
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(written.error().where, path.string() + ": policy.discrete[0].values");
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(PolicyPackWriter, SaysWhereItCannotWrite) {
  const auto written =
      writePolicyPack("/nowhere/picker.pack", smallPolicy(), smallPolicyProvenance());
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().code, ErrorCode::kIo);
}

TEST(PolicyPackAmongOthers, IsNoPartOfAWorld) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "picker.pack";
  ASSERT_TRUE(writePolicyPack(path, smallPolicy(), smallPolicyProvenance()).has_value());
  const std::vector<std::filesystem::path> paths{path};
  const auto world = World::open(paths);
  ASSERT_FALSE(world.has_value());
  EXPECT_EQ(world.error().message,
            "is a policy, which cannot be part of a world; give it with --policy");
}

}  // namespace
}  // namespace galactic::test::policy_pack_test
