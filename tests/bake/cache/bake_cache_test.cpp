// Bakes that were done before: found when all is as it was, and only then.
#include "cache/bake_cache.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "support/file_content.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test::bake_cache_test {
namespace {

namespace fs = std::filesystem;
using bake::BakeCache;
using bake::BakeInputs;
using bake::CachedBake;
using bake::FileDigests;

constexpr const char* kKey = "galactic-bake 1\nradii=0.05\n";

/// A data set of two files, a pack that was made of them, and a cache.
bake::PackFigures figuresNamed(const std::string& name) {
  return {.output = "room.pack",
          .pack_bytes = 7,
          .of = bake::EpisodeFigures{.name = name, .warnings = {"look"}}};
}

std::string nameIn(const CachedBake& found) {
  return std::get<bake::EpisodeFigures>(found.figures.of).name;
}

class Cache : public testing::Test {
 protected:
  void SetUp() override {
    write("data/room.obj", "a room");
    write("data/room.mtl", "its colors");
    write("out/room.pack", "a pack");
  }
  void write(const std::string& name, std::string_view content) const {
    static_cast<void>(folder_.write(name, content));
  }
  [[nodiscard]] fs::path at(const std::string& name) const { return folder_.path() / name; }

  /// What a bake of the room depends on as it is now.
  [[nodiscard]] BakeInputs inputs(const std::string& key = kKey) const {
    FileDigests digests;
    BakeInputs inputs;
    inputs.key = key;
    for (const char* name : {"room.mtl", "room.obj"}) {
      auto digest = digests.of(at("data") / name);
      EXPECT_TRUE(digest.has_value());
      digest->name = name;
      inputs.read.files.push_back(*digest);
    }
    inputs.read.absent = {"room.png"};
    return inputs;
  }
  void store(const std::string& name = "home") const { store(inputs(), name); }
  void store(const BakeInputs& inputs, const std::string& name) const {
    const auto kept = cache_.store(inputs, at("out/room.pack"), figuresNamed(name));
    ASSERT_TRUE(kept.has_value()) << kept.error().text();
  }
  [[nodiscard]] std::optional<CachedBake> find(const std::string& key = kKey,
                                               const std::string& folder = "data") const {
    FileDigests digests;
    return cache_.find(key, at(folder), digests);
  }
  /// Files of the cache that end like this, ascending.
  [[nodiscard]] std::vector<fs::path> kept(const std::string& extension) const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(cache_.folder())) {
      if (entry.path().extension() == extension) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  ScratchFolder folder_;
  BakeCache cache_{folder_.path() / "cache"};
};

TEST_F(Cache, FindsNothingBeforeAnythingWasStored) { EXPECT_FALSE(find().has_value()); }

TEST_F(Cache, FindsWhatWasStoredWithPackAndFigures) {
  store("3 s");
  const auto found = find();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(fileContent(found->pack), "a pack");
  EXPECT_EQ(found->digest.bytes, 6U);
  EXPECT_EQ(nameIn(*found), "3 s");
  EXPECT_EQ(warningsOf(found->figures), std::vector<std::string>{"look"});
}

TEST_F(Cache, DoesNotCareAboutDatesOfFiles) {
  store();
  fs::last_write_time(at("data/room.obj"), fs::file_time_type::clock::now());
  write("data/room.mtl", "its colors");
  EXPECT_TRUE(find().has_value());
}

TEST_F(Cache, DoesNotFindWhatWasMadeOfOtherFilesOrWithAnotherKey) {
  store();
  EXPECT_FALSE(find("galactic-bake 1\nradii=0.06\n").has_value());
  EXPECT_FALSE(find("").has_value());
  write("data/room.obj", "A room");
  EXPECT_FALSE(find().has_value()) << "of one size, but not the same";
  write("data/room.obj", "a room");
  EXPECT_TRUE(find().has_value()) << "as it was";
  write("data/room.mtl", "its colors, and more");
  EXPECT_FALSE(find().has_value());
  fs::remove(at("data/room.mtl"));
  EXPECT_FALSE(find().has_value());
}

TEST_F(Cache, DoesNotFindWhatWasMadeWithoutAFileThatIsThereNow) {
  store();
  write("data/room.png", "");
  EXPECT_FALSE(find().has_value());
  fs::remove(at("data/room.png"));
  EXPECT_TRUE(find().has_value());
}

TEST_F(Cache, FindsAFolderThatWasMoved) {
  store();
  fs::rename(at("data"), at("elsewhere"));
  EXPECT_FALSE(find(kKey, "data").has_value());
  EXPECT_TRUE(find(kKey, "elsewhere").has_value());
  fs::rename(at("cache"), at("other"));
  FileDigests digests;
  EXPECT_TRUE(BakeCache(at("other")).find(kKey, at("elsewhere"), digests).has_value());
}

TEST_F(Cache, KeepsResultsOfSeveralVersionsOfAFile) {
  store("first");
  write("data/room.obj", "another room");
  // As the bake does it: a new file, not the one that the cache has, too.
  fs::remove(at("out/room.pack"));
  write("out/room.pack", "another pack");
  store("second");
  EXPECT_EQ(nameIn(*find()), "second");
  EXPECT_EQ(fileContent(find()->pack), "another pack");
  write("data/room.obj", "a room");
  ASSERT_TRUE(find().has_value());
  EXPECT_EQ(nameIn(*find()), "first");
}

TEST_F(Cache, LetsTheOldestResultsMakeWay) {
  constexpr std::size_t kMore = 3;
  const std::size_t all = BakeCache::kResultsPerKey + kMore;
  for (std::size_t n = 0; n < all; ++n) {
    write("data/room.obj", fmt::format("room {}", n));
    store(fmt::format("{}", n));
    // Ages are told apart by the entries' dates; here they are set, not waited for.
    const auto now = fs::file_time_type::clock::now();
    for (const fs::path& entry : kept(".json")) {
      if (fileContent(entry).find(fmt::format("\"name\": \"{}\"", n)) == std::string::npos)
        continue;
      fs::last_write_time(entry, now - std::chrono::hours(all - n));
    }
  }
  EXPECT_EQ(kept(".json").size(), BakeCache::kResultsPerKey);
  EXPECT_EQ(kept(".pack").size(), BakeCache::kResultsPerKey);
  for (std::size_t n = 0; n < all; ++n) {
    write("data/room.obj", fmt::format("room {}", n));
    EXPECT_EQ(find().has_value(), n >= kMore) << n;
  }
}

TEST_F(Cache, StoringTheSameAgainKeepsOneEntryWithTheLastReport) {
  store("1 s");
  store("2 s");
  EXPECT_EQ(kept(".json").size(), 1U);
  EXPECT_EQ(kept(".pack").size(), 1U);
  EXPECT_EQ(nameIn(*find()), "2 s");
}

TEST_F(Cache, DoesNotFindAPackThatWasDamaged) {
  store();
  const fs::path pack = find()->pack;
  // As a user may, who writes into the pack that the cache shares with him.
  std::fstream(at("out/room.pack"), std::ios::in | std::ios::out | std::ios::binary) << "A";
  EXPECT_EQ(fileContent(pack), "A pack") << "they are one file";
  EXPECT_FALSE(find().has_value());
  fs::remove(at("out/room.pack"));
  write("out/room.pack", "a pack");
  store();
  EXPECT_TRUE(find().has_value()) << "it is stored anew";
  fs::remove(find()->pack);
  EXPECT_FALSE(find().has_value());
}

TEST_F(Cache, TakesEntriesThatAreTruncatedForNone) {
  store("a home");
  const fs::path entry = kept(".json").at(0);
  const std::string whole = fileContent(entry);
  ASSERT_GT(whole.size(), 200U);
  std::size_t refused = 0;
  for (std::size_t size = 0; size + 1 < whole.size(); ++size) {
    std::ofstream(entry, std::ios::binary | std::ios::trunc) << whole.substr(0, size);
    refused += find().has_value() ? 0U : 1U;
  }
  // Only the line's end may be missing.
  EXPECT_EQ(refused, whole.size() - 1);
  std::ofstream(entry, std::ios::binary | std::ios::trunc) << whole;
  EXPECT_TRUE(find().has_value());
}

TEST_F(Cache, TakesGarbageForNone) {
  store("a home");
  const fs::path entry = kept(".json").at(0);
  const std::string whole = fileContent(entry);
  const auto with = [&](const std::string& part, const std::string& other) {
    std::string changed = whole;
    const std::size_t at = changed.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return changed.replace(at, part.size(), other);
  };
  const std::vector<std::string> garbage{
      "",
      "null",
      "[]",
      "{}",
      "\xff\xfe",
      std::string(1000, '['),
      with("\"version\": 5", "\"version\": 4"),
      with("\"version\": 5", "\"version\": \"5\""),
      with("\"key\": ", "\"Key\": "),
      with("\"files\": [", "\"files\": [[],"),
      with("\"files\": [", "\"files\": [[\"a\", -1, \"0\"],"),
      with("\"files\": [", "\"files\": [[\"a\", 1, \"0123456789abcdef0123456789abcdeg\"],"),
      with("\"absent\": [", "\"absent\": [1,"),
      with("\"name\": \"a home\"", "\"name\": 7"),
      with("\"scenes\": []", "\"scenes\": [1]"),
      with("\"alternative\": 3", "\"alternative\": 9"),
      with("\"warnings\": ", "\"Warnings\": "),
  };
  for (const std::string& text : garbage) {
    std::ofstream(entry, std::ios::binary | std::ios::trunc) << text;
    EXPECT_FALSE(find().has_value()) << text;
  }
  // A folder of that name is no entry either.
  fs::remove(entry);
  fs::create_directory(entry);
  EXPECT_FALSE(find().has_value());
}

TEST_F(Cache, ExplainsThatItCannotStore) {
  write("file", "no folder");
  const BakeCache blocked(at("file"));
  const auto kept = blocked.store(inputs(), at("out/room.pack"), figuresNamed("home"));
  ASSERT_FALSE(kept.has_value());
  EXPECT_EQ(kept.error().code, ErrorCode::kIo);
  EXPECT_THAT(kept.error().message, testing::HasSubstr("cannot be made a folder"));
  const auto no_pack = cache_.store(inputs(), at("out/none.pack"), figuresNamed("home"));
  ASSERT_FALSE(no_pack.has_value());
  EXPECT_EQ(no_pack.error().code, ErrorCode::kIo);
}

TEST_F(Cache, ServesSeveralThreadsAtOnce) {
  constexpr std::size_t kThreads = 4;
  constexpr std::size_t kRounds = 50;
  FileDigests digests;
  std::vector<std::size_t> found(kThreads, 0);
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      const BakeInputs of_thread = inputs(fmt::format("key {}", t % 2));
      for (std::size_t n = 0; n < kRounds; ++n) {
        if (!cache_.store(of_thread, at("out/room.pack"), figuresNamed("home"))) continue;
        found[t] += cache_.find(of_thread.key, at("data"), digests) ? 1U : 0U;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(found, testing::Each(kRounds));
  EXPECT_EQ(kept(".json").size(), 2U);
}

}  // namespace
}  // namespace galactic::test::bake_cache_test
