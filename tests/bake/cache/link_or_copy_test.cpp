// Packs are put where they belong as links, in one step.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "cache/bake_cache.h"
#include "support/file_content.h"
#include "support/files/part_files.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test::link_or_copy_test {
namespace {

namespace fs = std::filesystem;
using bake::linkOrCopy;

class LinkOrCopy : public testing::Test {
 protected:
  [[nodiscard]] fs::path at(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }
  ScratchFolder folder_;
};

TEST_F(LinkOrCopy, MakesTheTargetTheSameFile) {
  const fs::path source = folder_.write("a", "content");
  ASSERT_TRUE(linkOrCopy(source, at("b")).has_value());
  EXPECT_TRUE(fs::equivalent(source, at("b")));
  ASSERT_TRUE(linkOrCopy(source, at("b")).has_value()) << "nothing is left to do";
  ASSERT_TRUE(linkOrCopy(source, source).has_value());
  EXPECT_EQ(fileContent(at("b")), "content");
  EXPECT_EQ(files(), 2U);
}

TEST_F(LinkOrCopy, ReplacesWhatWasThereForThoseWhoOpenItLater) {
  const fs::path source = folder_.write("a", "new");
  const fs::path target = folder_.write("b", "old");
  std::ifstream reader(target);
  ASSERT_TRUE(linkOrCopy(source, target).has_value());
  EXPECT_EQ(fileContent(target), "new");
  std::string seen;
  reader >> seen;
  EXPECT_EQ(seen, "old") << "who has it open keeps what he has";
  EXPECT_EQ(files(), 2U);
}

TEST_F(LinkOrCopy, LeavesTheTargetAsItWasWhereItFails) {
  const fs::path target = folder_.write("b", "old");
  const auto missing = linkOrCopy(at("none"), target);
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::kIo);
  EXPECT_EQ(missing.error().where, target.string());
  EXPECT_THAT(missing.error().message, testing::HasSubstr("an existing file is left as it was"));
  EXPECT_EQ(fileContent(target), "old");
  const fs::path source = folder_.write("a", "new");
  EXPECT_FALSE(linkOrCopy(source, at("no folder/b")).has_value());
  fs::create_directory(at("c"));
  EXPECT_FALSE(linkOrCopy(source, at("c")).has_value()) << "a folder is not replaced";
  EXPECT_EQ(files(), 3U) << "and nothing is left over";
}

TEST_F(LinkOrCopy, LinksWhereAllNamesForItAreTakenByWhatWasLeftBehind) {
  const fs::path source = folder_.write("a", "content");
  for (unsigned n = 0; n < 20; ++n) {
    (void)folder_.write(partPathOf("b", n).filename().string(), "half");
  }
  ASSERT_TRUE(linkOrCopy(source, at("b")).has_value());
  EXPECT_TRUE(fs::equivalent(source, at("b")));
}

TEST_F(LinkOrCopy, CopiesToAnotherFileSystem) {
  const fs::path memory = "/dev/shm";
  std::error_code problem;
  if (!fs::is_directory(memory, problem)) GTEST_SKIP() << "there is no /dev/shm";
  std::string name = (memory / "galactic-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) GTEST_SKIP() << "nothing may be written to /dev/shm";
  const fs::path source = folder_.write("a", "content");
  const fs::path target = fs::path(name) / "b";
  const auto copied = linkOrCopy(source, target);
  EXPECT_TRUE(copied.has_value());
  EXPECT_EQ(fileContent(target), "content");
  fs::remove_all(name);
}

TEST_F(LinkOrCopy, LeavesNothingOverWhereThreadsLinkToOneName) {
  const fs::path source = folder_.write("a", "content");
  constexpr std::size_t kThreads = 4;
  constexpr std::size_t kRounds = 500;
  for (std::size_t round = 0; round < kRounds; ++round) {
    std::error_code ignored;
    fs::remove(at("b"), ignored);
    std::vector<std::thread> threads;
    threads.reserve(kThreads);
    for (std::size_t t = 0; t < kThreads; ++t) {
      threads.emplace_back([&] { EXPECT_TRUE(linkOrCopy(source, at("b")).has_value()); });
    }
    for (std::thread& thread : threads) thread.join();
    ASSERT_EQ(files(), 2U) << "round " << round;
  }
}

}  // namespace
}  // namespace galactic::test::link_or_copy_test
