#pragma once
#include <utility>

#include "galactic/error.h"

namespace galactic::python {

/// An error of the library on its way to Python, where it becomes galactic.Error. May be thrown
/// without the interpreter's lock.
struct Refusal {
  Error error;
};

/// The value of a result; throws its error as a Refusal.
template <class T>
[[nodiscard]] T valueOf(Result<T> result) {
  if (!result) throw Refusal{std::move(result.error())};
  return std::move(*result);
}
inline void require(const Result<void>& result) {
  if (!result) throw Refusal{result.error()};
}

}  // namespace galactic::python
