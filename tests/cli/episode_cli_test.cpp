// galactic-bake X.episode_set.json as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/bake_folder.h"
#include "galactic/episode_set.h"
#include "galactic/pack.h"
#include "galactic/schema/pack_generated.h"
#include "support/episode_set_text.h"

namespace galactic {
namespace {

using nlohmann::json;
using test::ProgramRun;
using test::Refusal;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class EpisodeCli : public test::BakeFolder {
 protected:
  void SetUp() override { write("tidy.episode_set.json", test::kSmallEpisodeSet); }

  [[nodiscard]] ProgramRun bake(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--start-joints", "pan,lift"});
    return run(std::move(arguments));
  }

  /// What the pack says of itself, or a failure of the test.
  struct Names {
    std::string set;
    std::vector<std::string> scenes;
    std::size_t episodes = 0;
    std::vector<std::string> options;
    std::vector<std::string> sources;
  };
  [[nodiscard]] Names namesIn(const std::string& name) const {
    Names names;
    const auto pack = PackFile::open(path(name));
    EXPECT_TRUE(pack) << pack.error().where << ": " << pack.error().message;
    if (!pack) return names;
    const auto set = EpisodeSet::from(*pack);
    EXPECT_TRUE(set);
    names.set = set->name();
    for (const std::string_view scene : set->sceneNames()) names.scenes.emplace_back(scene);
    names.episodes = set->episodes().size();
    const schema::Provenance& provenance = *pack->root().provenance();
    for (const auto* one : *provenance.options()) {
      names.options.push_back(one->name()->str() + "=" + one->value()->str());
    }
    for (const auto* one : *provenance.sources()) names.sources.push_back(one->name()->str());
    return names;
  }
};

TEST_F(EpisodeCli, ImportsASetIntoAPackOfItsName) {
  const ProgramRun run = bake({"tidy.episode_set.json", "-v"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("tidy.episode_set.json -> tidy.pack"),
                    HasSubstr("tidy: 2 episodes; 2 scenes, 2 objects, 4 placements"),
                    HasSubstr("scenes: a_room, b_room"), HasSubstr("start joints: pan, lift")));
  EXPECT_THAT(run.err, IsEmpty());
  const Names names = namesIn("tidy.pack");
  EXPECT_EQ(names.set, "tidy");
  EXPECT_EQ(names.episodes, 2U);
  EXPECT_THAT(names.options, ElementsAre("as=episodes", "start-joints=pan,lift", "object-up=z"));
  EXPECT_THAT(names.sources, ElementsAre("tidy.episode_set.json"));
}

TEST_F(EpisodeCli, TakesAnyNameWithAsEpisodes) {
  write("tidy.json", test::kSmallEpisodeSet);
  const ProgramRun run = bake({"tidy.json", "--as", "episodes", "-o", "made.pack"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(namesIn("made.pack").set, "tidy");
}

TEST_F(EpisodeCli, KeepsAndRenamesWhatItIsToldTo) {
  write("good.txt", "1\n");
  const ProgramRun run = bake({"tidy.episode_set.json", "--only", "good.txt", "--scene-name",
                               "a_room=kitchen", "--object-up", "y"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const Names names = namesIn("tidy.pack");
  EXPECT_EQ(names.episodes, 1U);
  EXPECT_THAT(names.scenes, ElementsAre("kitchen"));
  EXPECT_THAT(names.options,
              ElementsAre("as=episodes", "only=good.txt", "scene-name=a_room=kitchen",
                          "start-joints=pan,lift", "object-up=y"));
  EXPECT_THAT(names.sources, ElementsAre("tidy.episode_set.json", "good.txt"));
}

TEST_F(EpisodeCli, ImportsSeveralSetsIntoAFolder) {
  write("other.episode_set.json", test::kSmallEpisodeSet);
  write("broken.episode_set.json", "{}");
  const ProgramRun run =
      bake({"broken.episode_set.json", "tidy.episode_set.json", "other.episode_set.json", "-o",
            "packs", "--keep-going", "--report", "report.json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_TRUE(has("packs/tidy.pack"));
  EXPECT_TRUE(has("packs/other.pack"));
  EXPECT_FALSE(has("packs/broken.pack"));
  const json report = json::parse(content("report.json"));
  ASSERT_EQ(report["baked"].size(), 2U);
  EXPECT_EQ(report["baked"][0]["name"], "tidy");
  EXPECT_EQ(report["baked"][0]["episodes"], 2);
  EXPECT_EQ(report["baked"][0]["placements"], 4);
  EXPECT_EQ(report["baked"][0]["most_placements"], 2);
  EXPECT_NEAR(report["baked"][0]["target_to_goal"]["min"], 4.1231056, 1e-6);
  ASSERT_EQ(report["failed"].size(), 1U);
  EXPECT_EQ(report["failed"][0]["message"], "it is missing");
}

TEST_F(EpisodeCli, WritesNoPackOnADryRun) {
  const ProgramRun run = bake({"tidy.episode_set.json", "--dry-run"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("(dry run)"));
  EXPECT_FALSE(has("tidy.pack"));
}

TEST_F(EpisodeCli, WarnsOfKeysThatAreNotUsed) {
  std::string text = test::kSmallEpisodeSet;
  text.insert(text.find("\"renderAssets\""), "\"author\": 1, ");
  write("tidy.episode_set.json", text);
  const ProgramRun run = bake({"tidy.episode_set.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("warning: episodeSet.author is not used"));
}

TEST_F(EpisodeCli, ExplainsEveryRefusal) {
  write("bad.txt", "0\none\n");
  const std::string set = "tidy.episode_set.json";
  const std::vector<Refusal> refusals{
      {{set}, 3, "has 2 positions for 7 start joints; name the joint of each"},
      {{set, "--only", "bad.txt"}, 3, "bad.txt:2: has \"one\", indices of episodes are wanted"},
      {{set, "--only", "none.txt"}, 2, "none.txt"},
      {{set, "--only", "bad.txt", "-o", "bad.txt"}, 3, "is also an input"},
      {{set, "-o", set}, 3, "is also an input"},
      {{set, "--scene-name", "a_room"}, 1, "--scene-name: is \"a_room\", OLD=NEW is wanted"},
      {{set, "--scene-name", "a=b", "--scene-name", "a=c"}, 1, "names a twice"},
      {{set, "--object-up", "w"}, 1, "--object-up: is \"w\", one of x, y, z"},
      {{set, "--count", "5"}, 1, "--count: goes with the generation of episodes in packs"},
      {{set, "--seed", "5"}, 1, "--seed: goes with the generation of episodes in packs"},
      {{set, "--radii", "0.05"}, 1, "--radii: does not go with --as episodes; leave it out"},
      {{set, "--up", "z"}, 1, "--up: does not go with --as episodes"},
      {{set, "--recipe", "x"}, 1, "--recipe: does not go with --as episodes"},
      {{set, "--as", "scene", "--only", "bad.txt"}, 1, "--only: does not go with --as scene"},
      {{"none.episode_set.json"}, 2, "none.episode_set.json"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun run_once = run(refusal.arguments);
    EXPECT_EQ(run_once.exit_code, refusal.exit_code);
    EXPECT_THAT(run_once.err, AllOf(StartsWith("galactic-bake: "), HasSubstr(refusal.part)));
    EXPECT_THAT(run_once.out, IsEmpty());
  }
  EXPECT_EQ(content(set), test::kSmallEpisodeSet);
  EXPECT_FALSE(has("tidy.pack"));
}

}  // namespace
}  // namespace galactic
