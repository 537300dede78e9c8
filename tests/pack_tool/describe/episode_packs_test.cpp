// What info, check and diff tell about episodes and worlds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "pack_tool/describe/info_text.h"
#include "pack_tool/describe/pack_description.h"
#include "pack_tool/verbs/verbs.h"
#include "support/packs/world_pack_builder.h"

namespace galactic::pack_tool::episode_packs_test {
namespace {

using test::EpisodePackFields;
using test::ScratchFolder;
using test::WorldFields;
using test::WorldPackFields;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

template <class Fields>
Json describe(const Fields& fields, Detail detail = Detail::kEverything) {
  const auto bytes = test::buildPack(fields);
  const auto pack = PackFile::view(bytes.bytes(), "made.pack");
  if (!pack) {
    ADD_FAILURE() << pack.error().text();
    return {};
  }
  return describePack(*pack, detail);
}

TEST(DescribeEpisodes, TellsNumbersAndEachEpisode) {
  const Json set = describe(test::smallEpisodes()).at("episode_set");
  EXPECT_EQ(set.at("name"), "tidy");
  EXPECT_EQ(set.at("robot"), "helper");
  EXPECT_EQ(set.at("start_joints"), Json::parse(R"(["elbow", "lift"])"));
  EXPECT_EQ(set.at("episode_count"), 2);
  EXPECT_EQ(set.at("objects_per_episode"), Json::parse(R"({"min": 1.0, "mean": 2.0, "max": 3.0})"));
  EXPECT_EQ(set.at("scenes"), Json::parse(R"([{"name": "kitchen", "episodes": 2}])"));
  EXPECT_EQ(set.at("objects").at(1),
            Json::parse(R"({"name": "mug", "placements": 2, "targets": 1})"));
  const Json& episode = set.at("episodes").at(0);
  EXPECT_EQ(episode.at("base_position"), Json::parse("[0.5, 1.0, 0.25]"));
  EXPECT_EQ(episode.at("start_positions"), Json::parse("[0.5, 0.125]"));
  EXPECT_EQ(episode.at("placements").at(1).at("object"), "mug");
  EXPECT_EQ(episode.at("placements").at(1).at("rotation_wxyz"),
            Json::parse("[0.8, 0.0, 0.6, 0.0]"));
  EXPECT_EQ(episode.at("target"), 1);
  EXPECT_EQ(episode.at("goal").at("translation"), Json::parse("[2.5, 1.25, 1.5]"));
}

TEST(DescribeEpisodes, LeavesTheListOutOfASummary) {
  const Json set = describe(test::smallEpisodes(), Detail::kSummary).at("episode_set");
  EXPECT_FALSE(set.contains("episodes"));
  EXPECT_EQ(set.at("episode_count"), 2);
}

TEST(InfoText, SummarizesEpisodes) {
  const std::string text = infoText(describe(test::smallEpisodes(), Detail::kSummary));
  EXPECT_THAT(text, HasSubstr("  kind         EPIS, format version 1\n"));
  EXPECT_THAT(text, HasSubstr("  name         tidy\n  episodes     2\n  robot        helper\n"
                              "  start joints elbow, lift\n"
                              "  objects      1 to 3 per episode, 2 on average\n"));
  EXPECT_THAT(text, HasSubstr("    kitchen         2\n"));
  EXPECT_THAT(text, HasSubstr("    bowl         2          1\n    mug          2          1\n"));
}

TEST(InfoText, ListsThePacksOfAWorld) {
  const Json json = describe(test::smallWorldPack());
  EXPECT_EQ(json.at("world").at("packs").at(2),
            Json::parse(R"({"path": "robots/helper.pack", "kind": "RBOT", "bytes": 1000,
                            "xxh3_128": "00000000000000020000000000000001"})"));
  const std::string text = infoText(json);
  EXPECT_THAT(text, HasSubstr("  packs        4\n"));
  EXPECT_THAT(text, HasSubstr("    robots/helper.pack   RBOT  1,000  "
                              "00000000000000020000000000000001\n"));
}

TEST(InfoText, TellsTheTaskOfAWorld) {
  EXPECT_THAT(infoText(describe(test::smallWorldPack())),
              HasSubstr("  task         as galactic-run has it\n"));
  WorldPackFields fields = test::smallWorldPack();
  fields.task = test::TaskTexts{{"episode-steps", "300"}, {"safe-drop", "true"}};
  const Json json = describe(fields);
  EXPECT_EQ(json.at("world").at("task"), Json::parse(R"([{"name": "episode-steps", "value": "300"},
                            {"name": "safe-drop", "value": "true"}])"));
  EXPECT_THAT(infoText(json), HasSubstr("  task         episode-steps 300, safe-drop true\n"));
}

struct Outcome {
  int exit_code = 0;
  std::string out;
  std::string err;
};

Outcome checked(const std::filesystem::path& path, OutputForm form = OutputForm::kText) {
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code = runCheck({.packs = {path}, .form = form}, Console{out, err});
  return {exit_code, out.str(), err.str()};
}

TEST(CheckWorld, SaysOkOfEachListedPackAndOfTheWorld) {
  const ScratchFolder folder;
  const auto path = test::writeWorld(folder, WorldFields{});
  const Outcome outcome = checked(path);
  EXPECT_EQ(outcome.exit_code, kExitOk) << outcome.err;
  const std::string in = folder.path().string() + "/";
  EXPECT_EQ(outcome.out, in + "episodes.pack: ok\n" + in + "objects.pack: ok\n" + in +
                             "robots/helper.pack: ok\n" + in + "scenes/kitchen.pack: ok\n" + in +
                             "world.pack: ok\n");
  const Json report = Json::parse(checked(path, OutputForm::kJson).out);
  EXPECT_EQ(report.at(0).at("ok"), true);
  ASSERT_EQ(report.at(0).at("packs").size(), 4U);
  EXPECT_EQ(report.at(0).at("packs").at(2).at("kind"), "RBOT");
}

TEST(CheckWorld, TellsEachListedPackThatIsBad) {
  const ScratchFolder folder;
  const auto path = test::writeWorld(folder, WorldFields{});
  std::filesystem::remove(folder.path() / "objects.pack");
  std::filesystem::resize_file(folder.path() / "robots/helper.pack", 100);
  const Outcome outcome = checked(path);
  EXPECT_EQ(outcome.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("episodes.pack: ok\n"), HasSubstr("kitchen.pack: ok\n"),
                                 Not(HasSubstr("world.pack: ok"))));
  EXPECT_THAT(
      outcome.err,
      AllOf(HasSubstr("objects.pack, which is missing"), HasSubstr("helper.pack: announces"),
            HasSubstr("lists 4 packs, 2 of them bad; see above [world/bad-pack]\n")));
  const Json report = Json::parse(checked(path, OutputForm::kJson).out);
  EXPECT_EQ(report.at(0).at("ok"), false);
  EXPECT_EQ(report.at(0).at("packs").at(0).at("ok"), true);
  EXPECT_EQ(report.at(0).at("packs").at(1).at("ok"), false);
}

TEST(CheckWorld, TellsWhenGoodPacksDoNotFitTogether) {
  const ScratchFolder folder;
  WorldFields fields;
  fields.episodes.objects[1] = "pan";
  const Outcome outcome = checked(test::writeWorld(folder, fields));
  EXPECT_EQ(outcome.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_THAT(outcome.out, HasSubstr("objects.pack: ok\n"));
  EXPECT_THAT(outcome.err, HasSubstr("episode_set.objects[1]: is \"pan\", which the world, "));
}

template <class Fields>
Outcome diffOf(const Fields& a, const Fields& b, DiffOptions options = {}) {
  const ScratchFolder folder;
  options.a = folder.write("a.pack", test::textOf(test::buildPack(a)));
  options.b = folder.write("b.pack", test::textOf(test::buildPack(b)));
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code = runDiff(options, Console{out, err});
  return {exit_code, out.str(), err.str()};
}

Outcome episodeDiff(const std::function<void(EpisodePackFields&)>& change,
                    const DiffOptions& options = {}) {
  EpisodePackFields changed = test::smallEpisodes();
  change(changed);
  return diffOf(test::smallEpisodes(), changed, options);
}

TEST(EpisodeDiff, CallsTheSamePacksIdentical) {
  EXPECT_EQ(episodeDiff([](EpisodePackFields&) {}).exit_code, kExitOk);
  EXPECT_EQ(diffOf(test::smallWorldPack(), test::smallWorldPack()).exit_code, kExitOk);
}

TEST(EpisodeDiff, TellsEachFieldOfAnEpisodeThatDiffers) {
  const auto differs = [](const std::function<void(EpisodePackFields&)>& change,
                          const std::string& line) {
    const Outcome outcome = episodeDiff(change);
    EXPECT_EQ(outcome.exit_code, kExitDiffers) << line;
    EXPECT_THAT(outcome.out, HasSubstr("content (A | B)\n  " + line + "\n"));
  };
  differs([](EpisodePackFields& f) { f.name = "neat"; }, "name: tidy | neat");
  differs([](EpisodePackFields& f) { f.robot.clear(); }, "robot: helper | null");
  differs([](EpisodePackFields& f) { f.episodes[1].base_yaw = 1; }, "episodes.1.base_yaw: -3 | 1");
  differs([](EpisodePackFields& f) { f.episodes[0].base_position.x = 1; },
          "episodes.0.base_position: 0.5, 1, 0.25 | 1, 1, 0.25");
  differs([](EpisodePackFields& f) { f.start_positions[2] = 0; },
          "episodes.1.start_positions: -0.5, 0.25 | 0, 0.25");
  differs([](EpisodePackFields& f) { f.episodes[0].target = 2; }, "episodes.0.target: 1 | 2");
  differs([](EpisodePackFields& f) { f.placements[0].object = 1; },
          "episodes.0.placements: bowl, mug, mug | mug, mug, mug");
  differs([](EpisodePackFields& f) { f.placements[1].pose.translation.y = 1.5F; },
          "episodes.0.placements: 3 objects | 3 objects, 1 differs: up to 0.5 m away");
  differs(
      [](EpisodePackFields& f) {
        Quat& q = f.placements[1].pose.rotation;
        q = q * Quat{std::sin(0.1F), 0, 0, std::cos(0.1F)};
      },
      "episodes.0.placements: 3 objects | 3 objects, 1 differs: turned by up to 11.5 degrees");
  differs(
      [](EpisodePackFields& f) {
        f.placements[0].pose.translation.x += 0.25F;
        Quat& q = f.placements[2].pose.rotation;
        q = q * Quat{0, 4e-8F, 0, 1};
      },
      "episodes.0.placements: 3 objects | 3 objects, 2 differ: up to 0.25 m away and turned by up "
      "to 4.58e-06 degrees");
  differs([](EpisodePackFields& f) { f.episodes[1].goal.translation.z = 2; },
          "episodes.1.goal: 3.5, 1.25, 1.5, 1, 0, 0, 0 | 3.5, 1.25, 2, 1, 0, 0, 0");
}

TEST(EpisodeDiff, OfContentLeavesOutTheNameOfTheSet) {
  const auto rename = [](EpisodePackFields& f) { f.name = "neat"; };
  EXPECT_EQ(episodeDiff(rename).exit_code, kExitDiffers);
  EXPECT_EQ(episodeDiff(rename, {.scope = DiffScope::kContent}).exit_code, kExitOk);
  const auto change = [](EpisodePackFields& f) { f.robot.clear(); };
  EXPECT_EQ(episodeDiff(change, {.scope = DiffScope::kContent}).exit_code, kExitDiffers);
}

TEST(EpisodeDiff, TellsMissingEpisodesAndNames) {
  const Outcome outcome = episodeDiff([](EpisodePackFields& f) {
    f.episodes.pop_back();
    f.placements.pop_back();
    f.start_positions.resize(2);
    f.scenes.insert(f.scenes.begin(), "attic");
    f.episodes[0].scene = 1;
  });
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out, HasSubstr("  episode_count: 2 | 1\n  scenes.attic: none | present\n"));
  // The index of the scene is another, its name is not.
  EXPECT_THAT(outcome.out, Not(HasSubstr("episodes.0")));
}

TEST(EpisodeDiff, TakesLengthsWithinTheToleranceAndOppositeQuaternionsAsEqual) {
  const auto nudge = [](EpisodePackFields& f) {
    f.placements[1].pose.translation.y += 0.125F;
    f.episodes[0].base_yaw += 0.125F;
    Quat& q = f.episodes[0].goal.rotation;
    q = {-q.x, -q.y, -q.z, -q.w};
  };
  EXPECT_EQ(episodeDiff(nudge, {.tolerance = 0.125}).exit_code, kExitOk);
  EXPECT_EQ(episodeDiff(nudge, {.tolerance = 0.12}).exit_code, kExitDiffers);
}

TEST(WorldDiff, ComparesListsByPath) {
  WorldPackFields changed = test::smallWorldPack();
  changed.packs[1].bytes = 2000;
  changed.packs[3].path = "scenes/loft.pack";
  const Outcome outcome = diffOf(test::smallWorldPack(), changed);
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out, HasSubstr("  packs.objects.pack.bytes: 1000 | 2000\n"
                                     "  packs.scenes/kitchen.pack.kind: SCEN | none\n"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("robots")));
}

TEST(WorldDiff, ComparesTasksByName) {
  WorldPackFields a = test::smallWorldPack();
  WorldPackFields b = a;
  a.task = test::TaskTexts{{"episode-steps", "300"}, {"safe-drop", "true"}};
  b.task = test::TaskTexts{{"task", "pick"}, {"episode-steps", "200"}, {"safe-drop", "true"}};
  const Outcome outcome = diffOf(a, b);
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out, HasSubstr("  task.episode-steps: 300 | 200\n"
                                     "  task.task: none | pick\n"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("safe-drop")));
}

TEST(CheckWorld, NamesTheTaskOptionThatIsWrong) {
  const ScratchFolder folder;
  WorldPackFields list = test::writePacks(folder, WorldFields{});
  list.task = test::TaskTexts{{"safe-drop", "maybe"}};
  const Outcome outcome = checked(folder.write("world.pack", test::textOf(buildPack(list))));
  EXPECT_EQ(outcome.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_THAT(outcome.err,
              HasSubstr("world.task[0].value: is \"maybe\", expected true or false for safe-drop"));
}

TEST(PackVerbs, RefuseEpisodesAndWorldsThatTheyCannotShow) {
  const ScratchFolder folder;
  std::ostringstream out;
  std::ostringstream err;
  for (const auto& path :
       {folder.write("e.pack", test::textOf(buildPack(test::smallEpisodes()))),
        folder.write("w.pack", test::textOf(buildPack(test::smallWorldPack())))}) {
    const Console console{out, err};
    const int invalid = static_cast<int>(ErrorCode::kInvalidInput);
    EXPECT_EQ(runColumn({.pack = path, .at = {1, 1}}, console), invalid);
    EXPECT_EQ(runExport({.pack = path, .output = folder.path() / "a.glb"}, console), invalid);
  }
  EXPECT_THAT(err.str(), HasSubstr("is a pack of kind WRLD"));
}

}  // namespace
}  // namespace galactic::pack_tool::episode_packs_test
