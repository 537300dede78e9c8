#include "json/gzip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <random>
#include <string>

#include "support/gzip_text.h"

namespace galactic::test::gzip_test {
namespace {

constexpr std::size_t kPlenty = std::size_t{64} << 20U;
constexpr unsigned kSeed = 20231204;

Result<std::string> unpack(const std::string& bytes, std::size_t limit = kPlenty) {
  return bake::gunzip(std::as_bytes(std::span(bytes)), "set.json.gz", limit);
}

void expectRefused(const Result<std::string>& result, const std::string& message) {
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(result.error().where, "set.json.gz");
  EXPECT_EQ(result.error().message, message);
}

/// Text that compresses a little.
std::string someText(std::size_t length) {
  std::mt19937 random(kSeed);
  std::string text;
  text.reserve(length);
  for (std::size_t n = 0; n < length; ++n) text += static_cast<char>('a' + random() % 20);
  return text;
}

/// The most memory that this process ever had.
long peakKilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(Gzip, GivesBackWhatWasPacked) {
  for (const std::size_t length : {0U, 1U, 1000U, 65535U, 65536U, 65537U, 1'000'000U}) {
    SCOPED_TRACE(length);
    const std::string text = someText(length);
    const auto unpacked = unpack(gzipped(text));
    ASSERT_TRUE(unpacked.has_value()) << unpacked.error().message;
    EXPECT_EQ(*unpacked, text);
  }
}

TEST(Gzip, ReadsSeveralMembersAsOneText) {
  const auto unpacked = unpack(gzipped("{\"a\":") + gzipped("") + gzipped(" 1}"));
  ASSERT_TRUE(unpacked.has_value()) << unpacked.error().message;
  EXPECT_EQ(*unpacked, "{\"a\": 1}");
}

TEST(Gzip, KnowsItsFilesByTheirFirstBytes) {
  const auto is_gzip = [](std::string_view text) {
    return bake::isGzip(std::as_bytes(std::span(text)));
  };
  EXPECT_TRUE(is_gzip(gzipped("x")));
  EXPECT_FALSE(is_gzip("{}"));
  EXPECT_FALSE(is_gzip("\x1f"));
  EXPECT_FALSE(is_gzip(""));
}

TEST(Gzip, RefusesEveryTruncation) {
  const std::string whole = gzipped(someText(300));
  for (std::size_t length = 2; length < whole.size(); ++length) {
    SCOPED_TRACE(length);
    expectRefused(unpack(whole.substr(0, length)),
                  "ends in the middle of its gzip data; fetch or make it again");
  }
}

TEST(Gzip, RefusesDamageThatItsChecksumShows) {
  const std::string whole = gzipped(someText(300));
  std::size_t refused = 0;
  // The first ten bytes are a header in which a time or a system may change harmlessly.
  for (std::size_t at = 10; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    const auto unpacked = unpack(damaged);
    EXPECT_FALSE(unpacked.has_value()) << at;
    if (!unpacked) ++refused;
  }
  EXPECT_EQ(refused, whole.size() - 10);
}

TEST(Gzip, RefusesWhatStandsBehindIt) {
  expectRefused(unpack(gzipped("{}") + "junk"),
                "has 4 bytes after its gzip data that are not gzip; is it whole?");
}

TEST(Gzip, StopsABombAtTheLimit) {
  const std::string bomb = gzipped(std::string(20'000'000, ' '));
  ASSERT_LT(bomb.size(), 50'000U);
  expectRefused(unpack(bomb, 1'000'000),
                "holds more than 1000000 bytes, at most so many are read; split it");
}

TEST(Gzip, TakesNoMemoryForABomb) {
  const std::string member = gzipped(std::string(10'000'000, ' '));
  std::string bomb;
  for (int n = 0; n < 30; ++n) bomb += member;
  constexpr std::size_t kLimit = 250'000'000;
  // A tenth of the limit: what the allocator may do besides.
  constexpr long kSpareKilobytes = 25'000;
  const long before = peakKilobytes();
  expectRefused(unpack(bomb, kLimit),
                "holds more than 250000000 bytes, at most so many are read; split it");
  EXPECT_LT(peakKilobytes() - before, kSpareKilobytes);
}

TEST(Gzip, TakesATextThatJustFits) {
  const std::string text(100'000, 'x');
  const auto fits = unpack(gzipped(text), text.size());
  ASSERT_TRUE(fits.has_value()) << fits.error().message;
  EXPECT_EQ(fits->size(), text.size());
  EXPECT_FALSE(unpack(gzipped(text), text.size() - 1).has_value());
}

}  // namespace
}  // namespace galactic::test::gzip_test
