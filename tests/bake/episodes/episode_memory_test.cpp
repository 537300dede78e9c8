// Scenes that are prepared at the same time keep to an amount of memory.
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/memory_budget.h"
#include "galactic/bake/build.h"
#include "made_world.h"
#include "support/scratch_folder.h"

namespace galactic::test::episode_memory_test {
namespace {

using bake::MemoryBudget;
using bake::memoryFor;
using bake::SceneDetails;
using std::chrono::milliseconds;

bake::TriangleMesh twoTables() {
  MeshBuilder room = madeRoom(3, 3);
  room.box({0.2F, 0.6F, 0.2F}, {0.9F, 0.65F, 1});
  room.box({2, 0.6F, 2}, {2.8F, 0.65F, 2.7F});
  return room.build();
}

/// Those who read the details of scenes: each waits until it has met another, but not for ever.
class Readers {
 public:
  explicit Readers(milliseconds patience) : patience_(patience) {}

  void read(std::string_view scene) {
    std::unique_lock lock(mutex_);
    if (!reading_.empty()) {
      met_.insert(reading_.begin(), reading_.end());
      met_.emplace(scene);
    }
    const auto place = reading_.emplace(scene).first;
    came_.notify_all();
    came_.wait_for(lock, patience_, [&] { return met_.contains(scene); });
    reading_.erase(place);
  }
  /// Whether another scene was read at the same time as this.
  [[nodiscard]] bool haveMet(std::string_view scene) const { return met_.contains(scene); }

 private:
  milliseconds patience_;
  std::mutex mutex_;
  std::condition_variable came_;
  std::set<std::string, std::less<>> reading_;
  std::set<std::string, std::less<>> met_;
};

/// A build's, told to hold up whoever draws: each that asks whether to go on waits until it has met
/// another, but not for ever.
class HoldingObserver final : public bake::BuildObserver {
 public:
  explicit HoldingObserver(milliseconds patience) : patience_(patience) {}

  void show(std::string_view item, std::string_view stage, double fraction) override {
    const std::lock_guard lock(mutex_);
    if (item == "episodes") is_drawing_ = stage != "solve" && fraction < 1;
  }
  [[nodiscard]] bool stops() override {
    std::unique_lock lock(mutex_);
    if (!is_drawing_ || have_met_) return false;
    have_met_ = ++asking_ > 1;
    came_.notify_all();
    came_.wait_for(lock, patience_, [&] { return have_met_; });
    --asking_;
    return false;
  }
  /// Whether two scenes were drawn in at the same time.
  [[nodiscard]] bool haveMet() const { return have_met_; }

 private:
  milliseconds patience_;
  std::mutex mutex_;
  std::condition_variable came_;
  bool is_drawing_ = false;
  bool have_met_ = false;
  int asking_ = 0;
};

/// For those who would meet at once, and for those who surely meet.
constexpr milliseconds kLittle{300};
constexpr milliseconds kLong{20'000};

class EpisodeMemory : public testing::Test {
 protected:
  using Scenes = std::vector<const MemoryPack*>;

  /// Draws an episode in each of the scenes, on two threads.
  void draw(const Scenes& scenes, MemoryBudget* memory, Readers& readers) const {
    const bake::EpisodeInputs inputs{
        .packs = allPacks(scenes), .details = detailsFrom(readers), .threads = 2, .memory = memory};
    const auto made = bake::generateEpisodes(inputs, optionsFor(scenes));
    EXPECT_TRUE(made) << made.error().text();
  }
  /// The same in a build that may take so many bytes.
  void build(const Scenes& scenes, std::uint64_t bytes, HoldingObserver& observer) const {
    const ScratchFolder folder;
    bake::EpisodeGenerationJob job{.generate = optionsFor(scenes), .solve = 0};
    for (const PackFile* pack : allPacks(scenes)) {
      const auto content = pack->bytes();
      job.packs.push_back(
          folder.write(pack->where() + ".pack",
                       {reinterpret_cast<const char*>(content.data()), content.size()}));
    }
    bake::WorldPlan plan;
    plan.world.output = folder.path() / "world.pack";
    plan.folder = folder.path();
    plan.episodes = {.name = "episodes.pack",
                     .job = std::move(job),
                     .output = folder.path() / "episodes.pack",
                     .folder = folder.path()};
    bake::BakeLibraries libraries;
    const auto made = bake::build(plan, {.threads = 2, .memory = bytes}, observer, libraries);
    ASSERT_EQ(made.packs.size(), 1U);
    EXPECT_TRUE(made.packs.front().isThere());
  }

  static constexpr std::uint64_t kLarge = 100'000'000;

  const MemoryPack big_ = scenePackOf(twoTables(), "big", madeRadii(), kLarge);
  const MemoryPack small_ = scenePackOf(twoTables(), "small");
  const MemoryPack tiny_ = scenePackOf(twoTables(), "tiny");

 private:
  [[nodiscard]] std::vector<const PackFile*> allPacks(const Scenes& scenes) const {
    std::vector<const PackFile*> packs{&cube_.pack(), &robot_.pack()};
    for (const MemoryPack* scene : scenes) packs.push_back(&scene->pack());
    return packs;
  }
  static bake::SceneDetailSource detailsFrom(Readers& readers) {
    return [&readers](std::string_view scene) -> Result<SceneDetails> {
      readers.read(scene);
      return SceneDetails{.mesh = twoTables(), .receptacles = {}};
    };
  }
  static bake::EpisodeGeneratorOptions optionsFor(const Scenes& scenes) {
    return {.episodes = static_cast<std::uint32_t>(scenes.size()), .objects = {2, 2}};
  }

  const MemoryPack cube_ = cubePack();
  const MemoryPack robot_{buildPack(stickRobot()), "r"};
};

TEST_F(EpisodeMemory, HoldsScenesThatFitTogether) {
  MemoryBudget memory(3 * memoryFor(0));
  Readers readers(kLong);
  draw({&small_, &tiny_}, &memory, readers);
  EXPECT_TRUE(readers.haveMet("small"));
  EXPECT_TRUE(readers.haveMet("tiny"));
}

TEST_F(EpisodeMemory, HoldsOneSceneAfterTheOtherWhereTheyDoNotFit) {
  MemoryBudget memory(1);
  Readers readers(kLittle);
  draw({&small_, &tiny_}, &memory, readers);
  EXPECT_FALSE(readers.haveMet("small"));
  EXPECT_FALSE(readers.haveMet("tiny"));
}

TEST_F(EpisodeMemory, IsThatOfTheBuild) {
  HoldingObserver one(kLittle);
  build({&small_, &tiny_}, 1, one);
  EXPECT_FALSE(one.haveMet());
  HoldingObserver both(kLong);
  build({&small_, &tiny_}, 3 * memoryFor(0), both);
  EXPECT_TRUE(both.haveMet());
}

TEST_F(EpisodeMemory, HoldsALargeSceneAlone) {
  // On average two of the three fit.
  MemoryBudget memory(memoryFor(kLarge) - 1);
  Readers readers(kLittle);
  draw({&big_, &small_, &tiny_}, &memory, readers);
  EXPECT_FALSE(readers.haveMet("big"));
  // All of it is free again.
  const MemoryBudget::Share whole(memory, memory.bytes());
}

TEST_F(EpisodeMemory, HasNoEndWhereNobodySaysSo) {
  Readers readers(kLong);
  draw({&big_, &small_}, nullptr, readers);
  EXPECT_TRUE(readers.haveMet("big"));
}

TEST(MemoryForASource, GrowsWithItsSizeAndDoesNotOverflow) {
  EXPECT_LT(memoryFor(0), memoryFor(1'000'000));
  EXPECT_LT(memoryFor(1'000'000), memoryFor(~std::uint64_t{0}));
}

}  // namespace
}  // namespace galactic::test::episode_memory_test
