// Digests of files, each read once.
#include "cache/file_digests.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <thread>

#include "galactic/bake/read_files.h"
#include "support/scratch_folder.h"

namespace galactic::test::file_digests_test {
namespace {

namespace fs = std::filesystem;
using bake::FileDigests;

TEST(FileDigests, AreThoseOfTheContentUnderThePathAsGiven) {
  const ScratchFolder folder;
  const fs::path file = folder.write("a/b.txt", "some text");
  FileDigests digests;
  const auto found = digests.of(file);
  const auto wanted = bake::describeFile(file);
  ASSERT_TRUE(found.has_value());
  ASSERT_TRUE(wanted.has_value());
  EXPECT_TRUE(sameContent(*found, *wanted));
  EXPECT_EQ(found->name, file.generic_string());
}

TEST(FileDigests, TellWhatAFileHeldWhenItWasFirstLookedAt) {
  const ScratchFolder folder;
  const fs::path file = folder.write("a.txt", "first");
  FileDigests digests;
  const auto first = digests.of(file);
  ASSERT_TRUE(first.has_value());
  static_cast<void>(folder.write("a.txt", "second"));
  fs::create_directory(folder.path() / "b");
  for (const fs::path& spelling : {file, folder.path() / "./a.txt", folder.path() / "b/../a.txt"}) {
    const auto again = digests.of(spelling);
    ASSERT_TRUE(again.has_value());
    EXPECT_TRUE(sameContent(*again, *first)) << spelling;
  }
  FileDigests fresh;
  EXPECT_FALSE(sameContent(*fresh.of(file), *first));
}

TEST(FileDigests, RefuseWhatCannotBeReadEachTime) {
  const ScratchFolder folder;
  FileDigests digests;
  for (int time = 0; time < 2; ++time) {
    const auto missing = digests.of(folder.path() / "none");
    ASSERT_FALSE(missing.has_value());
    EXPECT_EQ(missing.error().code, ErrorCode::kIo);
  }
}

TEST(FileDigests, TellWhetherFilesAreAsTheyWereRead) {
  const ScratchFolder folder;
  const auto areAsRead = [&](const bake::ReadFiles& read) {
    return FileDigests().areAsRead(read, folder.path());
  };
  bake::ReadFiles read{.files = {*bake::describeFile(folder.write("in/a.txt", "some text"))},
                       .absent = {"in/b.txt"}};
  EXPECT_FALSE(areAsRead(read)) << "names are relative to the folder";
  read.files.front().name = "in/a.txt";
  EXPECT_TRUE(areAsRead(read));
  static_cast<void>(folder.write("in/a.txt", "same size"));
  EXPECT_FALSE(areAsRead(read));
  static_cast<void>(folder.write("in/a.txt", "some text"));
  EXPECT_TRUE(areAsRead(read));
  static_cast<void>(folder.write("in/b.txt", ""));
  EXPECT_FALSE(areAsRead(read));
  fs::remove_all(folder.path() / "in");
  EXPECT_FALSE(areAsRead(read));
  EXPECT_TRUE(areAsRead({}));
}

TEST(FileDigests, AreTheSameForAllThreads) {
  const ScratchFolder folder;
  constexpr std::size_t kFiles = 8;
  constexpr std::size_t kThreads = 4;
  for (std::size_t n = 0; n < kFiles; ++n) {
    static_cast<void>(folder.write(fmt::format("{}", n), std::string(1000 * (n + 1), 'x')));
  }
  FileDigests digests;
  std::vector<std::size_t> right(kThreads, 0);
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t n = 0; n < kFiles; ++n) {
        const auto found = digests.of(folder.path() / fmt::format("{}", (n + t) % kFiles));
        right[t] += found && found->bytes == 1000 * ((n + t) % kFiles + 1) ? 1U : 0U;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::size_t count : right) EXPECT_EQ(count, kFiles);
}

}  // namespace
}  // namespace galactic::test::file_digests_test
