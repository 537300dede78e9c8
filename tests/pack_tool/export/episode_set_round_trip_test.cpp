// Episodes exported as a published episode set and imported again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/packs.h"
#include "pack_tool/export/episode_set_text.h"
#include "pack_tool/verbs/verbs.h"
#include "support/asset_mesh.h"
#include "support/pack_tool_fixture.h"
#include "support/packs/pack_parts.h"

namespace galactic::pack_tool::episode_set_round_trip_test {
namespace {

using bake::EpisodeImportOptions;
using bake::SourceEpisodes;
using bake::UpAxis;
using test::ScratchFolder;

constexpr unsigned kSeed = 20230618;
constexpr std::array kAxes{FileUp::kX,      FileUp::kY,      FileUp::kZ,
                           FileUp::kMinusX, FileUp::kMinusY, FileUp::kMinusZ};

/// The payload of a pack, the same for the same episodes.
std::vector<std::byte> payloadOf(const SourceEpisodes& episodes) {
  bake::Provenance provenance;
  provenance.tool_version = "0.1.0";
  auto payload = encodeEpisodePack(episodes, provenance);
  EXPECT_TRUE(payload.has_value()) << payload.error().text();
  return payload.value_or(std::vector<std::byte>{});
}

/// What the tool writes of episodes.
std::string exported(const SourceEpisodes& episodes, FileUp up) {
  const auto file = test::packFile(PackKind::kEpisodes, payloadOf(episodes));
  const auto pack = PackFile::view(file.bytes(), "made.pack");
  EXPECT_TRUE(pack.has_value()) << pack.error().message;
  return episodeSetText(*EpisodeSet::from(*pack), up);
}

SourceEpisodes imported(const std::string& text, const EpisodeImportOptions& options) {
  const ScratchFolder folder;
  auto set = bake::readEpisodeSet(folder.write("set.episode_set.json", text), options);
  EXPECT_TRUE(set.has_value()) << set.error().text();
  return set.value_or(SourceEpisodes{});
}

/// An episode with one placement of its own, the `n`th.
Episode ownEpisode(std::uint32_t n) {
  Episode episode;
  episode.first_placement = n;
  episode.placement_count = 1;
  return episode;
}

/// Numbers for random episodes: of any size, and often nearly 0.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}

  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967295.0);
  }
  std::array<double, 4> rotation() {
    std::array<double, 4> q{};
    for (double& part : q) part = between(-1, 1);
    // What comes of matrices in floats: parts that should be 0.
    if (below(2) == 0) {
      q[below(4)] *= std::pow(10.0, -between(6, 14));
      ++tiny_;
    } else {
      ++usual_;
    }
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    for (double& part : q) part /= length;
    return q;
  }
  [[nodiscard]] double shareOfTiny() const {
    return static_cast<double>(tiny_) / static_cast<double>(tiny_ + usual_);
  }

 private:
  std::mt19937 random_;
  std::size_t tiny_ = 0;
  std::size_t usual_ = 0;
};

/// An episode set as strangers write it, with many digits.
std::string randomSet(Numbers& numbers) {
  using nlohmann::json;
  json set{{"renderAssets", {{{"name", "b"}}, {{"name", "a \"quoted\" mug"}}}},
           {"staticScenes",
            {{{"name", "z"}},
             {{"name",
               "k\xc3\xbc"
               "che"}}}},
           {"freeObjects", {{{"renderAssetIndex", 0}}, {{"renderAssetIndex", 1}}}}};
  const auto place = [&numbers] {
    return json{numbers.between(-9, 9), numbers.between(-2, 2), numbers.between(-9, 9)};
  };
  constexpr std::size_t kEpisodes = 20;
  for (std::size_t n = 0; n < kEpisodes; ++n) {
    const std::size_t first = n * 3;
    for (std::size_t spawn = 0; spawn < 3; ++spawn) {
      set["freeObjectSpawns"].push_back({{"freeObjIndex", numbers.below(2)},
                                         {"startRotation", numbers.rotation()},
                                         {"startPos", place()}});
    }
    set["episodes"].push_back({{"staticSceneIndex", numbers.below(2)},
                               {"numFreeObjectSpawns", 3},
                               {"targetObjIndex", numbers.below(3)},
                               {"firstFreeObjectSpawnIndex", first},
                               {"agentStartPos", {numbers.between(-9, 9), numbers.between(-9, 9)}},
                               {"agentStartYaw", numbers.between(-4, 4)},
                               {"robotStartJointPositions", {numbers.between(-4, 4)}},
                               {"targetObjGoalPos", place()},
                               {"targetObjGoalRotation", numbers.rotation()}});
  }
  return json{{"episodeSet", set}}.dump();
}

TEST(EpisodeSetExport, ComesBackToTheSameBytesInEveryFrame) {
  Numbers numbers(kSeed);
  for (int round = 0; round < 30; ++round) {
    const FileUp up = kAxes[static_cast<std::size_t>(round) % kAxes.size()];
    SCOPED_TRACE(static_cast<int>(up));
    EpisodeImportOptions options;
    options.object_up = static_cast<UpAxis>(up);
    options.start_joints = {"lift"};
    const SourceEpisodes once = imported(randomSet(numbers), options);
    const std::string text = exported(once, up);
    const SourceEpisodes twice = imported(text, options);
    EXPECT_EQ(payloadOf(once), payloadOf(twice));
    EXPECT_EQ(exported(twice, up), text);
  }
  EXPECT_GT(numbers.shareOfTiny(), 0.1);
  EXPECT_LT(numbers.shareOfTiny(), 0.9);
}

TEST(EpisodeSetExport, WritesEveryFloatSoThatItReadsBack) {
  std::mt19937 random(kSeed);
  SourceEpisodes set;
  set.name = "set";
  set.scenes = {"s"};
  set.objects = {"o"};
  set.start_joints = {"j"};
  constexpr std::uint32_t kCases = 5000;
  for (std::uint32_t n = 0; n < kCases; ++n) {
    float value = 0;
    do {
      const auto bits = static_cast<std::uint32_t>(random());
      std::memcpy(&value, &bits, sizeof(value));
    } while (!std::isfinite(value) || std::abs(value) > 1e6F);
    set.start_positions.push_back(value);
    set.placements.push_back({0, {}});
    set.episodes.push_back(ownEpisode(n));
    set.episodes.back().base_yaw = -value;
    set.episodes.back().base_position.y = 0x1p-11F * value;
  }
  EpisodeImportOptions options;
  options.start_joints = set.start_joints;
  const SourceEpisodes again = imported(exported(set, FileUp::kY), options);
  EXPECT_EQ(again.start_positions, set.start_positions);
  for (std::size_t n = 0; n < kCases; ++n) {
    ASSERT_EQ(again.episodes[n].base_yaw, set.episodes[n].base_yaw);
    ASSERT_EQ(again.episodes[n].base_position.y, set.episodes[n].base_position.y);
  }
}

/// Settled objects that stand nearly upright have parts of any size.
TEST(EpisodeSetExport, OfNearlyUprightObjectsComesBackBitByBitInEveryFrame) {
  std::mt19937 random(kSeed);
  SourceEpisodes set;
  set.name = "set";
  set.scenes = {"s"};
  set.objects = {"o"};
  constexpr std::array kSizes{1e-3F, 1e-5F,  6.1682526e-6F, 1e-6F,  3e-8F, 1e-8F,
                              1e-9F, 1e-12F, 1e-15F,        1e-30F, 1e-40F};
  std::uniform_real_distribution<float> share(-1, 1);
  std::uniform_real_distribution<float> turn(-3.15F, 3.15F);
  for (std::uint32_t n = 0; n < 1100; ++n) {
    const float size = kSizes[n % kSizes.size()];
    const float half = n % 3 == 0 ? 0 : turn(random) / 2;
    const Pose pose{{size, -size, 1},
                    {size * share(random), std::sin(half), size * share(random), std::cos(half)}};
    set.placements.push_back({0, pose});
    set.episodes.push_back(ownEpisode(n));
    set.episodes.back().goal = pose;
    std::swap(set.episodes.back().goal.rotation.y, set.episodes.back().goal.rotation.x);
  }
  for (const FileUp up : kAxes) {
    SCOPED_TRACE(static_cast<int>(up));
    EpisodeImportOptions options;
    options.object_up = static_cast<UpAxis>(up);
    EXPECT_EQ(payloadOf(set), payloadOf(imported(exported(set, up), options)));
  }
}

/// As the generator makes them: of a robot, with other joints than Fetch's arm or none, on floors
/// at any height.
TEST(EpisodeSetExport, OfGeneratedEpisodesComesBackWithoutAnyOption) {
  for (const std::size_t joints : {0U, 2U}) {
    SourceEpisodes set;
    set.name = "set";
    set.robot = "porter";
    set.scenes = {"home"};
    set.objects = {"mug"};
    for (std::size_t n = 0; n < joints; ++n) set.start_joints.push_back(fmt::format("joint {}", n));
    for (std::uint32_t n = 0; n < 5; ++n) {
      set.placements.push_back({0, {{0.1F * static_cast<float>(n), 0.7F, 1}, {}}});
      set.episodes.push_back(ownEpisode(n));
      set.episodes.back().base_position = {1, 0.01F * static_cast<float>(n), -2};
      for (std::size_t joint = 0; joint < joints; ++joint) set.start_positions.push_back(0.3F);
    }
    const SourceEpisodes again = imported(exported(set, FileUp::kZ), {});
    EXPECT_TRUE(again.warnings.empty());
    EXPECT_EQ(payloadOf(set), payloadOf(again));
  }
}

TEST(EpisodeSetExport, NamesItsJointsAgainstTheCommandLine) {
  SourceEpisodes set;
  set.name = "set";
  set.scenes = {"s"};
  set.objects = {"o"};
  set.start_joints = {"lift"};
  set.start_positions = {0};
  set.placements = {{0, {}}};
  set.episodes = {ownEpisode(0)};
  EpisodeImportOptions options;
  options.start_joints = {"elbow"};
  const ScratchFolder folder;
  const auto file = folder.write("x.episode_set.json", exported(set, FileUp::kZ));
  const auto refused = bake::readEpisodeSet(file, options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message,
              testing::HasSubstr("names the start joints lift, and `start-joints` is elbow"));
  set.start_joints.clear();
  set.start_positions.clear();
  const auto none = folder.write("none.episode_set.json", exported(set, FileUp::kZ));
  const auto without = bake::readEpisodeSet(none, options);
  ASSERT_FALSE(without.has_value());
  EXPECT_THAT(without.error().message,
              testing::HasSubstr("names no start joints, and `start-joints` is elbow; leave"));
}

TEST(EpisodeSetExport, HasTheKeysOfThePublishedFiles) {
  Numbers numbers(kSeed);
  EpisodeImportOptions options;
  options.start_joints = {"lift"};
  const auto root =
      nlohmann::json::parse(exported(imported(randomSet(numbers), options), FileUp::kZ));
  const auto& set = root.at("episodeSet");
  EXPECT_EQ(set.size(), 6U) << "those of published files, and startJoints";
  EXPECT_EQ(set.at("startJoints"), nlohmann::json{"lift"});
  const auto& scene = set.at("staticScenes").at(0);
  EXPECT_EQ(scene.at("name"),
            "k\xc3\xbc"
            "che");
  EXPECT_EQ(scene.at("columnGridSetName"), scene.at("name"));
  const std::size_t asset = scene.at("renderAssetInstances").at(0).at("renderAssetIndex");
  EXPECT_EQ(set.at("renderAssets").at(asset).at("name"), scene.at("name"));
  EXPECT_EQ(set.at("freeObjects").at(0).at("startRotations").size(), 0U);
  EXPECT_EQ(set.at("episodes").at(0).size(), 9U);
}

/// The verb in a folder with a pack of two episodes.
class EpisodeSetVerb : public testing::Test {
 protected:
  void SetUp() override {
    SourceEpisodes set;
    set.name = "tidy";
    set.scenes = {"s"};
    set.objects = {"o"};
    set.placements = {{0, {}}, {0, {}}};
    set.episodes = {ownEpisode(0), ownEpisode(1)};
    set.episodes[1].base_position.y = 0.5F;
    const auto file = test::packFile(PackKind::kEpisodes, payloadOf(set));
    pack_ = folder_.write("tidy.pack", test::asText(file.bytes()));
  }
  int run(ExportOptions options) {
    options.pack = pack_;
    out_.str("");
    err_.str("");
    return runExport(options, {out_, err_});
  }

  ScratchFolder folder_;
  std::filesystem::path pack_;
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(EpisodeSetVerb, KnowsTheFormatByTheNameOfTheOutput) {
  EXPECT_EQ(run({.output = folder_.path() / "x.episode_set.json"}), kExitOk);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "x.episode_set.json"));
  EXPECT_EQ(run({.output = folder_.path() / "x.json"}), static_cast<int>(ErrorCode::kUnsupported));
  EXPECT_THAT(err_.str(), testing::HasSubstr(".episode_set.json, or choose one with --to"));
}

TEST_F(EpisodeSetVerb, RefusesWhatDoesNotGoTogether) {
  EXPECT_EQ(exportFault({.output = folder_.path() / "x.glb", .object_up = FileUp::kY}),
            "--object-up is for episode sets; leave it out");
  EXPECT_EQ(run({.output = folder_.path() / "x.ply"}), static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_THAT(err_.str(), testing::HasSubstr("export it --to episode_set"));
  const auto scene = test::writePack(folder_, "scene.pack", test::kitchenScene());
  EXPECT_EQ(
      runExport({.pack = scene, .output = folder_.path() / "x.episode_set.json"}, {out_, err_}),
      static_cast<int>(ErrorCode::kInvalidInput));
}

class PublishedSets : public testing::TestWithParam<const char*> {};

TEST_P(PublishedSets, SurviveTheRoundTrip) {
  if (!test::hasAsset(GetParam())) GTEST_SKIP() << "no asset " << GetParam();
  for (const FileUp up : kAxes) {
    EpisodeImportOptions options;
    options.object_up = static_cast<UpAxis>(up);
    auto once = bake::readEpisodeSet(test::assetsFolder() / GetParam(), options);
    ASSERT_TRUE(once.has_value()) << once.error().message;
    once->name = "set";
    const SourceEpisodes twice = imported(exported(*once, up), options);
    EXPECT_EQ(payloadOf(*once), payloadOf(twice));
  }
}

INSTANTIATE_TEST_SUITE_P(All, PublishedSets,
                         testing::Values("galactic/data/tidy_house_100ep.episode_set.json",
                                         "galactic/data/tidy_house_10ep.episode_set.json",
                                         "published_physics/episodes.episode_set.json"),
                         [](const auto& file) { return "Number" + std::to_string(file.index); });

}  // namespace
}  // namespace galactic::pack_tool::episode_set_round_trip_test
