// A written file is there whole, or the old one is.
#include "support/files/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "support/file_content.h"
#include "support/files/output_files.h"
#include "support/scratch_folder.h"

namespace galactic::atomic_file_test {
namespace {

std::span<const std::byte> bytesOf(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

std::vector<std::string> namesIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

/// Limits the size of files that this process writes, so that a write fails half way; the signal
/// that would end the process is ignored meanwhile.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &before_), 0);
    rlimit lower = before_;
    lower.rlim_cur = bytes;
    previous_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &lower), 0);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, previous_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  using Handler = void (*)(int);

  rlimit before_{};
  Handler previous_handler_ = SIG_DFL;
};

TEST(AtomicFile, HoldsItsPartsOneAfterTheOther) {
  const test::ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "scene.pack";
  ASSERT_TRUE(writeFileAtomically(path, {bytesOf("head"), bytesOf(""), bytesOf("payload")}));
  EXPECT_EQ(test::fileContent(path), "headpayload");
  EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"scene.pack"});
  ASSERT_TRUE(writeFileAtomically(path, "a text"));
  EXPECT_EQ(test::fileContent(path), "a text");
}

TEST(AtomicFile, FollowsLinksToWhatIsNotThereYet) {
  const test::ScratchFolder folder;
  const std::filesystem::path scratch = folder.path() / "scratch";
  std::filesystem::create_directory(scratch);
  std::filesystem::create_symlink("scratch/second", folder.path() / "first");
  std::filesystem::create_symlink(scratch / "run.rec", scratch / "second");
  EXPECT_EQ(followLinks(folder.path() / "first"), scratch / "run.rec");
  EXPECT_TRUE(isSameFile(folder.path() / "first", scratch / "run.rec"));
  ASSERT_TRUE(writeFileAtomically(folder.path() / "first", {bytesOf("recorded")}));
  EXPECT_EQ(test::fileContent(scratch / "run.rec"), "recorded");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "first"));
  EXPECT_TRUE(std::filesystem::is_symlink(scratch / "second"));
}

TEST(AtomicFile, LeavesLinksAloneThatLeadInACircle) {
  const test::ScratchFolder folder;
  const std::filesystem::path link = folder.path() / "link";
  std::filesystem::create_symlink("link", link);
  const Result<void> written = writeFileAtomically(link, {});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kIo);
  EXPECT_EQ(written.error().message, "cannot write the file: Too many levels of symbolic links");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
}

TEST(AtomicFile, MayBeEmpty) {
  const test::ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "empty";
  ASSERT_TRUE(writeFileAtomically(path, {}));
  EXPECT_EQ(test::fileContent(path), "");
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(AtomicFile, ReplacesAnOldFileWhichItsReadersKeep) {
  const test::ScratchFolder folder;
  const std::filesystem::path path = folder.write("scene.pack", "old");
  std::ifstream reader(path);
  ASSERT_TRUE(writeFileAtomically(path, {bytesOf("new and longer")}));
  EXPECT_EQ(test::fileContent(path), "new and longer");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), "old");
  EXPECT_EQ(namesIn(folder.path()).size(), 1U);
}

TEST(AtomicFile, IsWrittenBesideARelativePathWithoutAFolder) {
  const test::ScratchFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const auto written = writeFileAtomically("scene.pack", {bytesOf("content")});
  std::filesystem::current_path(before);
  ASSERT_TRUE(written);
  EXPECT_EQ(test::fileContent(folder.path() / "scene.pack"), "content");
}

TEST(AtomicFile, LeavesTheOldOneAndNoOtherWhenTheDiskIsFull) {
  const test::ScratchFolder folder;
  const std::filesystem::path path = folder.write("scene.pack", "old");
  const std::string big(300000, 'x');
  {
    const FileSizeLimit limit(100000);
    const auto written = writeFileAtomically(path, {bytesOf("head"), bytesOf(big)});
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::kIo);
    EXPECT_EQ(written.error().where, path.string());
    EXPECT_EQ(written.error().message,
              "cannot write the file: File too large; an existing file is left as it was");
  }
  EXPECT_EQ(test::fileContent(path), "old");
  EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"scene.pack"});
}

TEST(AtomicFile, IsRefusedWithTheReasonWhereNoFileCanBe) {
  const test::ScratchFolder folder;
  const std::filesystem::path file = folder.write("file", "content");
  std::filesystem::create_directory(folder.path() / "folder");
  const struct {
    const char* path;
    const char* reason;
  } cases[] = {{"file/scene.pack", "Not a directory"},
               {"missing/scene.pack", "No such file or directory"},
               {"folder", "Is a directory"}};
  for (const auto& [name, reason] : cases) {
    const std::filesystem::path path = folder.path() / name;
    const auto written = writeFileAtomically(path, {bytesOf("content")});
    ASSERT_FALSE(written) << name;
    EXPECT_EQ(written.error().code, ErrorCode::kIo);
    EXPECT_EQ(written.error().where, path.string());
    EXPECT_EQ(written.error().message, std::string("cannot write the file: ") + reason +
                                           "; an existing file is left as it was");
  }
  EXPECT_EQ(namesIn(folder.path()).size(), 2U);
  EXPECT_EQ(test::fileContent(file), "content");
}

/// A descriptor of a file or a pipe, closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) { EXPECT_GE(number, 0); }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] std::string in(const std::string& folder) const {
    return folder + "/" + std::to_string(number_);
  }

 private:
  int number_;
};

TEST(AtomicFile, IsNotWhatAProcessHasOpen) {
  const test::ScratchFolder folder;
  const std::filesystem::path file = folder.write("out.txt", "kept");
  const Descriptor redirected(::open(file.c_str(), O_WRONLY));
  std::array<int, 2> ends{-1, -1};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const Descriptor reading(ends[0]);
  const Descriptor pipe(ends[1]);
  // As /dev/stdout leads to.
  const std::filesystem::path link = folder.path() / "link";
  std::filesystem::create_symlink(redirected.in("/proc/self/fd"), link);
  for (const std::string& name : {redirected.in("/dev/fd"), redirected.in("/proc/self/fd"),
                                  pipe.in("/dev/fd"), link.string()}) {
    const auto written = writeFileAtomically(name, {bytesOf("content")});
    ASSERT_FALSE(written) << name;
    EXPECT_EQ(written.error().code, ErrorCode::kIo);
    EXPECT_EQ(written.error().where, name);
    EXPECT_EQ(written.error().message,
              "cannot write the file: a device or pipe of this name is there; give another name");
  }
  EXPECT_EQ(test::fileContent(file), "kept");
  EXPECT_TRUE(isSameFile(link, file));
}

TEST(OutputFiles, ADashIsNotTheStandardOutput) {
  const Result<void> tried = tryFile("-");
  ASSERT_FALSE(tried);
  EXPECT_EQ(tried.error().code, ErrorCode::kIo);
  EXPECT_EQ(tried.error().where, "-");
  EXPECT_EQ(tried.error().message,
            "is not the standard output here; give a file's name, or ./- for a file of that name");
  EXPECT_TRUE(checkNotDash("./-"));
}

}  // namespace
}  // namespace galactic::atomic_file_test
