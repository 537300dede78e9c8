#include "run/policy.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>

namespace galactic {
namespace {

/// The highest 24 bits of a word as a number in [-1, 1).
float symmetric(std::uint32_t word) { return static_cast<float>(word >> 8U) * 0x1p-23F - 1; }

class ZeroPolicy final : public Policy {
 public:
  Result<void> act(std::uint64_t, std::span<float> actions) override {
    std::ranges::fill(actions, 0.0F);
    return {};
  }
};

class RandomPolicy final : public Policy {
 public:
  enum class Drive { kAnywhere, kAhead };

  RandomPolicy(const PolicyShape& shape, Drive drive) : shape_(shape), drive_(drive) {}

  Result<void> act(std::uint64_t step, std::span<float> actions) override {
    const std::size_t count = shape_.actions.count();
    for (std::size_t env = 0; env < actions.size() / count; ++env) {
      fillRow(actions.subspan(env * count, count), step, shape_.first_env + env);
    }
    return {};
  }

 private:
  [[nodiscard]] std::uint64_t hash(std::uint64_t step, std::uint64_t env,
                                   std::uint64_t counter) const {
    const std::array<std::uint64_t, 3> what{step, env, counter};
    return XXH3_64bits_withSeed(what.data(), sizeof(what), shape_.seed);
  }

  void fillRow(std::span<float> row, std::uint64_t step, std::uint64_t env) const {
    for (std::size_t n = 0; n < row.size(); n += 2) {
      const std::uint64_t bits = hash(step, env, n);
      row[n] = symmetric(static_cast<std::uint32_t>(bits));
      if (n + 1 < row.size()) row[n + 1] = symmetric(static_cast<std::uint32_t>(bits >> 32U));
    }
    float& forward = row[shape_.actions.forward()];
    if (drive_ == Drive::kAhead) forward = 0.5F + 0.5F * forward;
    constexpr std::uint64_t kTerminateEvery = 500;
    row[shape_.actions.terminate()] =
        hash(step, env, row.size()) % kTerminateEvery == 0 ? 1.0F : 0.0F;
  }

  PolicyShape shape_;
  Drive drive_;
};

}  // namespace

bool isGeneratedPolicy(std::string_view name) {
  return name == "random" || name == "forward" || name == "zero";
}

std::unique_ptr<Policy> makeGeneratedPolicy(std::string_view name, const PolicyShape& shape) {
  if (name == "zero") return std::make_unique<ZeroPolicy>();
  const auto drive =
      name == "forward" ? RandomPolicy::Drive::kAhead : RandomPolicy::Drive::kAnywhere;
  return std::make_unique<RandomPolicy>(shape, drive);
}

}  // namespace galactic
