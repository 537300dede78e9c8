#pragma once
#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "galactic/error.h"

namespace galactic::detail {

/// Remembers the first of many requirements that fails, so that a list of checks reads as one. All
/// of its errors are kInvalidInput.
class Offence {
 public:
  /// `where` is the part of the pack that is checked, for example "kitchen.pack:
  /// scene.column_grids[1]".
  explicit Offence(std::string where) : where_(std::move(where)) {}

  /// Records an offence of `field` unless `holds` is true or an earlier offence is on record. The
  /// message says what was found and what was expected; this function adds what to do.
  template <class... Args>
  void require(bool holds, std::string_view field, fmt::format_string<Args...> message,
               Args&&... args) {
    if (holds || error_) return;
    error_ = Error{
        ErrorCode::kInvalidInput, fmt::format("{}.{}", where_, field),
        fmt::format("{}; bake the pack again", fmt::format(message, std::forward<Args>(args)...))};
  }

  /// Takes over the failure of a check made elsewhere.
  void require(Result<void> result) {
    if (!result && !error_) error_ = std::move(result.error());
  }

  [[nodiscard]] bool found() const { return error_.has_value(); }
  [[nodiscard]] const std::string& where() const { return where_; }

  /// Success, or the first offence.
  [[nodiscard]] Result<void> result() const {
    if (error_) return tl::unexpected<Error>(*error_);
    return {};
  }

 private:
  std::string where_;
  std::optional<Error> error_;
};

}  // namespace galactic::detail
