#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "galactic/robot.h"

namespace galactic::pack_tool {

/// The link whose joint owns each position of the robot, one per position. Of several joints with
/// one position the first that takes it as it is; the others mimic it.
[[nodiscard]] std::vector<std::uint32_t> positionOwners(const Robot& robot);

/// What the user calls each position: the joint's name; with ".x", ".y" and ".angle" for planar
/// joints; with ".x", ".y", ".z", ".qx", ".qy", ".qz" and ".qw" for floating ones.
[[nodiscard]] std::vector<std::string> positionNames(const Robot& robot);

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
