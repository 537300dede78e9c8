// What is kept of comparisons, and what a report tells of them.
#include "dynamics/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "dynamics/report/journal.h"
#include "dynamics/report/moments.h"
#include "dynamics/report/report_sums.h"
#include "galactic/batch_simulator.h"
#include "support/files/journal.h"
#include "support/homes/small_home.h"
#include "support/scratch_folder.h"
#include "view/run_track.h"

namespace galactic::test::report_test {
namespace {

using dynamics::ComparisonJournal;
using dynamics::ComparisonMode;
using dynamics::EpisodeComparison;
using dynamics::MissCause;
using dynamics::Moment;
using dynamics::MomentKind;
using dynamics::Thing;
using testing::HasSubstr;
using testing::Not;

/// An episode in which something of each kind happens.
EpisodeComparison made(std::uint32_t episode) {
  EpisodeComparison one;
  one.env = 3;
  one.episode = episode;
  one.end = EpisodeEnd::kSuccess;
  one.end_in_dynamics = EpisodeEnd::kTimeOut;
  one.steps = 4;
  one.steps_in_dynamics = 3;
  one.parted = 2;
  one.base_gap = {0, 0.1F, 0.3F};
  one.grip_gap = {0.0625F, 1.0F / 3, 0.7F};
  one.tracking_sum = 1.0 / 3;
  one.tracking_worst = 0.25;
  one.missed[{2, Thing::kScene, MissCause::kColumnCell}] = 2;
  one.missed[{4, Thing::kObject, MissCause::kSphereGap}] = 1;
  one.missed_steps = 2;
  one.deepest = {1, 0.04F, {2, Thing::kScene, MissCause::kColumnCell}};
  one.hindered = 2;
  one.invented[dynamics::InventedCause::kFloor] = 1;
  one.disturbed = 1;
  one.rests = {{.displacement = 0.06F,
                .lean = 0.6F,
                .drop = 0.2F,
                .step = 3,
                .world_from_object = {{1, 2, 1.0F / 3}, {0, 0.6F, 0, 0.8F}}}};
  return one;
}

/// As where the engine does not know after the first step where everything is.
void loseInFirstStep(EpisodeComparison& one) {
  one.end_in_dynamics = EpisodeEnd::kNone;
  one.steps_in_dynamics = 0;
  one.parted.reset();
  one.base_gap.clear();
  one.grip_gap.clear();
  one.tracking_sum = one.tracking_worst = 0;
}

void expectSame(const EpisodeComparison& found, const EpisodeComparison& wanted) {
  EXPECT_EQ(found.env, wanted.env);
  EXPECT_EQ(found.episode, wanted.episode);
  EXPECT_EQ(found.end, wanted.end);
  EXPECT_EQ(found.end_in_dynamics, wanted.end_in_dynamics);
  EXPECT_EQ(found.steps, wanted.steps);
  EXPECT_EQ(found.steps_in_dynamics, wanted.steps_in_dynamics);
  EXPECT_EQ(found.parted, wanted.parted);
  EXPECT_EQ(found.base_gap, wanted.base_gap);
  EXPECT_EQ(found.grip_gap, wanted.grip_gap);
  EXPECT_EQ(found.tracking_sum, wanted.tracking_sum);
  EXPECT_EQ(found.tracking_worst, wanted.tracking_worst);
  EXPECT_EQ(found.missed, wanted.missed);
  EXPECT_EQ(found.missed_steps, wanted.missed_steps);
  EXPECT_EQ(found.invented, wanted.invented);
  ASSERT_EQ(found.deepest.has_value(), wanted.deepest.has_value());
  EXPECT_EQ(found.deepest->depth, wanted.deepest->depth);
  EXPECT_EQ(found.deepest->key, wanted.deepest->key);
  ASSERT_EQ(found.rests.size(), wanted.rests.size());
  EXPECT_EQ(found.rests[0].displacement, wanted.rests[0].displacement);
  EXPECT_EQ(found.rests[0].step, wanted.rests[0].step);
  EXPECT_EQ(found.rests[0].world_from_object, wanted.rests[0].world_from_object);
}

/// made() has contacts of link 4.
constexpr std::size_t kLinks = 5;

ComparisonJournal openJournal(const std::filesystem::path& file) {
  auto opened = ComparisonJournal::open(file, "these", kLinks);
  EXPECT_TRUE(opened);
  return *std::move(opened);
}

TEST(AJournalOfComparisons, GivesBackExactlyWhatWasAdded) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "r.json.partial";
  auto journal = openJournal(file);
  EXPECT_TRUE(journal.done().empty());
  ASSERT_TRUE(journal.add(5, made(17)));
  ASSERT_TRUE(journal.add(2, made(9)));
  auto again = openJournal(file);
  ASSERT_EQ(again.done().size(), 2U);
  expectSame(again.done().at(5), made(17));
  expectSame(again.done().at(2), made(9));
  again.remove();
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(AJournalOfComparisons, TakesNoOtherRecords) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "r.json.partial";
  auto journal = openJournal(file);
  ASSERT_TRUE(journal.add(0, made(1)));
  const auto plain = Journal::open(file, "these").value();
  std::string wrong(plain->records().front());
  const std::string ended = "\"dynamics\":[5";
  wrong.replace(wrong.find(ended), ended.size(), "\"dynamics\":[9");
  std::string older(plain->records().front());
  older.replace(older.find("\"dynamics\""), 10, "\"there\"");
  older.replace(older.find("\"simulation\""), 12, "\"here\"");
  plain->remove();
  const auto other = Journal::open(file, "these").value();
  ASSERT_TRUE(other->add(wrong));
  ASSERT_TRUE(other->add(older));
  ASSERT_TRUE(other->add("{}"));
  ASSERT_TRUE(other->add("no JSON"));
  EXPECT_TRUE(openJournal(file).done().empty());
}

TEST(AJournalOfComparisons, TakesNoRecordsOfWhatIsNotThere) {
  // The first two are sound: as they are, and without a step in the dynamics.
  constexpr std::size_t kSound = 2;
  using Change = void (*)(EpisodeComparison&);
  const std::vector<Change> changes{
      [](EpisodeComparison&) {},
      [](EpisodeComparison& one) { loseInFirstStep(one); },
      [](EpisodeComparison& one) {
        one.missed[{5, Thing::kScene, MissCause::kColumnCell}] = 1;
      },
      [](EpisodeComparison& one) { std::get<0>(one.deepest->key) = 5; },
      [](EpisodeComparison& one) { one.deepest->step = 4; },
      [](EpisodeComparison& one) { one.rests[0].step = 4; },
      [](EpisodeComparison& one) { one.parted = 3; },
      [](EpisodeComparison& one) { one.grip_gap.pop_back(); },
      [](EpisodeComparison& one) { one.base_gap.pop_back(); },
      [](EpisodeComparison& one) {
        one.base_gap.push_back(0);
        one.grip_gap.push_back(0);
      },
      [](EpisodeComparison& one) {
        loseInFirstStep(one);
        one.steps_in_dynamics = 3;
      },
      [](EpisodeComparison& one) {
        loseInFirstStep(one);
        one.parted = 0;
      },
  };
  for (std::size_t n = 0; n < changes.size(); ++n) {
    const ScratchFolder folder;
    const std::filesystem::path file = folder.path() / "r.json.partial";
    EpisodeComparison one = made(1);
    changes[n](one);
    ASSERT_TRUE(openJournal(file).add(0, one));
    EXPECT_EQ(openJournal(file).done().size(), n < kSound ? 1U : 0U) << n;
  }
}

TEST(TheWorstMoments, AreOfEachKindInTurn) {
  std::vector<EpisodeComparison> episodes{made(0), made(1), made(2)};
  episodes[1].deepest->depth = 0.5F;
  episodes[2].rests[0].displacement = 0.5F;
  episodes[0].grip_gap[2] = 0.9F;
  const std::vector<Moment> worst = worstMoments(episodes, 6, ComparisonMode::kReplay);
  ASSERT_EQ(worst.size(), 6U);
  EXPECT_EQ(worst[0].kind, MomentKind::kLost);
  EXPECT_EQ(worst[0].comparison, 0U);
  EXPECT_EQ(worst[0].step, 2U);
  EXPECT_EQ(worst[1].kind, MomentKind::kMissed);
  EXPECT_EQ(worst[1].comparison, 1U);
  EXPECT_EQ(worst[1].step, 1U);
  // Before the hands hold different things.
  EXPECT_EQ(worst[2].kind, MomentKind::kApart);
  EXPECT_EQ(worst[2].step, 1U);
  EXPECT_EQ(worst[3].kind, MomentKind::kMoved);
  EXPECT_EQ(worst[3].comparison, 2U);
  EXPECT_EQ(worst[3].step, 3U);
  for (const Moment& moment : worstMoments(episodes, 6, ComparisonMode::kClosedLoop)) {
    EXPECT_NE(moment.kind, MomentKind::kApart);
  }
  EXPECT_EQ(worst[4].kind, MomentKind::kLost);
  EXPECT_EQ(worst[4].comparison, 1U);
}

TEST(TheWorstMoments, AreWorthALook) {
  std::vector<EpisodeComparison> episodes{made(0)};
  episodes[0].end_in_dynamics = EpisodeEnd::kSuccess;
  episodes[0].deepest.reset();
  EXPECT_EQ(worstMoments(episodes, 6, ComparisonMode::kReplay).size(), 2U);
  // Two centimeters are nothing to look at.
  episodes[0].rests[0].displacement = dynamics::kDisturbed;
  episodes[0].grip_gap = {0, dynamics::kDisturbed, 0.7F};
  EXPECT_TRUE(worstMoments(episodes, 6, ComparisonMode::kReplay).empty());
}

/// The first env of a world, moved ahead step by step, of which it waits the first `waits`.
RunTrack drivenTrack(const World& world, std::uint32_t steps, std::uint32_t waits) {
  SimulationOptions options;
  options.envs = 1;
  BatchSimulator simulator = BatchSimulator::create(world, options).value();
  RunTrack track(world, simulator, 1);
  std::vector<float> actions(simulator.actionCount());
  for (std::uint32_t step = 0; step < steps; ++step) {
    actions[kForward] = step < waits ? 0.0F : -0.2F;
    simulator.step(actions);
    track.add(simulator, actions);
  }
  return track;
}

TEST(AMoment, IsToldWithTheStepsOfBothWorlds) {
  const SmallHome home;
  const World& world = home.world();
  const RunTrack simulated = drivenTrack(world, 12, 0);
  const RunTrack dynamic = drivenTrack(world, 20, 5);
  const EpisodeComparison episode = made(0);
  const auto sides = [&](MomentKind kind, std::uint32_t step, ComparisonMode mode) {
    return sidesOf({.kind = kind, .step = step, .meters = 0.5F}, episode, {simulated, dynamic},
                   mode);
  };
  const auto told = [](const dynamics::MomentSides& one) {
    return one.simulated.said + " | " + one.dynamic.said;
  };
  EXPECT_EQ(told(sides(MomentKind::kMissed, 7, ComparisonMode::kReplay)),
            "simulation, step 8, contact missed, 0.500 m | dynamics, step 8");
  // The simulation ends before.
  EXPECT_EQ(told(sides(MomentKind::kLost, 15, ComparisonMode::kReplay)),
            "simulation, step 12, success lost, 0.500 m | dynamics, step 16");
  EXPECT_EQ(told(sides(MomentKind::kLost, 7, ComparisonMode::kClosedLoop)),
            "simulation, step 12, success | dynamics, step 20, time out, success lost, 0.500 m");
  // In the dynamics the robot comes by five steps later.
  EXPECT_EQ(told(sides(MomentKind::kMissed, 7, ComparisonMode::kClosedLoop)),
            "simulation, step 8, contact missed, 0.500 m | dynamics, step 13, most like it");
  for (const ComparisonMode mode : {ComparisonMode::kReplay, ComparisonMode::kClosedLoop}) {
    const auto moved = sides(MomentKind::kMoved, 3, mode);
    EXPECT_EQ(told(moved),
              "simulation, step 4, let go | dynamics, 2 s later, object moved, 0.500 m");
    EXPECT_EQ(moved.rest, episode.rests[0].world_from_object);
    EXPECT_EQ(moved.simulated.frame, 4U);
  }
}

TEST(AMoment, IsToldWithTheStartOfTheDynamicsWhereTheyMadeNoStep) {
  const SmallHome home;
  const RunTrack simulated = drivenTrack(home.world(), 12, 0);
  const RunTrack dynamic = drivenTrack(home.world(), 0, 0);
  for (const ComparisonMode mode : {ComparisonMode::kReplay, ComparisonMode::kClosedLoop}) {
    const auto sides = sidesOf({.kind = MomentKind::kMissed, .step = 7, .meters = 0.5F}, made(0),
                               {simulated, dynamic}, mode);
    EXPECT_THAT(sides.dynamic.said, testing::StartsWith("dynamics, start"));
    EXPECT_EQ(sides.dynamic.frame, 0U);
  }
}

TEST(AMoment, IsSeenInTheWorldWhoseStepItIs) {
  using dynamics::MomentPlace;
  const auto place = [](MomentKind kind, std::uint32_t step) {
    return placeOf(Moment{.kind = kind, .step = step}, 400, 60);
  };
  EXPECT_EQ(place(MomentKind::kMissed, 300), (MomentPlace{true, 301}));
  EXPECT_EQ(place(MomentKind::kMoved, 399), (MomentPlace{true, 400}));
  EXPECT_EQ(place(MomentKind::kLost, 20), (MomentPlace{false, 21}));
  // The dynamics ended before.
  EXPECT_EQ(place(MomentKind::kLost, 300), (MomentPlace{false, 60}));
  EXPECT_EQ(place(MomentKind::kApart, 59), (MomentPlace{false, 60}));
}

TEST(Sums, TellWhyContactsAreMissedAndWhereSuccessIsLost) {
  std::vector<EpisodeComparison> episodes{made(0), made(1)};
  episodes[1].picked_in_dynamics = true;
  const dynamics::Sums sums = dynamics::sumOf(episodes);
  EXPECT_EQ(sums.outcomes.in_simulation, 2U);
  EXPECT_EQ(sums.outcomes.in_dynamics, 0U);
  EXPECT_EQ(sums.outcomes.lost_picking, 1U);
  EXPECT_EQ(sums.outcomes.lost_later, 1U);
  EXPECT_EQ(sums.missedByCause().at(MissCause::kColumnCell), 4U);
  EXPECT_EQ(sums.missedByCause().at(MissCause::kSphereGap), 2U);
  EXPECT_EQ(sums.inventedSteps(), 2U);
  EXPECT_EQ(sums.away(), 2U);
  EXPECT_EQ(sums.tipped, 2U);
  EXPECT_EQ(sums.fallen, 2U);
  EXPECT_DOUBLE_EQ(sums.perThousand(4), 500);
}

World smallHome(const ScratchFolder& folder) {
  const std::filesystem::path pack = writeWorld(folder, smallHomeWorld());
  return World::open(std::span(&pack, 1)).value();
}

TEST(AReport, HasItsValuesBelowEachOther) {
  const ScratchFolder folder;
  const World world = smallHome(folder);
  const std::string table = dynamics::reportTable({.episodes = {made(0)}, .worst = {}}, world, {});
  const std::string longest = "successes lost before, after picking  ";
  ASSERT_THAT(table, HasSubstr("\n" + longest + "1, 0\n"));
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    ASSERT_GT(line.size(), longest.size());
    EXPECT_EQ(line.substr(longest.size() - 2, 2), "  ") << line;
    EXPECT_NE(line.find_first_not_of(' ', longest.size()), std::string::npos) << line;
  }
}

TEST(AReport, NamesTheOptionsThatDecideWhatItSays) {
  const ScratchFolder folder;
  const World world = smallHome(folder);
  const dynamics::Comparisons comparisons{.episodes = {made(0)}, .worst = {}};
  dynamics::ReportSubject subject;
  subject.world = {.arm = dynamics::ArmDrive::kKinematic, .friction = 0.5};
  subject.loop = {.is_deterministic = true,
                  .seed = 18446744073709551615U,
                  .task = {{"episode-steps", "400"}, {"task", "pick"}}};
  EXPECT_THAT(dynamics::reportJson(comparisons, world, subject), HasSubstr(R"(
  "options": {
    "arm": "kinematic",
    "base": "kinematic",
    "friction": 0.5
  },
)")) << "a recording has its own seed and task";
  subject.mode = ComparisonMode::kClosedLoop;
  subject.played = "picker.pack";
  EXPECT_THAT(dynamics::reportJson(comparisons, world, subject), HasSubstr(R"(
  "options": {
    "arm": "kinematic",
    "base": "kinematic",
    "friction": 0.5,
    "deterministic": true,
    "seed": 18446744073709551615,
    "episode-steps": 400,
    "task": "pick"
  },
)"));
}

TEST(AReport, CountsStepsFromOneAsTextsDo) {
  const ScratchFolder folder;
  const World world = smallHome(folder);
  dynamics::Comparisons comparisons{.episodes = {made(0)}, .worst = {}};
  comparisons.worst = {{.kind = MomentKind::kLost, .comparison = 0, .step = 2, .meters = 0.7F}};
  const std::string json = dynamics::reportJson(comparisons, world, {});
  EXPECT_THAT(json, HasSubstr("episode 0, step 3: success lost"));
  EXPECT_THAT(json, HasSubstr("\"step\": 3,"));
  EXPECT_THAT(json, HasSubstr("\"parted\": 3,"));
  EXPECT_THAT(json, HasSubstr("\"step\": 4,")) << "of what was let go";
  EXPECT_THAT(json, Not(HasSubstr("\"step\": 2")));
}

TEST(AReport, TellsNoGapsWhereTheDynamicsMadeNoStep) {
  const ScratchFolder folder;
  const World world = smallHome(folder);
  dynamics::Comparisons comparisons{.episodes = {made(0)}, .worst = {}};
  const std::string plain = dynamics::reportJson(comparisons, world, {});
  EXPECT_THAT(plain, HasSubstr("\"last_grip_gap\": 0.69999"));
  loseInFirstStep(comparisons.episodes.front());
  comparisons.worst = worstMoments(comparisons.episodes, 10, ComparisonMode::kReplay);
  const std::string json = dynamics::reportJson(comparisons, world, {});
  EXPECT_THAT(json, HasSubstr("\"steps_in_dynamics\": 0,"));
  EXPECT_THAT(json, HasSubstr("\"last_base_gap\": null,"));
  EXPECT_THAT(json, HasSubstr("\"last_grip_gap\": null,"));
  EXPECT_THAT(json, HasSubstr("\"divergence\": [],"));
  EXPECT_THAT(dynamics::reportTable(comparisons, world, {}), HasSubstr("1, 4, 0\n"));
}

TEST(AReport, TellsNoFiguresOfWhatWasNotLetGo) {
  const ScratchFolder folder;
  const World world = smallHome(folder);
  dynamics::Comparisons comparisons{.episodes = {made(0)}, .worst = {}};
  EXPECT_THAT(dynamics::reportTable(comparisons, world, {}),
              HasSubstr("1; 2 s later 0.060 m away"));
  EXPECT_THAT(dynamics::reportJson(comparisons, world, {}), HasSubstr("\"displacement\": {"));
  comparisons.episodes.front().rests.clear();
  const std::string table = dynamics::reportTable(comparisons, world, {});
  EXPECT_THAT(table, HasSubstr("objects let go"));
  EXPECT_THAT(table, Not(HasSubstr("2 s later")));
  const std::string json = dynamics::reportJson(comparisons, world, {});
  EXPECT_THAT(json, HasSubstr("\"releases\": {\n    \"count\": 0\n  }"));
}

}  // namespace
}  // namespace galactic::test::report_test
