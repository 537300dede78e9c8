// The build of a world tells of each pack once, by its name, whether or not there was a job for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/build.h"
#include "support/scratch_folder.h"

namespace galactic::test::world_build_test {
namespace {

using bake::BuildOutcome;
using bake::PackOutcome;
using bake::PackState;
using testing::ElementsAre;

/// Writes down whom it is told of.
class NotingObserver final : public bake::BuildObserver {
 public:
  void begin(std::string_view pack) override {
    const std::lock_guard lock(mutex_);
    begun.emplace_back(pack);
  }
  void end(const PackOutcome& pack) override {
    const std::lock_guard lock(mutex_);
    ended.push_back(pack.name);
  }

  std::vector<std::string> begun;
  std::vector<std::string> ended;

 private:
  std::mutex mutex_;
};

class AWorldBuild : public testing::Test {
 protected:
  AWorldBuild() {
    plan_.world.output = folder_.path() / "home.pack";
    plan_.folder = folder_.path() / "home";
    for (const char* name : {"one", "three", "two"}) {
      // There are no such files: each fails at once.
      plan_.assets.push_back({.name = std::string(name) + ".pack",
                              .job = bake::SceneJob{.input = folder_.path() / name},
                              .output = plan_.folder / (std::string(name) + ".pack"),
                              .folder = folder_.path()});
    }
    plan_.broken.push_back(
        {"odd.pack", {"odd.json", {ErrorCode::kInvalidInput, "odd.json", "is odd"}}});
    plan_.episodes = bake::PackJob{.name = "episodes.pack",
                                   .job = bake::EpisodeGenerationJob{},
                                   .output = plan_.folder / "episodes.pack"};
  }

  static std::vector<PackState> statesOf(const BuildOutcome& outcome) {
    std::vector<PackState> states;
    for (const PackOutcome& pack : outcome.packs) states.push_back(pack.state);
    return states;
  }

  ScratchFolder folder_;
  bake::BakeLibraries libraries_;
  bake::WorldPlan plan_;
};

TEST_F(AWorldBuild, TellsOfBrokenScenesByTheirNames) {
  NotingObserver observer;
  const BuildOutcome outcome = build(plan_, {.keep_going = true}, observer, libraries_);
  EXPECT_THAT(observer.begun, ElementsAre("one.pack", "three.pack", "two.pack", "episodes.pack"));
  EXPECT_THAT(observer.ended,
              ElementsAre("odd.pack", "one.pack", "three.pack", "two.pack", "episodes.pack"));
  EXPECT_THAT(statesOf(outcome), testing::Each(PackState::kFailed));
  EXPECT_FALSE(outcome.world) << "there is nothing to link";
}

TEST_F(AWorldBuild, EndsAfterWhatIsBroken) {
  NotingObserver observer;
  const BuildOutcome outcome = build(plan_, {}, observer, libraries_);
  EXPECT_THAT(observer.begun, testing::IsEmpty());
  EXPECT_THAT(observer.ended, ElementsAre("odd.pack"));
  EXPECT_EQ(outcome.firstError()->text(), "odd.json: is odd");
}

TEST_F(AWorldBuild, IsPlannedForEachShard) {
  const BuildOutcome whole = plannedOutcome(plan_, {});
  EXPECT_THAT(statesOf(whole),
              ElementsAre(PackState::kPlanned, PackState::kPlanned, PackState::kPlanned,
                          PackState::kFailed, PackState::kPlanned));
  EXPECT_EQ(whole.packs.back().name, "episodes.pack");
  // Episodes are made when all shards are done.
  EXPECT_THAT(statesOf(plannedOutcome(plan_, {.index = 1, .count = 2})),
              ElementsAre(PackState::kElsewhere, PackState::kPlanned, PackState::kElsewhere,
                          PackState::kFailed));
}

}  // namespace
}  // namespace galactic::test::world_build_test
