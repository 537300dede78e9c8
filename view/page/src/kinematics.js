// Forward kinematics, as runtime/src/pack/kinematics.cpp has it.
import { Quaternion, Vector3 } from "three";

export class Pose {
  constructor(position = new Vector3(), rotation = new Quaternion()) {
    this.position = position;
    this.rotation = rotation;
  }
  /// Of seven numbers: x, y, z, then the quaternion's x, y, z, w.
  static of(numbers, at = 0) {
    return new Pose(new Vector3(numbers[at], numbers[at + 1], numbers[at + 2]),
      new Quaternion(numbers[at + 3], numbers[at + 4], numbers[at + 5], numbers[at + 6]));
  }
  times(other) {
    return new Pose(this.apply(other.position), this.rotation.clone().multiply(other.rotation));
  }
  apply(point) {
    return point.clone().applyQuaternion(this.rotation).add(this.position);
  }
  /// A share of the way to another one.
  mixed(other, share) {
    return new Pose(this.position.clone().lerp(other.position, share), this.rotation.clone().slerp(other.rotation, share));
  }
}

const kType = { fixed: 0, revolute: 1, continuous: 2, prismatic: 3, planar: 4, floating: 5 };
export const kPositions = [0, 1, 1, 1, 3, 7];

/// The two directions of a planar joint: the part of X across the axis, or of Z where the axis is
/// nearly X; and axis x first.
function planarDirections(axis) {
  const from = Math.abs(axis.x) >= 0.99 ? new Vector3(0, 0, 1) : new Vector3(1, 0, 0);
  const first = from.addScaledVector(axis, -from.dot(axis)).normalize();
  return [first, axis.clone().cross(first)];
}

function jointPose(link, positions) {
  const axis = new Vector3(...link.axis);
  const raw = (n) => positions[link.position + n];
  switch (link.type) {
    case kType.revolute:
    case kType.continuous:
      return new Pose(new Vector3(), new Quaternion().setFromAxisAngle(axis, raw(0) * link.multiplier + link.offset));
    case kType.prismatic:
      return new Pose(axis.multiplyScalar(raw(0) * link.multiplier + link.offset));
    case kType.planar: {
      const [first, second] = planarDirections(axis);
      return new Pose(first.multiplyScalar(raw(0)).addScaledVector(second, raw(1)),
        new Quaternion().setFromAxisAngle(axis, raw(2)));
    }
    case kType.floating:
      return new Pose(new Vector3(raw(0), raw(1), raw(2)),
        new Quaternion(raw(3), raw(4), raw(5), raw(6)).normalize());
    default:
      return new Pose();
  }
}

/// A share of the way between two vectors of positions. The simulation keeps the angle of a continuous joint
/// within a turn: such a joint goes the shorter way around.
export function mixedPositions(links, from, to, share) {
  const ways = from.map((value, n) => to[n] - value);
  for (const { type, position } of links) {
    if (type === kType.continuous) ways[position] -= 2 * Math.PI * Math.round(ways[position] / (2 * Math.PI));
  }
  return from.map((value, n) => value + share * ways[n]);
}

/// The pose of each link in the world.
export function linkPoses(links, worldFromRoot, positions) {
  const poses = [];
  for (const link of links) {
    if (link.parent < 0) {
      poses.push(worldFromRoot);
      continue;
    }
    const joint = poses[link.parent].times(Pose.of(link.frame));
    poses.push(link.type === kType.fixed ? joint : joint.times(jointPose(link, positions)));
  }
  return poses;
}

/// What each number of the vector of positions is called.
export function positionNames(robot) {
  const names = robot.limits.map((_, n) => `position ${n}`);
  const parts = { [kType.planar]: [".x", ".y", ".angle"], [kType.floating]: [".x", ".y", ".z", ".qx", ".qy", ".qz", ".qw"] };
  const owned = new Set();
  for (const link of robot.links) {
    if (link.position < 0 || link.multiplier !== 1 || link.offset !== 0 || owned.has(link.position)) continue;
    owned.add(link.position);
    for (let n = 0; n < kPositions[link.type]; ++n) {
      names[link.position + n] = link.joint + (parts[link.type]?.[n] ?? "");
    }
  }
  return names;
}
