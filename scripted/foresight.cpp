#include "scripted/foresight.h"

#include <algorithm>

namespace galactic::scripted {

EnvState foreseen(const Robot& robot, const EnvState& state, std::span<const float> under_way) {
  EnvState result = state;
  const ActionLayout layout = ActionLayout::of(robot);
  const RobotBase& base = *robot.base();
  const std::span<const ControlledJoint> joints = robot.controlledJoints();
  for (; !under_way.empty(); under_way = under_way.subspan(layout.count())) {
    for (std::size_t n = 0; n < joints.size(); ++n) {
      const ControlledJoint& joint = joints[n];
      float& position = result.joint_positions[joint.position];
      position = std::clamp(position + joint.step * under_way[n], joint.lower, joint.upper);
    }
    // The base first turns, then drives along its new heading.
    auto& [position, rotation] = result.world_from_root;
    rotation = rotationOfYaw(-base.turn_step * under_way[layout.turn()]) * rotation;
    const float left =
        layout.drives_sideways ? base.sideways_step * under_way[layout.sideways()] : 0.0F;
    position =
        position + rotate(rotation, {base.forward_step * under_way[layout.forward()], 0, -left});
  }
  return result;
}

}  // namespace galactic::scripted
