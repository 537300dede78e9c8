// Packs whose numbers were changed to absurd ones: what the checks accept simulates and draws, and
// nothing in it is a number that is none.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <random>

#include "support/homes/changed_world.h"
#include "support/sanitized.h"

namespace galactic::test::absurd_numbers_test {
namespace {

constexpr int kSteps = 6;
/// The sanitizers get a tenth of what is tried without them, and the inputs of fuzz_world.
constexpr int kPart = kIsSanitized ? 10 : 1;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Bits of absurd floats, and of floats just inside of what the checks allow.
constexpr std::array kValues{1e20F,  -3e38F,  3e38F, 1e-40F,   -1e-40F,
                             790.0F, -790.0F, kNan,  kInfinity};

/// Cases on both sides of the question.
struct Count {
  int accepted = 0;
  int refused = 0;
};

void tryWord(ChangedWorld& world, std::size_t pack, std::size_t at, Count& count) {
  const std::uint32_t before = world.word(pack, at);
  for (const float value : kValues) {
    world.setWord(pack, at, std::bit_cast<std::uint32_t>(value));
    const ChangedWorld::Outcome outcome = world.use(kSteps);
    ASSERT_EQ(outcome.finding, "") << "word " << at << " of pack " << pack << " = " << value;
    ++(outcome.accepted ? count.accepted : count.refused);
  }
  world.setWord(pack, at, before);
}

void expectBothSides(const Count& count) {
  const int all = count.accepted + count.refused;
  EXPECT_GT(count.accepted, all / 10) << all;
  EXPECT_LT(count.accepted, all * 9 / 10) << all;
}

TEST(AbsurdNumbers, AreNoneInTheWorldAsItIs) {
  const ChangedWorld::Outcome outcome = ChangedWorld().use(40);
  EXPECT_TRUE(outcome.accepted);
  EXPECT_EQ(outcome.finding, "");
}

/// One test for each kind of pack, so that they run side by side.
class AbsurdNumbersIn : public testing::TestWithParam<std::size_t> {};

TEST_P(AbsurdNumbersIn, EachWordAreRefusedOrHarmless) {
  ChangedWorld world;
  Count count;
  // The bulk of a scene are cells and texels, all alike.
  constexpr std::size_t kMostWords = 1500 / kPart;
  const std::size_t words = world.wordCount(GetParam());
  std::mt19937 random(17);
  for (std::size_t n = 0; n < std::min(words, kMostWords); ++n) {
    tryWord(world, GetParam(), words > kMostWords ? random() % words : n, count);
    if (HasFatalFailure()) return;
  }
  expectBothSides(count);
}

std::string packName(const testing::TestParamInfo<std::size_t>& pack) {
  constexpr std::array kNames{"Scene", "Objects", "Robot", "Episodes"};
  return kNames[pack.param];
}

INSTANTIATE_TEST_SUITE_P(Packs, AbsurdNumbersIn, testing::Range<std::size_t>(0, 4), packName);

TEST(AbsurdNumbers, AreRefusedOrHarmlessTogether) {
  constexpr unsigned kSeed = 23;
  constexpr int kTrials = 4000 / kPart;
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  std::mt19937 random(kSeed);
  ChangedWorld world;
  Count count;
  for (int trial = 0; trial < kTrials; ++trial) {
    struct Change {
      std::size_t pack, at;
      std::uint32_t before;
    };
    std::vector<Change> changes;
    for (auto left = 1 + random() % 2; left > 0; --left) {
      const std::size_t pack = 1 + random() % 3;
      const std::size_t at = random() % world.wordCount(pack);
      const std::uint32_t before = world.word(pack, at);
      changes.push_back({pack, at, before});
      const float scaled =
          std::bit_cast<float>(before) * std::exp2(static_cast<float>(random() % 60) - 30);
      world.setWord(pack, at,
                    random() % 2 == 0 ? std::bit_cast<std::uint32_t>(scaled)
                                      : static_cast<std::uint32_t>(random()));
    }
    const ChangedWorld::Outcome outcome = world.use(kSteps);
    ASSERT_EQ(outcome.finding, "") << "trial " << trial;
    ++(outcome.accepted ? count.accepted : count.refused);
    while (!changes.empty()) {
      world.setWord(changes.back().pack, changes.back().at, changes.back().before);
      changes.pop_back();
    }
  }
  expectBothSides(count);
}

}  // namespace
}  // namespace galactic::test::absurd_numbers_test
