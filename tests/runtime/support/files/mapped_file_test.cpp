#include "support/files/mapped_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

namespace galactic::test::mapped_file_test {
namespace {

/// A file in the test's folder for scratch files, gone at the end.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& text) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string(test->test_suite_name()) + "." + test->name());
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~ScratchFile() { std::filesystem::remove(path_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string text(const MappedFile& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

TEST(MappedFile, ShowsTheBytesOfAFile) {
  const ScratchFile scratch("column grid");
  const Result<MappedFile> file = MappedFile::open(scratch.path());
  ASSERT_TRUE(file.has_value()) << file.error().message;
  EXPECT_EQ(text(*file), "column grid");
}

TEST(MappedFile, ShowsNothingOfAnEmptyFile) {
  const ScratchFile scratch("");
  const Result<MappedFile> file = MappedFile::open(scratch.path());
  ASSERT_TRUE(file.has_value()) << file.error().message;
  EXPECT_TRUE(file->bytes().empty());
}

TEST(MappedFile, KeepsItsBytesWhereTheyAreWhenItIsMoved) {
  const ScratchFile scratch("spans");
  Result<MappedFile> file = MappedFile::open(scratch.path());
  ASSERT_TRUE(file.has_value());
  const std::byte* address = file->bytes().data();
  MappedFile moved = std::move(*file);
  EXPECT_EQ(moved.bytes().data(), address);
  Result<MappedFile> other = MappedFile::open(scratch.path());
  ASSERT_TRUE(other.has_value());
  *other = std::move(moved);
  EXPECT_EQ(other->bytes().data(), address);
  EXPECT_EQ(text(*other), "spans");
}

TEST(MappedFile, SaysThatAFileIsMissing) {
  const Result<MappedFile> file = MappedFile::open("/nowhere/kitchen.pack");
  ASSERT_FALSE(file.has_value());
  EXPECT_EQ(file.error().code, ErrorCode::kIo);
  EXPECT_EQ(file.error().where, "/nowhere/kitchen.pack");
  EXPECT_EQ(file.error().message, "cannot open the file: No such file or directory");
}

TEST(MappedFile, RefusesAFolder) {
  const Result<MappedFile> file = MappedFile::open(testing::TempDir());
  ASSERT_FALSE(file.has_value());
  EXPECT_EQ(file.error().code, ErrorCode::kIo);
  EXPECT_EQ(file.error().message, "is not a regular file; give the path of a file");
}

}  // namespace
}  // namespace galactic::test::mapped_file_test
