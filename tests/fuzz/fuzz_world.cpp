// Any bytes as changes of the packs of a small home, seven bytes each: which pack, the place of a
// word in it (two bytes), and what stands there then (four bytes). Headers are made to fit. What
// the checks accept is simulated and drawn, and nothing may become a number that is none.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "finding.h"
#include "support/homes/changed_world.h"
#include "support/homes/every_option.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static galactic::test::ChangedWorld world;
  struct Change {
    std::size_t pack = 0;
    std::size_t at = 0;
    std::uint32_t before = 0;
  };
  constexpr std::size_t kMostChanges = 8;
  constexpr std::size_t kChangeBytes = 7;
  Change changes[kMostChanges];
  const std::size_t count = std::min(size / kChangeBytes, kMostChanges);
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint8_t* bytes = data + n * kChangeBytes;
    Change& change = changes[n];
    change.pack = bytes[0] % world.packCount();
    change.at = (bytes[1] + 256U * bytes[2]) % world.wordCount(change.pack);
    change.before = world.word(change.pack, change.at);
    std::uint32_t value = 0;
    std::memcpy(&value, bytes + 3, sizeof(value));
    world.setWord(change.pack, change.at, value);
  }
  constexpr int kSteps = 8;
  const auto outcome =
      world.use(kSteps, galactic::test::everySensor(), galactic::test::everyReward());
  if (!outcome.finding.empty()) galactic::test::reportFinding(outcome.finding);
  for (std::size_t n = count; n-- > 0;) {
    world.setWord(changes[n].pack, changes[n].at, changes[n].before);
  }
  return 0;
}
