#pragma once
#include <string_view>

namespace galactic::bake {

/// One line on a terminal that says what is being done; silent elsewhere.
class ProgressLine {
 public:
  /// `wanted` is what the user asked for; a line appears only if stderr is also a terminal.
  explicit ProgressLine(bool wanted);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Replaces the line. `fraction` from 0 to 1.
  void show(std::string_view item, std::string_view stage, double fraction);
  /// Removes the line, so that other output begins on a clean one.
  void clear();

 private:
  bool enabled_;
  bool shown_ = false;
};

}  // namespace galactic::bake
