// Recordings: written and read back, and refused when damaged in any way.
#include "run/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "support/file_content.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::recording_test {
namespace {

using testing::HasSubstr;

constexpr std::size_t kSteps = 3;
constexpr std::size_t kHeaderBytes = 64;

RecordingSubject smallSubject() {
  RecordingSubject subject;
  subject.options.envs = 2;
  subject.options.seed = 77;
  subject.options.task.kind = TaskKind::kMobilePick;
  subject.actions = 5;
  subject.packs = {{.kind = 1, .payload_bytes = 2, .payload_xxh64 = 3},
                   {.kind = 4, .payload_bytes = 5, .payload_xxh64 = 6}};
  return subject;
}

std::vector<float> actionsAt(std::size_t step) {
  std::vector<float> actions(smallSubject().actionCount());
  for (std::size_t n = 0; n < actions.size(); ++n) {
    actions[n] = 0.1F * static_cast<float>(n) - 0.3F * static_cast<float>(step);
  }
  return actions;
}

std::uint64_t digestAt(std::size_t step) { return 0x123456789abcdef0ULL + step; }

class Recording : public testing::Test {
 protected:
  void SetUp() override {
    Result<RecordingWriter> writer = RecordingWriter::create(path_, smallSubject());
    ASSERT_TRUE(writer) << writer.error().message;
    for (std::size_t step = 0; step < kSteps; ++step) {
      ASSERT_TRUE(writer->append(actionsAt(step), digestAt(step)));
    }
    EXPECT_FALSE(std::filesystem::exists(path_)) << "seen before it was finished";
    ASSERT_TRUE(writer->finish());
    content_ = test::fileContent(path_);
  }

  /// Reads `content` to the end; the first error.
  std::optional<Error> errorOf(const std::string& content) const {
    Result<RecordingReader> reader = RecordingReader::open(folder_.write("other.rec", content));
    if (!reader) return reader.error();
    std::vector<float> actions(reader->subject().actionCount());
    for (std::uint64_t step = 0; step < reader->steps(); ++step) {
      const Result<std::uint64_t> digest = reader->next(actions);
      if (!digest) return digest.error();
    }
    return std::nullopt;
  }

  test::ScratchFolder folder_;
  std::filesystem::path path_ = folder_.path() / "run.rec";
  std::string content_;
};

TEST_F(Recording, ReadsBackWhatWasWritten) {
  Result<RecordingReader> reader = RecordingReader::open(path_);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->steps(), kSteps);
  EXPECT_EQ(reader->subject().actions, 5U);
  EXPECT_EQ(reader->subject().packs, smallSubject().packs);
  EXPECT_EQ(reader->subject().options.envs, 2U);
  EXPECT_EQ(reader->subject().options.seed, 77U);
  EXPECT_EQ(reader->subject().options.task.kind, TaskKind::kMobilePick);
  for (std::size_t step = 0; step < kSteps; ++step) {
    std::vector<float> actions(smallSubject().actionCount());
    const Result<std::uint64_t> digest = reader->next(actions);
    ASSERT_TRUE(digest) << digest.error().message;
    EXPECT_EQ(*digest, digestAt(step));
    EXPECT_EQ(actions, actionsAt(step));
  }
}

TEST_F(Recording, IsTheSameBytesEachTime) {
  const std::string before = content_;
  std::filesystem::remove(path_);
  SetUp();
  EXPECT_EQ(content_, before);
}

TEST_F(Recording, LeavesNothingWhenItIsNotFinished) {
  const std::filesystem::path path = folder_.path() / "unfinished.rec";
  {
    Result<RecordingWriter> writer = RecordingWriter::create(path, smallSubject());
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->append(actionsAt(0), 1));
  }
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().filename(), "run.rec");
    ++files;
  }
  EXPECT_EQ(files, 1U);
}

TEST_F(Recording, RefusesEveryTruncation) {
  EXPECT_TRUE(errorOf(content_ + "x"));
  EXPECT_FALSE(errorOf(content_));
  for (std::size_t length = content_.size(); length-- > 0;) {
    std::filesystem::resize_file(path_, length);
    const Result<RecordingReader> reader = RecordingReader::open(path_);
    ASSERT_FALSE(reader) << length;
    ASSERT_EQ(reader.error().code, ErrorCode::kInvalidInput) << length;
    ASSERT_EQ(reader.error().where, path_.string());
  }
}

TEST_F(Recording, RefusesAFlippedBitInEveryByte) {
  ASSERT_FALSE(content_.empty());
  ASSERT_FALSE(errorOf(content_));
  for (std::size_t byte = 0; byte < content_.size(); ++byte) {
    std::string damaged = content_;
    damaged[byte] =
        static_cast<char>(static_cast<unsigned char>(damaged[byte]) ^ (1U << (byte % 8)));
    ASSERT_TRUE(errorOf(damaged)) << byte;
  }
}

TEST_F(Recording, SaysWhatIsWrong) {
  const auto with = [&](std::size_t offset, auto value) {
    std::string changed = content_;
    std::memcpy(changed.data() + offset, &value, sizeof(value));
    return errorOf(changed).value_or(Error{});
  };
  EXPECT_THAT(errorOf("hello")->message, HasSubstr("is not a recording"));
  EXPECT_THAT(with(0, 'X').message, HasSubstr("is not a recording"));
  const Error later = with(8, 2U);
  EXPECT_EQ(later.code, ErrorCode::kUnsupported);
  EXPECT_THAT(later.message, HasSubstr("format version 2, expected 1"));
  EXPECT_THAT(with(12, 0U).message, HasSubstr("impossible counts"));
  EXPECT_THAT(with(12, UINT32_MAX).message, HasSubstr("impossible counts"));
  EXPECT_THAT(with(32, std::uint64_t{4}).message, HasSubstr("not what 4 steps of 2 envs take"));
  EXPECT_THAT(with(32, UINT64_MAX).message, HasSubstr("not what"));
  EXPECT_THAT(with(kHeaderBytes, '\x7f').message, HasSubstr("does not match its hash"));
  EXPECT_THAT(with(content_.size() - 1, '\x7f').message, HasSubstr("damaged at step 2"));
  const auto missing = RecordingReader::open(folder_.path() / "missing.rec");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kIo);
  const auto directory = RecordingReader::open(folder_.path());
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace galactic::recording_test
