// A generation that is interrupted goes on where it was, and ends as if nothing had happened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "episodes/scene_journal.h"
#include "galactic/bake/packs.h"
#include "made_world.h"
#include "support/files/journal.h"
#include "support/scratch_folder.h"

namespace galactic::test::episode_journal_test {
namespace {

using bake::DrawnEpisode;
using bake::EpisodeGeneratorOptions;
using bake::EpisodeInputs;
using bake::GeneratedEpisodes;
using bake::SceneDetails;
using bake::SceneJournal;
using testing::HasSubstr;

constexpr std::uint32_t kEpisodes = 150;

bake::TriangleMesh twoTables() {
  MeshBuilder room = madeRoom(3, 3);
  room.box({0.2F, 0.6F, 0.2F}, {0.9F, 0.65F, 1});
  room.box({2, 0.6F, 2}, {2.8F, 0.65F, 2.7F});
  return room.build();
}

/// What is compared of a generation.
std::vector<std::byte> bytesOf(const GeneratedEpisodes& made) {
  return MemoryPack::opened(bake::encodeEpisodePack(made.episodes, testProvenance("episodes")));
}

class EpisodeJournal : public testing::Test {
 protected:
  EpisodeJournal() {
    options_.episodes = kEpisodes;
    options_.objects = {2, 2};
    inputs_.packs = world_.packs();
    inputs_.packs.push_back(&kitchen_.pack());
    inputs_.details = [](std::string_view) -> Result<SceneDetails> {
      return SceneDetails{.mesh = twoTables(), .receptacles = {}};
    };
  }

  [[nodiscard]] std::unique_ptr<Journal> open() const {
    return Journal::open(folder_.path() / "x.pack.partial", "these").value();
  }
  [[nodiscard]] std::vector<std::string> records() const {
    const auto journal = open();
    return {journal->records().begin(), journal->records().end()};
  }

  /// Goes on from the journal.
  [[nodiscard]] Result<GeneratedEpisodes> goOn(const std::function<bool()>& stops = {}) const {
    const auto journal = open();
    EpisodeInputs inputs = inputs_;
    inputs.journal = journal.get();
    inputs.stops = stops;
    return bake::generateEpisodes(inputs, options_);
  }
  /// The same, stopped after some questions.
  [[nodiscard]] Result<GeneratedEpisodes> stopAfter(int questions) const {
    std::atomic<int> left = questions;
    return goOn([&left] { return left-- <= 0; });
  }

  const MadeWorld world_{twoTables(), stickRobot()};
  const MemoryPack kitchen_ = scenePackOf(twoTables(), "kitchen");
  EpisodeInputs inputs_;
  EpisodeGeneratorOptions options_;

 private:
  ScratchFolder folder_;
};

TEST_F(EpisodeJournal, GoesOnAfterEachInterruptionAndDrawsNothingTwice) {
  const auto wanted = MemoryPack::opened(bake::generateEpisodes(inputs_, options_));
  for (const unsigned threads : {1U, 3U}) {
    inputs_.threads = threads;
    int questions = 0;
    // Each time it comes a little further: two scenes, 64 and 11 episodes in each.
    Result<GeneratedEpisodes> made = stopAfter(questions);
    for (; !made && questions < 20; made = stopAfter(questions)) {
      ++questions;
      ASSERT_EQ(made.error().code, ErrorCode::kInterrupted);
      EXPECT_EQ(made.error().where, "episodes");
      EXPECT_THAT(made.error().message, HasSubstr("interrupted after "));
      EXPECT_THAT(made.error().message, HasSubstr(" of 150 episodes"));
    }
    ASSERT_TRUE(made.has_value());
    EXPECT_GE(questions, 4);
    EXPECT_TRUE(bytesOf(*made) == bytesOf(wanted)) << threads;
    EXPECT_EQ(textOf(made->rejections), textOf(wanted.rejections));
    ASSERT_EQ(made->scenes.size(), 2U);
    EXPECT_EQ(made->scenes[1].support_places, wanted.scenes[1].support_places);
    EXPECT_EQ(made->scenes[1].episodes, wanted.scenes[1].episodes);
    EXPECT_TRUE(made->scenes[1].has_mesh);
    const std::vector<std::string> all = records();
    EXPECT_EQ(all.size(), 2U + 4U);
    EXPECT_EQ(std::set(all.begin(), all.end()).size(), all.size());
    open()->remove();
  }
}

TEST_F(EpisodeJournal, TellsOfWhatWasDrawnBefore) {
  // Two looks, and the two batches of the first scene.
  ASSERT_FALSE(stopAfter(4).has_value());
  ASSERT_EQ(records().size(), 4U);
  const auto journal = open();
  EpisodeInputs inputs = inputs_;
  inputs.journal = journal.get();
  std::vector<std::size_t> told;
  std::vector<std::size_t> kept;
  ASSERT_TRUE(bake::generateEpisodes(inputs, options_, [&](std::size_t done) {
    told.push_back(done);
    kept.push_back(records().size());
  }));
  EXPECT_THAT(told, testing::ElementsAre(64U, 75U, 139U, kEpisodes));
  // Both of the first were there already.
  EXPECT_THAT(kept, testing::ElementsAre(4U, 4U, 5U, 6U));
}

TEST_F(EpisodeJournal, KnowsScenesThatAreOfNoUse) {
  const MemoryPack attic = scenePackOf(madeRoom(3, 3).build(), "attic");
  const MemoryPack den = scenePackOf(madeRoom(3, 3).build(), "den");
  for (const MemoryPack* bare : {&attic, &den}) inputs_.packs.push_back(&bare->pack());
  const auto read = inputs_.details;
  inputs_.details = [read](std::string_view scene) -> Result<SceneDetails> {
    if (scene == "kitchen" || scene == "room") return read(scene);
    return SceneDetails{.mesh = madeRoom(3, 3).build(), .receptacles = {}};
  };
  const auto wanted = MemoryPack::opened(bake::generateEpisodes(inputs_, options_));
  ASSERT_EQ(wanted.left_out.size(), 2U);
  Result<GeneratedEpisodes> made = stopAfter(0);
  for (int questions = 1; questions < 20 && !made; ++questions) made = stopAfter(questions);
  ASSERT_TRUE(made.has_value());
  EXPECT_TRUE(bytesOf(*made) == bytesOf(wanted));
  EXPECT_EQ(made->episodes.warnings, wanted.episodes.warnings);
  // All is known: nothing is looked at or drawn again.
  const std::vector<std::string> before = records();
  const auto again = goOn();
  ASSERT_TRUE(again.has_value());
  EXPECT_TRUE(bytesOf(*again) == bytesOf(wanted));
  EXPECT_EQ(again->left_out.size(), 2U);
  EXPECT_EQ(records(), before);
}

TEST_F(EpisodeJournal, SaysNothingOfAnotherMesh) {
  ASSERT_TRUE(goOn().has_value());
  const std::size_t before = records().size();
  // A wall nobody notices.
  inputs_.details = [](std::string_view scene) -> Result<SceneDetails> {
    MeshBuilder room = madeRoom(3, 3);
    room.box({0.2F, 0.6F, 0.2F}, {0.9F, 0.65F, 1});
    room.box({2, 0.6F, 2}, {2.8F, 0.65F, 2.7F});
    if (scene == "kitchen") room.box({1.5F, 0, 1.5F}, {1.51F, 0.01F, 1.51F});
    return SceneDetails{.mesh = room.build(), .receptacles = {}};
  };
  const auto wanted = MemoryPack::opened(bake::generateEpisodes(inputs_, options_));
  const auto made = goOn();
  ASSERT_TRUE(made.has_value());
  EXPECT_TRUE(bytesOf(*made) == bytesOf(wanted));
  // One look and two batches.
  EXPECT_EQ(records().size(), before + 3);
}

TEST_F(EpisodeJournal, IsReadWithCare) {
  ASSERT_TRUE(goOn().has_value());
  const auto wanted = MemoryPack::opened(bake::generateEpisodes(inputs_, options_));
  const std::vector<std::string> good = records();
  std::vector<std::string> bad;
  for (const std::string& record : good) {
    for (std::size_t size = 0; size < record.size(); size += 1 + size / 8) {
      bad.push_back(record.substr(0, size));
    }
    bad.push_back(record + "x");
    // Sizes and indices that nothing has.
    for (std::size_t at = 0; at + 8 <= record.size() && at < 600; ++at) {
      std::string wrong = record;
      wrong.replace(at, 8, 8, '\xff');
      bad.push_back(std::move(wrong));
    }
  }
  open()->remove();
  {
    const auto journal = open();
    for (const std::string& record : bad) ASSERT_TRUE(journal->add(record));
  }
  // Poses may be anything, as nothing tells them from others; all else is as it has to be.
  const auto made = goOn();
  ASSERT_TRUE(made.has_value()) << made.error().message;
  EXPECT_EQ(made->episodes.episodes.size(), wanted.episodes.episodes.size());
  EXPECT_EQ(made->episodes.placements.size(), wanted.episodes.placements.size());
  EXPECT_EQ(made->scenes[0].name, "kitchen");
}

TEST_F(EpisodeJournal, EndsTheDrawingWhereNothingCanBeKept) {
  const ScratchFolder folder;
  const auto journal = Journal::open(folder.path() / "gone/x.partial", "these").value();
  int looks = 0;
  inputs_.journal = journal.get();
  inputs_.details = [&looks](std::string_view) -> Result<SceneDetails> {
    ++looks;
    return SceneDetails{};
  };
  const auto made = bake::generateEpisodes(inputs_, options_);
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, ErrorCode::kIo);
  EXPECT_EQ(looks, 1) << "of two scenes";
}

TEST_F(EpisodeJournal, TellsOfErrorsBeforeAStopAndOfAStopBeforeUnusableScenes) {
  // Attic, kitchen, room; the first is of no use, and then somebody asks to stop.
  const MemoryPack attic = scenePackOf(madeRoom(3, 3).build(), "attic");
  inputs_.packs.push_back(&attic.pack());
  std::atomic<bool> stops{false};
  inputs_.details = [&stops](std::string_view scene) -> Result<SceneDetails> {
    if (scene != "attic") return SceneDetails{.mesh = twoTables(), .receptacles = {}};
    stops = true;
    return SceneDetails{.mesh = madeRoom(3, 3).build(), .receptacles = {}};
  };
  inputs_.stops = [&stops] { return stops.load(); };
  const auto stopped = bake::generateEpisodes(inputs_, options_);
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().message, "interrupted after 0 of 150 episodes");
  // The same where it cannot be read.
  inputs_.details = [&stops](std::string_view) -> Result<SceneDetails> {
    stops = true;
    return fail(ErrorCode::kInvalidInput, "attic", "is odd");
  };
  stops = false;
  const auto failed = bake::generateEpisodes(inputs_, options_);
  ASSERT_FALSE(failed.has_value());
  EXPECT_EQ(failed.error().text(), "attic: is odd");
}

TEST(ASceneJournal, TakesNoEpisodesThatCannotBe) {
  const ScratchFolder folder;
  const auto file = folder.path() / "x.partial";
  const SceneJournal::Key key{.low = 1, .high = 2};
  const auto recalled = [&](DrawnEpisode episode) {
    const auto journal = Journal::open(file, "these").value();
    const std::vector<DrawnEpisode> batch{episode};
    EXPECT_TRUE(SceneJournal(journal.get(), 2).add(key, batch));
    const auto again = Journal::open(file, "these").value();
    std::vector<DrawnEpisode> wanted(1, {.number = 7, .seed = 9});
    const bool is_there = SceneJournal(again.get(), 2).recall(key, wanted);
    again->remove();
    return is_there;
  };
  DrawnEpisode good{.number = 7, .seed = 9, .drafts = 3};
  good.placements.resize(2, {.object = 1, .pose = {}});
  good.episode.placement_count = 2;
  good.episode.target = 1;
  EXPECT_TRUE(recalled(good));
  const auto spoiled = [&](const auto& spoil) {
    DrawnEpisode episode = good;
    spoil(episode);
    return recalled(episode);
  };
  EXPECT_FALSE(spoiled([](DrawnEpisode& e) { e.number = 8; }));
  EXPECT_FALSE(spoiled([](DrawnEpisode& e) { e.seed = 8; }));
  EXPECT_FALSE(spoiled([](DrawnEpisode& e) { e.placements[1].object = 2; }));
  EXPECT_FALSE(spoiled([](DrawnEpisode& e) { e.episode.target = 2; }));
  EXPECT_FALSE(spoiled([](DrawnEpisode& e) { e.episode.placement_count = 3; }));
  EXPECT_TRUE(spoiled([](DrawnEpisode& e) {
    e.is_skipped = true;
    e.placements.clear();
  }));
}

TEST(ASceneJournal, KnowsScenesByAllThatIsKnownOfThem) {
  const SceneDetails tables{.mesh = twoTables(), .receptacles = {}};
  const auto keyOf = [](std::string_view scene, const SceneDetails& details) {
    const SceneJournal::Key key = SceneJournal::keyOf(scene, details);
    return std::pair(key.high, key.low);
  };
  SceneDetails moved = tables;
  moved.mesh.vertices.back().x += 0.001F;
  SceneDetails turned = tables;
  std::swap(turned.mesh.triangles.front(), turned.mesh.triangles.back());
  SceneDetails annotated = tables;
  annotated.receptacles.push_back({"top", {{0.5F, 0.6F, 0.6F}, {}}, {0.3F, 0.1F, 0.4F}});
  SceneDetails renamed = annotated;
  renamed.receptacles.front().name = "pot";
  const std::set keys{keyOf("room", tables),        keyOf("hall", tables),
                      keyOf("room", moved),         keyOf("room", turned),
                      keyOf("room", annotated),     keyOf("room", renamed),
                      keyOf("room", SceneDetails{})};
  EXPECT_EQ(keys.size(), 7U);
  // Another process has the name elsewhere.
  EXPECT_EQ(keyOf("room", tables), keyOf(std::string("room"), tables));
  EXPECT_EQ(keyOf("room", tables),
            keyOf("room", SceneDetails{.mesh = twoTables(), .receptacles = {}}));
}

}  // namespace
}  // namespace galactic::test::episode_journal_test
