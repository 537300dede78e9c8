#pragma once
#include <cstddef>
#include <string>

namespace galactic::detail {

/// Refuses a call that breaks what the function's documentation requires: throws an ErrorException
/// with kInvalidInput. `call`: "BatchSimulator::step".
[[noreturn]] void refuseCall(const char* call, std::string message);

[[noreturn]] void refuseLength(const char* call, const char* array, std::size_t found,
                               std::size_t expected);

/// Checks that an array of a batch has the length that its shape gives. `array`: "actions".
inline void checkLength(const char* call, const char* array, std::size_t found,
                        std::size_t expected) {
  if (found != expected) [[unlikely]] {
    refuseLength(call, array, found, expected);
  }
}

[[noreturn]] void refuseIndex(const char* call, const char* index, std::size_t found,
                              std::size_t count);

/// `index`: "env".
inline void checkIndex(const char* call, const char* index, std::size_t found, std::size_t count) {
  if (found >= count) [[unlikely]] {
    refuseIndex(call, index, found, count);
  }
}

}  // namespace galactic::detail
