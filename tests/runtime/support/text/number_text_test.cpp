#include "support/text/number_text.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/limited_memory.h"
#include "support/out_of_memory.h"
#include "support/sanitized.h"
#include "support/text/nearest_name.h"

namespace galactic::number_text_test {
namespace {

TEST(NumberText, TakesTheWholeTextAsANumberInItsRange) {
  for (const char* text : {"0", "1.5", "-2", "1e-3", "2", "-0"}) {
    EXPECT_EQ(numberFault(text, -2, 2), "") << text;
  }
  for (const char* text : {"", " ", "nan", "-nan", "inf", "-inf", "1e999", "2.1", "-3", "1,5", "1 ",
                           " 1", "+1", "0x1", "1m", "--1"}) {
    EXPECT_NE(numberFault(text, -2, 2), "") << text;
  }
  EXPECT_EQ(numberFault("nan", 0, 5), "found nan, expected a number from 0 to 5");
  EXPECT_EQ(numberFault("", 0, 5), "found nothing, expected a number from 0 to 5");
  // The limits of options are kept in single precision.
  EXPECT_EQ(numberFault("9", static_cast<double>(0.01F), 0.1),
            "found 9, expected a number from 0.01 to 0.1");
}

TEST(NumberText, TakesDigitsAloneAsAWholeNumber) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  for (const char* text : {"0", "7", "18446744073709551615"}) {
    EXPECT_EQ(wholeFault(text, 0, kMost), "") << text;
  }
  // One that is negative must not become huge, one too large not the largest, none octal.
  for (const char* text : {"", "-1", "18446744073709551616", "99999999999999999999", "1.0", "1e3",
                           "010", "0x10", "+1", " 1", "1 ", "nan", "1_000", "1'000"}) {
    EXPECT_NE(wholeFault(text, 0, kMost), "") << text;
  }
  EXPECT_EQ(wholeFault("-1", 1, 9), "found -1, expected a whole number from 1 to 9");
}

TEST(NearestName, IsAddedToComplaintsAboutOptions) {
  const std::vector<std::string> options{"--radii", "--report", "--seed"};
  EXPECT_EQ(withSuggestions("The following argument was not expected: --radi", options),
            "The following argument was not expected: --radi; did you mean '--radii'?");
  EXPECT_EQ(withSuggestions("unknown: --sed=3", options),
            "unknown: --sed=3; did you mean '--seed'?");
  for (const char* other : {"input is required", "unknown: --something-else", "unknown: --",
                            "--seed: found nan, expected a number from 0 to 1",
                            "--seed, --report and --radii are for scenes; leave them out"}) {
    EXPECT_EQ(withSuggestions(other, options), other);
  }
}

TEST(NearestName, PutsTheParsersComplaintsAboutValuesInOurWords) {
  const std::vector<std::string> options{"--render", "--seed"};
  EXPECT_EQ(withSuggestions("--seed: At Most 1 required but received 2", options),
            "--seed: is given 2 times; give it once");
  EXPECT_EQ(withSuggestions("--seed: 1 required UINT missing", options),
            "--seed: found no value, expected one");
  EXPECT_EQ(withSuggestions("--render: a: b not in {rgb,depth,rgbd}", options),
            "--render: found a: b, expected rgb, depth or rgbd");
}

TEST(OutOfMemory, SaysHowMuchThereIs) {
  const Error error = outOfMemory();
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_EQ(error.where, "available memory");
  EXPECT_EQ(error.message.find("this needs more than the "), 0U) << error.message;
}

TEST(OutOfMemory, IsToldBeforehandWhereItIsKnown) {
  EXPECT_TRUE(checkMemory(1e3, "3 things", "make fewer").has_value());
  const Result<void> huge = checkMemory(1e18, "3 things", "make fewer");
  ASSERT_FALSE(huge.has_value());
  EXPECT_EQ(huge.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(huge.error().where, "available memory");
  EXPECT_EQ(huge.error().message.find("3 things need 1000000000.0 GB, and there are "), 0U)
      << huge.error().message;
  EXPECT_NE(huge.error().message.find("; make fewer"), std::string::npos) << huge.error().message;
}

TEST(OutOfMemory, IsToldInMegabytesWhereItIsLittle) {
  if (test::kIsSanitized) GTEST_SKIP() << "no limit of memory holds";
  const test::LimitedMemory none(0);
  const Result<void> few = checkMemory(2.34e6, "3 things", "make fewer");
  ASSERT_FALSE(few.has_value());
  EXPECT_EQ(few.error().message, "3 things need 2.3 MB, and there are 0.0 MB; make fewer");
  const Result<void> more = checkMemory(2.34e8, "3 things", "make fewer");
  ASSERT_FALSE(more.has_value());
  EXPECT_EQ(more.error().message, "3 things need 0.2 GB, and there are 0.0 MB; make fewer");
}

}  // namespace
}  // namespace galactic::number_text_test
