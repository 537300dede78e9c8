#pragma once
#include <cassert>
#include <cstdint>

namespace galactic {

/// An index or none, in one number. A std::optional would be written in two parts but returned as
/// one word, which can be read only when both writes have left the core: that costs about 15 cycles
/// for an answer that is mostly "none".
class OptionalIndex {
 public:
  constexpr OptionalIndex() = default;
  /// Any number but the largest. Implicit, like the constructors of std::optional.
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
