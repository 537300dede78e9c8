#pragma once
#include <string>
#include <tl/expected.hpp>

namespace galactic {

/// Why something failed. The values are the exit codes of all tools.
enum class ErrorCode { kIo = 2, kInvalidInput = 3, kInternal = 4, kUnsupported = 5 };

/// Exit codes that are no error of an input: success, a wrong command line, two packs that differ.
inline constexpr int kExitOk = 0;
inline constexpr int kExitUsage = 1;
inline constexpr int kExitDiffers = 7;

/// What went wrong and where, in words a user can act on.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  /// The file, and inside it the element and field, for example
  /// "kitchen.pack: column_grids[1].cells".
  std::string where;
  /// One sentence: what was found, what was wanted, what to do.
  std::string message;
};

/// A value, or the error that stands in its way.
template <class T>
using Result = tl::expected<T, Error>;

/// An error as the unexpected state of any Result.
[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string where,
                                                std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(where), std::move(message)});
}

}  // namespace galactic
