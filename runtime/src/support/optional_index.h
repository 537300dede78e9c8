#pragma once
#include <cassert>
#include <cstdint>

namespace galactic {

/// An index or none, in one number. A std::optional of it is written in two parts and returned as
/// one word, which is read once both have left the core: some 15 cycles for an answer that is
/// mostly "none".
class OptionalIndex {
 public:
  constexpr OptionalIndex() = default;
  /// Any but the largest number. Implicit, as those of a std::optional are.
  // NOLINTNEXTLINE(google-explicit-constructor)
  constexpr OptionalIndex(std::uint32_t index) : index_(index) { assert(index != kNone); }

  constexpr explicit operator bool() const { return index_ != kNone; }
  constexpr std::uint32_t operator*() const {
    assert(index_ != kNone);
    return index_;
  }

  friend constexpr bool operator==(OptionalIndex, OptionalIndex) = default;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::uint32_t index_ = kNone;
};

}  // namespace galactic
