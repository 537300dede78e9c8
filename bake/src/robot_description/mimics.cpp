#include "robot_description/mimics.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "support/try.h"

namespace galactic::bake {
namespace {

/// The largest multipliers and offsets that packs can hold: no joint follows another a thousand
/// times faster.
constexpr double kMost = 1000;

/// Finds the joints that lead other joints, through chains of them.
class MimicChains {
 public:
  MimicChains(std::span<const JointMimic> joints, const std::string& where)
      : joints_(joints), where_(where) {
    for (std::uint32_t i = 0; i < joints.size(); ++i) joint_of_name_[joints[i].joint] = i;
  }

  /// The joint that leads at the end of the chain, and how this joint follows it.
  [[nodiscard]] Result<Mimic> resolve(std::size_t joint) const;

 private:
  [[nodiscard]] Result<Mimic> followChain(std::size_t joint) const;
  [[nodiscard]] Result<void> checkMimic(std::size_t joint, const Mimic& mimic) const;
  [[nodiscard]] tl::unexpected<Error> invalid(const JointMimic& joint, std::string message) const {
    return fail(ErrorCode::kInvalidInput, fmt::format("{}: joint '{}'", where_, joint.joint),
                std::move(message));
  }

  std::span<const JointMimic> joints_;
  const std::string& where_;
  std::map<std::string_view, std::uint32_t> joint_of_name_;
};

Result<Mimic> MimicChains::resolve(std::size_t joint) const {
  ASSIGN_OR_RETURN(const auto mimic, followChain(joint));
  RETURN_IF_ERROR(checkMimic(joint, mimic));
  return mimic;
}

Result<Mimic> MimicChains::followChain(std::size_t joint) const {
  // Invariant: the joint's position is multiplier * (position of mimic.link) + offset.
  Mimic mimic{.link = static_cast<std::uint32_t>(joint), .multiplier = 1, .offset = 0};
  std::size_t steps = 0;
  while (!joints_[mimic.link].leader.empty()) {
    const JointMimic& at = joints_[mimic.link];
    const auto next = joint_of_name_.find(at.leader);
    if (next == joint_of_name_.end()) {
      return invalid(at, fmt::format("it mimics joint '{}', which does not exist; correct the name",
                                     at.leader));
    }
    if (++steps > joints_.size()) {
      return invalid(joints_[joint],
                     "it mimics itself in a circle of joints; one of them must move freely");
    }
    mimic.offset += mimic.multiplier * at.offset;
    mimic.multiplier *= at.multiplier;
    mimic.link = next->second;
  }
  return mimic;
}

Result<void> MimicChains::checkMimic(std::size_t joint, const Mimic& mimic) const {
  const JointMimic& follower = joints_[joint];
  const JointMimic& leader = joints_[mimic.link];
  for (const JointMimic* end : {&follower, &leader}) {
    if (positionCount(end->type) == 1) continue;
    return invalid(follower,
                   fmt::format("it mimics '{}', and '{}' is a joint without a single position "
                               "(fixed, planar or floating); remove the <mimic>",
                               leader.joint, end->joint));
  }
  if (!(std::abs(mimic.multiplier) <= kMost && std::abs(mimic.offset) <= kMost)) {
    return invalid(follower, fmt::format("the multiplier {} or offset {} of its <mimic> is not "
                                         "finite or over {}; correct it",
                                         mimic.multiplier, mimic.offset, kMost));
  }
  return {};
}

}  // namespace

Result<std::vector<std::optional<Mimic>>> resolveMimics(std::span<const JointMimic> joints,
                                                        const std::string& where) {
  const MimicChains chains(joints, where);
  std::vector<std::optional<Mimic>> resolved(joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].leader.empty()) continue;
    ASSIGN_OR_RETURN(resolved[i], chains.resolve(i));
  }
  return resolved;
}

}  // namespace galactic::bake
