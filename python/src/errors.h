#pragma once
#include <utility>

#include "galactic/error.h"

namespace galactic::python {

/// The value of a result; throws its error as an ErrorException.
template <class T>
[[nodiscard]] T valueOf(Result<T> result) {
  if (!result) throw ErrorException{std::move(result.error())};
  return std::move(*result);
}
inline void require(const Result<void>& result) {
  if (!result) throw ErrorException{result.error()};
}

}  // namespace galactic::python
