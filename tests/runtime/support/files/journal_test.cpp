// What long work has done is found again after any end, and no other file is touched.
#include "support/files/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "support/file_content.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test::journal_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAreArray;

class AJournal : public testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<Journal> open(const std::string& subject = "these") const {
    return Journal::open(file(), subject).value();
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "x.pack.partial"; }
  void write(const std::string& text) const {
    std::ofstream(file(), std::ios::binary | std::ios::trunc) << text;
  }
  [[nodiscard]] std::string text() const { return fileContent(file()); }
  /// Bytes that look like parts of its file.
  const std::string first_ = std::string("3 0\n\0x\n", 7);
  const std::string second_ = "galactic journal\nthese\n";
  const std::string third_;

 private:
  ScratchFolder folder_;
};

TEST_F(AJournal, GivesBackAnyBytesInTheirOrder) {
  {
    const auto journal = open();
    EXPECT_THAT(journal->records(), IsEmpty());
    for (const std::string& record : {first_, second_, third_}) ASSERT_TRUE(journal->add(record));
    EXPECT_THAT(journal->records(), IsEmpty());
  }
  EXPECT_THAT(open()->records(), ElementsAre(first_, second_, third_));
  ASSERT_TRUE(open()->add("more"));
  EXPECT_THAT(open()->records(), ElementsAre(first_, second_, third_, "more"));
}

TEST_F(AJournal, OfAnotherSubjectIsReplacedByTheFirstRecord) {
  ASSERT_TRUE(open("these")->add(first_));
  // One subject that begins as another.
  for (const char* other : {"those", "thes", "these "}) {
    const auto journal = open(other);
    EXPECT_THAT(journal->records(), IsEmpty());
    // Whoever only looked leaves it as it was.
    journal->remove();
    EXPECT_THAT(open("these")->records(), ElementsAre(first_));
  }
  ASSERT_TRUE(open("those")->add(second_));
  EXPECT_THAT(open("these")->records(), IsEmpty());
  EXPECT_THAT(open("those")->records(), ElementsAre(second_));
}

TEST_F(AJournal, ForgetsWhatAKilledProcessWasWriting) {
  ASSERT_TRUE(open()->add(first_));
  const std::size_t one = text().size();
  ASSERT_TRUE(open()->add(second_));
  const std::string whole = text();
  for (std::size_t length = one; length < whole.size(); ++length) {
    write(whole.substr(0, length));
    ASSERT_THAT(open()->records(), ElementsAre(first_)) << length;
    // What is added then is no part of what was damaged.
    ASSERT_TRUE(open()->add(third_));
    ASSERT_THAT(open()->records(), ElementsAre(first_, third_)) << length;
  }
  // Killed while it was begun.
  const std::string begun = "galactic journal\nthese\n";
  for (std::size_t length = 0; length < begun.size(); ++length) {
    write(begun.substr(0, length));
    ASSERT_THAT(open()->records(), IsEmpty()) << length;
  }
}

TEST_F(AJournal, TakesNoRecordThatIsDamaged) {
  ASSERT_TRUE(open()->add(first_));
  const std::size_t one = text().size();
  ASSERT_TRUE(open()->add("twelve bytes"));
  const std::string whole = text();
  for (std::size_t at = one; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    write(damaged);
    ASSERT_THAT(open()->records(), ElementsAre(first_)) << at;
  }
  // A size that nothing has, in front of what is left.
  for (const char* size : {"18446744073709551615", "99999999999999999999999", "-1", ""}) {
    write(whole.substr(0, one) + size + " 0\nx\n");
    ASSERT_THAT(open()->records(), ElementsAre(first_)) << size;
  }
}

TEST_F(AJournal, LeavesFilesOfOtherKindsAlone) {
  for (const char* other : {"my notes\n", "galactic journey\nthese\n"}) {
    write(other);
    const auto refused = Journal::open(file(), "these");
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(refused.error().where, file().string());
    EXPECT_THAT(refused.error().message, HasSubstr("another kind, or of another version; move it"));
    EXPECT_EQ(text(), other);
  }
}

TEST_F(AJournal, CanBeAddedToByManyThreads) {
  std::vector<std::string> added;
  for (int n = 0; n < 400; ++n) added.push_back(std::string(static_cast<std::size_t>(n), 'a'));
  {
    const auto journal = open();
    std::vector<std::thread> threads;
    for (std::size_t first = 0; first < 4; ++first) {
      threads.emplace_back([&, first] {
        for (std::size_t n = first; n < added.size(); n += 4) EXPECT_TRUE(journal->add(added[n]));
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  EXPECT_THAT(open()->records(), UnorderedElementsAreArray(added));
}

TEST_F(AJournal, IsGoneOnceTheOutputIsThere) {
  const auto journal = open();
  ASSERT_TRUE(journal->add(first_));
  journal->remove();
  EXPECT_FALSE(std::filesystem::exists(file()));
  EXPECT_THAT(open()->records(), IsEmpty());
}

TEST_F(AJournal, SaysWhereItCannotBeKept) {
  const auto isRefused = [](const Result<void>& done) {
    return !done.has_value() && done.error().code == ErrorCode::kIo;
  };
  const auto nowhere = Journal::open(file() / "x", "these").value();
  EXPECT_TRUE(isRefused(nowhere->add(first_)));
  EXPECT_TRUE(isRefused(nowhere->add(first_)));
  std::filesystem::create_directory(file());
  const auto folder = Journal::open(file(), "these");
  ASSERT_FALSE(folder.has_value());
  EXPECT_EQ(folder.error().code, ErrorCode::kIo);
  std::filesystem::remove(file());
  ASSERT_EQ(::mkfifo(file().c_str(), 0600), 0);
  EXPECT_FALSE(Journal::open(file(), "these").has_value());
}

TEST_F(AJournal, OverwritesNoFileThatItCannotRead) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  write("mine");
  std::filesystem::permissions(file(), std::filesystem::perms::none);
  const auto refused = Journal::open(file(), "these");
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace galactic::test::journal_test
