#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace galactic {

/// Why something failed. The values are the exit codes of all tools; kInterrupted is the exit code
/// that shells report after Ctrl-C.
enum class ErrorCode {
  kIo = 2,
  kInvalidInput = 3,
  kInternal = 4,
  kUnsupported = 5,
  kInterrupted = 130
};

/// The exit codes besides those of ErrorCode: success, a wrong command line, a difference, and the
/// code of a program that was interrupted but still wrote all its files.
inline constexpr int kExitOk = 0;
inline constexpr int kExitUsage = 1;
inline constexpr int kExitDiffers = 7;
inline constexpr int kExitInterrupted = static_cast<int>(ErrorCode::kInterrupted);
/// What every tool's --help prints about exit codes.
inline constexpr const char* kExitCodesHelp =
    "Exit codes:\n"
    "  0    success\n"
    "  1    wrong command line\n"
    "  2    a file cannot be read or written\n"
    "  3    invalid input\n"
    "  4    internal error\n"
    "  5    not supported\n"
    "  7    packs, reports or runs differ\n"
    "  130  interrupted\n";

/// What went wrong and where, in words that a user can act on.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  /// The file, and inside it the element and field, for example
  /// "kitchen.pack: column_grids[1].cells".
  std::string where;
  /// One sentence: what was found, what was expected, what to do.
  std::string message;
  /// A name for use by programs, which never changes, for example "pack/hash" (docs/ci.md lists the
  /// names for packs); empty for most errors. Points to a literal.
  std::string_view name = {};

  /// "where: message", for people.
  [[nodiscard]] std::string text() const { return where + ": " + message; }
};

/// A value, or the error that prevented it.
template <class T>
using Result = tl::expected<T, Error>;

/// An error as the unexpected state of any Result. `name` is a literal.
[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string where,
                                                std::string message, std::string_view name = {}) {
  return tl::unexpected<Error>(Error{code, std::move(where), std::move(message), name});
}

/// Thrown if the caller has broken a function's rules, for example with arrays of the wrong length,
/// indices out of range or calls in the wrong order, whatever the function returns. Also thrown if
/// a function that returns no Result cannot go on, for example because a graphics processor runs
/// out of memory. Mistakes that a user can make are reported as a Result.
class ErrorException : public std::runtime_error {
 public:
  explicit ErrorException(Error error)
      : std::runtime_error(error.text()), error_(std::move(error)) {}
  [[nodiscard]] const Error& error() const noexcept { return error_; }

 private:
  Error error_;
};

/// The value, or the error as an ErrorException: for programs that use exceptions.
template <class T>
[[nodiscard]] T orThrow(Result<T> result) {
  if (!result) throw ErrorException(std::move(result).error());
  return std::move(*result);
}
inline void orThrow(Result<void> result) {
  if (!result) throw ErrorException(std::move(result).error());
}

}  // namespace galactic
