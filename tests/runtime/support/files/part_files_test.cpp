// What killed programs leave behind is removed, and nothing else is.
#include "support/files/part_files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "support/file_content.h"
#include "support/files/atomic_file.h"
#include "support/files/output_files.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test::part_files_test {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kNow{0};

class PartFiles : public testing::Test {
 protected:
  [[nodiscard]] fs::path at(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      if (entry.is_regular_file()) {
        names.insert(entry.path().lexically_relative(folder_.path()).string());
      }
    }
    return names;
  }
  /// A part of `name` that a process of this machine began and did not finish.
  void leavePart(const std::string& name) const {
    const pid_t child = ::fork();
    if (child == 0) {
      auto file = AtomicFile::create(at(name));
      // Like a signal: nothing is cleaned up.
      ::_exit(file ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_EQ(status, 0);
  }

  ScratchFolder folder_;
};

TEST_F(PartFiles, OfKilledProcessesAreRemovedAtOnce) {
  leavePart("a.pack");
  fs::create_directories(at("below/further"));
  leavePart("below/further/b.pack");
  ASSERT_EQ(files().size(), 2U);
  EXPECT_EQ(removeStaleParts(folder_.path(), {.is_recursive = true}), 2U);
  EXPECT_TRUE(files().empty());
}

TEST_F(PartFiles, AreLookedForWhereTheCallerSays) {
  leavePart("a.pack");
  leavePart("b.pack");
  fs::create_directories(at("below"));
  leavePart("below/a.pack");
  EXPECT_EQ(removeStaleParts(folder_.path(), {.target = "a.pac"}), 0U);
  EXPECT_EQ(removeStaleParts(folder_.path(), {.target = "a.pack"}), 1U);
  EXPECT_EQ(removeStaleParts(folder_.path(), {}), 1U);
  EXPECT_EQ(files().size(), 1U);
  EXPECT_EQ(removeStaleParts(at("none"), {.is_recursive = true}), 0U);
}

TEST_F(PartFiles, AreLookedForByWhatTheirTargetsAreCalledAndAmongSoManyNames) {
  leavePart("a.png");
  leavePart("b.png");
  leavePart("a.pack");
  const auto is_picture = [](std::string_view name) { return name.ends_with(".png"); };
  EXPECT_EQ(removeStaleParts(folder_.path(), {.accepts = is_picture, .most_names = 0}), 0U);
  EXPECT_EQ(removeStaleParts(folder_.path(), {.target = "a.pack", .accepts = is_picture}), 0U);
  EXPECT_EQ(removeStaleParts(folder_.path(), {.accepts = is_picture}), 2U);
  leavePart("b.pack");
  EXPECT_EQ(removeStaleParts(folder_.path(), {.most_names = 1}), 1U);
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(PartFiles, OfAFileAreRemovedByTheNextWhoTriesToWriteIt) {
  leavePart("a.rec");
  leavePart("b.rec");
  (void)folder_.write("a.rec.part-0123456789abcdef-77-0", "another machine's");
  const auto writer = AtomicFile::create(at("a.rec"));
  ASSERT_TRUE(writer.has_value());
  ASSERT_EQ(files().size(), 4U);
  ASSERT_TRUE(tryFile(at("a.rec")).has_value());
  EXPECT_EQ(files().size(), 3U) << "what somebody writes stays";
  // Beside what a link leads to, where it was written.
  fs::create_directories(at("links"));
  fs::create_symlink("../b.rec", at("links/link.rec"));
  ASSERT_TRUE(tryFile(at("links/link.rec")).has_value());
  EXPECT_EQ(files().size(), 2U);
}

TEST_F(PartFiles, ThatAreBeingWrittenStay) {
  // By this process, whatever their age, and by another one.
  auto mine = AtomicFile::create(at("a.pack"));
  ASSERT_TRUE(mine.has_value());
  int ends[2] = {-1, -1};
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    auto theirs = AtomicFile::create(at("b.pack"));
    (void)!::write(ends[1], "x", 1);
    ::pause();
  }
  char ready = 0;
  ASSERT_EQ(::read(ends[0], &ready, 1), 1);
  ASSERT_EQ(files().size(), 2U);
  EXPECT_EQ(removeStaleParts(folder_.path(), {.age = kNow}), 0U);
  EXPECT_EQ(files().size(), 2U);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(removeStaleParts(folder_.path(), {}), 1U);
  ASSERT_TRUE(mine->publish().has_value());
  EXPECT_EQ(files(), std::set<std::string>{"a.pack"});
}

TEST_F(PartFiles, OfOtherMachinesStayUntilTheyAreOld) {
  const std::string name = "a.pack.part-0123456789abcdef-77-0";
  (void)folder_.write(name, "half");
  EXPECT_EQ(removeStaleParts(folder_.path(), {}), 0U);
  EXPECT_EQ(removeStaleParts(folder_.path(), {.age = std::chrono::seconds(3600)}), 0U);
  // Even then not while somebody holds it.
  const int held = ::open(at(name).c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_TRUE(holdPart(held, at(name)));
  EXPECT_EQ(removeStaleParts(folder_.path(), {.age = kNow}), 0U);
  ::close(held);
  EXPECT_EQ(removeStaleParts(folder_.path(), {.age = kNow}), 1U);
}

TEST_F(PartFiles, AreKnownByTheirWholeNameOnly) {
  const std::vector<std::string> others{
      "a.pack",
      "a.pack.part-1",
      "archive.part-2-0",
      ".part-0123456789abcdef-77-0",
      "a.pack.part-0123456789abcdef",
      "a.pack.part-0123456789abcdef-77",
      "a.pack.part-0123456789abcdef-77-",
      "a.pack.part-0123456789abcdef-77-0x",
      "a.pack.part-0123456789abcdef-77-0.gz",
      "a.pack.part-0123456789ABCDEF-77-0",
      "a.pack.part-0123456789abcdeg-77-0",
      "a.pack.part-0123456789abcdef--0",
  };
  for (const std::string& name : others) (void)folder_.write(name, "mine");
  fs::create_directory(at("folder.part-0123456789abcdef-77-0"));
  fs::create_symlink("a.pack", at("link.part-0123456789abcdef-77-0"));
  EXPECT_EQ(removeStaleParts(folder_.path(), {.age = kNow}), 0U);
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(at(name))) << name;
  EXPECT_TRUE(fs::is_symlink(at("link.part-0123456789abcdef-77-0")));
  EXPECT_TRUE(fs::is_directory(at("folder.part-0123456789abcdef-77-0")));
}

TEST_F(PartFiles, MayEndAsTheirTargetDoes) {
  const fs::path part = partPathOf(at("a.mp4"), 0, PartEnding::kOfTarget);
  EXPECT_EQ(part.extension(), ".mp4");
  {
    const PartFile first(at("a.mp4"), PartEnding::kOfTarget);
    ASSERT_EQ(first.error(), 0);
    EXPECT_EQ(first.path(), part);
    // Whoever writes it opens it by its name.
    (void)folder_.write(part.filename().string(), "half");
    EXPECT_EQ(removeStaleParts(folder_.path(), {.age = kNow}), 0U);
    const PartFile second(at("a.mp4"), PartEnding::kOfTarget);
    ASSERT_EQ(second.error(), 0);
    EXPECT_NE(second.path(), part);
    fs::rename(second.path(), at("a.mp4"));
  }
  EXPECT_EQ(files(), std::set<std::string>{"a.mp4"});
  (void)folder_.write(part.filename().string(), "half");
  EXPECT_EQ(removeStaleParts(folder_.path(), {.target = "b.mp4"}), 0U);
  EXPECT_EQ(removeStaleParts(folder_.path(), {.target = "a.mp4"}), 1U);
}

TEST_F(PartFiles, OfTargetsWithLongNamesHaveShorterOnes) {
  // Whatever the length, up to the longest: with characters of two bytes that must not be cut.
  for (const std::size_t size : {180U, 200U, 205U, 206U, 212U, 213U, 240U, 255U}) {
    for (const std::string& ending : {std::string(), std::string(".pack")}) {
      std::string name(size % 2, 'x');
      while (name.size() + 2 <= size - ending.size()) name += "\xC3\xA4";
      name = (name + "yyy").substr(0, size - ending.size()) + ending;
      ASSERT_EQ(name.size(), size);
      for (const PartEnding end : {PartEnding::kNumber, PartEnding::kOfTarget}) {
        EXPECT_LE(partPathOf(name, 99, end).string().size(), std::size_t{NAME_MAX});
      }
      EXPECT_EQ(partPathOf(name, 0, PartEnding::kOfTarget).extension() == ".pack", !ending.empty());
      leavePart(name);
      std::string other = name;
      other.front() = 'o';
      EXPECT_EQ(removeStaleParts(folder_.path(), {.target = other}), 0U);
      EXPECT_EQ(removeStaleParts(folder_.path(), {.target = name}), 1U) << size;
      ASSERT_TRUE(writeFileAtomically(at(name), {}).has_value());
      EXPECT_EQ(files(), std::set<std::string>{name});
      fs::remove(at(name));
    }
  }
}

TEST_F(PartFiles, OfTargetsWithTheSameBeginningAreToldApart) {
  const std::string begin(240, 'x');
  leavePart(begin + "1.pack");
  leavePart(begin + "2.pack");
  EXPECT_EQ(removeStaleParts(folder_.path(), {.target = begin + "1.pack"}), 1U);
  EXPECT_EQ(removeStaleParts(folder_.path(), {.target = begin + "2.pack"}), 1U);
}

TEST_F(PartFiles, OfANameThatIsTooLongAreRefusedAtOnce) {
  EXPECT_FALSE(AtomicFile::create(at(std::string(256, 'x'))).has_value());
}

TEST_F(PartFiles, MakeWayForTheSameThread) {
  // All names that this thread would try are taken by what was left behind.
  for (unsigned n = 0; n < 20; ++n) {
    (void)folder_.write(partPathOf("a.pack", n).filename().string(), "half");
  }
  ASSERT_TRUE(writeFileAtomically(at("a.pack"), {}).has_value());
  EXPECT_TRUE(fs::exists(at("a.pack")));
}

TEST_F(PartFiles, ArePublishedWhileOthersClearAway) {
  constexpr std::size_t kWriters = 3;
  constexpr int kRounds = 60;
  std::atomic<bool> over{false};
  std::atomic<std::size_t> removed{0};
  std::thread cleaner([&] {
    while (!over) removed += removeStaleParts(folder_.path(), {.age = kNow});
  });
  std::vector<std::thread> writers;
  writers.reserve(kWriters);
  for (std::size_t t = 0; t < kWriters; ++t) {
    writers.emplace_back([&, t] {
      const std::string content(1000 + t, 'x');
      for (int n = 0; n < kRounds; ++n) {
        const auto written = writeFileAtomically(at("pack" + std::to_string(t)),
                                                 {std::as_bytes(std::span(content))});
        ASSERT_TRUE(written.has_value()) << written.error().message;
        ASSERT_EQ(fileContent(at("pack" + std::to_string(t))), content);
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  over = true;
  cleaner.join();
  EXPECT_EQ(files(), (std::set<std::string>{"pack0", "pack1", "pack2"}));
}

}  // namespace
}  // namespace galactic::test::part_files_test
