// galactic-bake X.episode_set.json as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/bake_folder.h"
#include "galactic/episode_set.h"
#include "galactic/pack.h"
#include "galactic/schema/pack_generated.h"
#include "support/episode_set_text.h"
#include "support/gzip_text.h"
#include "support/habitat_text.h"
#include "support/mesh_files.h"

namespace galactic::episode_cli_test {
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
    EXPECT_TRUE(pack) << pack.error().text();
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
  EXPECT_THAT(names.options, ElementsAre("as=episodes", "start-joints=pan,lift", "targets=first"));
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
                          "start-joints=pan,lift", "object-up=y", "targets=first"));
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

TEST_F(EpisodeCli, ImportsDatasetsOfHabitat) {
  write("rearrange.json.gz", test::gzipped(test::kSmallHabitatSet));
  const ProgramRun packed = run({"rearrange.json.gz"});
  EXPECT_EQ(packed.exit_code, 0) << packed.err;
  EXPECT_THAT(packed.out, AllOf(HasSubstr("rearrange: 2 episodes; 2 scenes, 2 objects"),
                                HasSubstr("warning: 1 of 2 episodes have several targets"),
                                HasSubstr("warning: 1 of 2 episodes give no start and cannot be "
                                          "played, as the robot stands at the origin: give the "
                                          "packs of their scenes, of their objects and of the "
                                          "robot, too, and starts are drawn")));
  EXPECT_EQ(namesIn("rearrange.pack").episodes, 2U);
  write("plain.json", test::kSmallHabitatSet);
  const ProgramRun plain = run({"plain.json", "--as", "episodes", "--targets", "each",
                                "--scene-name", "v3_sc0_staging_00=flat"});
  EXPECT_EQ(plain.exit_code, 0) << plain.err;
  const Names names = namesIn("plain.pack");
  EXPECT_EQ(names.episodes, 3U);
  EXPECT_THAT(names.scenes, ElementsAre("flat", "v3_sc1_staging_05"));
  EXPECT_THAT(names.options, testing::Contains("targets=each"));
}

TEST_F(EpisodeCli, TakesTheCentersOfHabitatsObjectsFromTheirPack) {
  // A tetrahedron of 10 and 20 cm whose origin is at a corner.
  const std::string box =
      "v 0 0 0\nv 0.1 0 0\nv 0 0.2 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  write("mug.obj", box);
  write("003_cracker_box.obj", box);
  const ProgramRun objects = run({"mug.obj", "003_cracker_box.obj", "--as", "object", "--up", "y",
                                  "-q", "-o", "objects.pack"});
  ASSERT_EQ(objects.exit_code, 0) << objects.err;
  write("plain.json", test::kSmallHabitatSet);
  const ProgramRun import =
      run({"plain.json", "--as", "episodes", "--object-pack", "objects.pack"});
  EXPECT_EQ(import.exit_code, 0) << import.err;
  EXPECT_THAT(import.out, testing::Not(HasSubstr("--object-pack")));
  const auto pack = PackFile::open(path("plain.pack"));
  ASSERT_TRUE(pack.has_value());
  const auto set = EpisodeSet::from(*pack);
  ASSERT_TRUE(set.has_value());
  const Vec3 origin = set->placements(set->episodes()[0])[0].pose.translation;
  EXPECT_FLOAT_EQ(origin.x, 0.45F);
  EXPECT_FLOAT_EQ(origin.y, 0.9F);
  EXPECT_FLOAT_EQ(origin.z, -0.3F);
  EXPECT_THAT(namesIn("plain.pack").sources, ElementsAre("plain.json", "objects.pack"));

  // One pack for each object, as recipes make them; and a world that lists these.
  for (const char* object : {"mug", "003_cracker_box"}) {
    const std::string mesh = std::string(object) + ".obj";
    ASSERT_EQ(run({mesh, "--as", "object", "--up", "y", "-q"}).exit_code, 0);
  }
  write("room.obj", test::objFile(test::unevenBox()));
  ASSERT_EQ(run({"room.obj", "-q"}).exit_code, 0);
  ASSERT_EQ(
      run({"room.pack", "mug.pack", "003_cracker_box.pack", "--as", "world", "-o", "two.pack"})
          .exit_code,
      0);
  const std::vector<std::vector<std::string>> ways{
      {"--object-pack", "mug.pack", "--object-pack", "003_cracker_box.pack"},
      {"--object-pack", "two.pack"}};
  for (const std::vector<std::string>& way : ways) {
    std::vector<std::string> words{"plain.json", "--as", "episodes", "-o", "again.pack"};
    words.insert(words.end(), way.begin(), way.end());
    const ProgramRun again = run(words);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    const auto other_pack = PackFile::open(path("again.pack"));
    ASSERT_TRUE(other_pack.has_value());
    const auto other = EpisodeSet::from(*other_pack);
    ASSERT_TRUE(other.has_value());
    EXPECT_EQ(other->placements(other->episodes()[0])[0].pose.translation, origin);
    EXPECT_THAT(namesIn("again.pack").sources,
                testing::IsSupersetOf({"plain.json", "mug.pack", "003_cracker_box.pack"}));
  }
  const ProgramRun twice = run({"plain.json", "--as", "episodes", "--object-pack", "objects.pack",
                                "--object-pack", "mug.pack"});
  EXPECT_EQ(twice.exit_code, 3);
  EXPECT_THAT(twice.err, HasSubstr("mug.pack: holds the object mug, as another of the object "
                                   "packs does; give one of them"));

  EXPECT_EQ(run({"plain.json", "--as", "episodes", "--object-pack", "plain.pack"}).exit_code, 3);
  EXPECT_EQ(run({"plain.json", "--as", "episodes", "--object-pack", "none.pack"}).exit_code, 2);
}

TEST_F(EpisodeCli, RefusesDamagedArchives) {
  const std::string whole = test::gzipped(test::kSmallHabitatSet);
  write("cut.json.gz", whole.substr(0, whole.size() / 2));
  const ProgramRun cut = run({"cut.json.gz"});
  EXPECT_EQ(cut.exit_code, 3);
  EXPECT_EQ(cut.err,
            "galactic-bake: cut.json.gz: ends in the middle of its gzip data; fetch or make it "
            "again\n");
  EXPECT_FALSE(has("cut.pack"));
}

TEST_F(EpisodeCli, ExplainsEveryRefusal) {
  write("bad.txt", "0\none\n");
  const std::string set = "tidy.episode_set.json";
  const std::vector<Refusal> refusals{
      {{set}, 3, "has 2 positions for 7 start joints; name the joint of each"},
      {{set, "--only", "bad.txt"}, 3, "bad.txt:2: has \"one\", expected indices of episodes"},
      {{set, "--only", "none.txt"}, 2, "none.txt"},
      {{set, "--only", "bad.txt", "-o", "bad.txt"}, 3, "is also an input"},
      {{set, "-o", set}, 3, "is also an input"},
      {{set, "--scene-name", "a_room"}, 1, "--scene-name: is \"a_room\", expected OLD=NEW"},
      {{set, "--scene-name", "a=b", "--scene-name", "a=c"}, 1, "names a twice"},
      {{set, "--object-up", "w"}, 1, "--object-up: is \"w\", expected one of x, y, z"},
      {{set, "--count", "5"}, 1, "--count: does not go with --as episodes of published episodes"},
      {{set, "--seed", "5"},
       1,
       "--seed: is for starts that are drawn in packs; give those of the scenes, the objects and "
       "the robot, too, or leave it out"},
      {{set, "--radii", "0.05"},
       1,
       "--radii: does not go with --as episodes of published episodes; leave it out"},
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
}  // namespace galactic::episode_cli_test
