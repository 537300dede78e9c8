#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "galactic/robot.h"

namespace galactic::pack_tool {

/// One joint value as the user gave it, radians or meters.
struct JointValue {
  std::string name;
  float value = 0;
};

/// What the joints that are not named do.
enum class OtherJoints {
  kStart,  ///< As an episode starts.
  kZero,   ///< 0, whatever the limits; no rotation for floating joints.
};

struct JointChoice {
  std::vector<JointValue> values = {};
  OtherJoints others = OtherJoints::kStart;
};

/// The vector of joint positions for a choice. Fails with kInvalidInput on a name that is no
/// position, naming those there are, and on a value outside its limits. `where` names the pack.
[[nodiscard]] Result<std::vector<float>> jointPositions(const Robot& robot,
                                                        const JointChoice& choice,
                                                        const std::string& where);

}  // namespace galactic::pack_tool
