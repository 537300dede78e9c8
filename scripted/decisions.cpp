#include "scripted/decisions.h"

#include <array>
#include <charconv>
#include <string>
#include <string_view>

#include "support/try.h"

namespace galactic::scripted {
namespace {

/// The range of actions.
constexpr float kLeast = -1;
constexpr float kMost = 1;

std::string textOf(float value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

/// A value below the threshold: 0 if possible.
float below(float threshold) { return threshold > 0 ? 0.0F : kLeast; }

/// Checks that some actions reach `threshold` and others do not. `reaching` and `not_reaching` are
/// what these actions do.
Result<void> checkParted(std::string_view option, float threshold, std::string_view reaching,
                         std::string_view not_reaching) {
  if (threshold > kLeast && threshold <= kMost) return {};
  const std::string_view missing = threshold > kMost ? reaching : not_reaching;
  return fail(ErrorCode::kUnsupported, "scripted policy",
              std::string(option) + " is " + textOf(threshold) +
                  ", so that no action from -1 to 1 " + std::string(missing) +
                  "; use a number above -1 that is 1 at most");
}

}  // namespace

Result<Decisions> decisionsBy(const ActionOptions& thresholds, const TaskOptions& task) {
  RETURN_IF_ERROR(checkParted("grasp-from", thresholds.grasp, "closes the hand", "leaves it open"));
  if (task.kind == TaskKind::kRearrange) {
    RETURN_IF_ERROR(checkParted("release-below", thresholds.release, "keeps what the hand holds",
                                "lets it go"));
    if (task.needs_terminate) {
      RETURN_IF_ERROR(
          checkParted("terminate-from", thresholds.terminate, "ends the episode", "lets it go on"));
    }
  }
  Decisions decisions;
  decisions.stay_open = below(thresholds.grasp);
  decisions.go_on = below(thresholds.terminate);
  return decisions;
}

}  // namespace galactic::scripted
