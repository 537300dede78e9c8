#include "galactic/bake/robot_recipe.h"

namespace galactic::bake {

std::string describeRobotRecipe() {
  return R"toml(# Robot recipe: what a URDF does not say. Every key is shown; those with a default may be left out.
# Positions and rotations are in frames of the URDF (X forward, Y left, Z up); meters, radians unless
# a key says degrees.

name = "fetch"

# What grasps: a sphere at a point of a link.
[end_effector]
link = "gripper_link"
grasp_point = [0.03, 0.0, 0.0]  # in the link's frame; default [0, 0, 0]
grasp_radius = 0.015            # default 0.015

# The camera; without this table the robot has none. It looks along its own X axis, its Z axis is up
# in the image; a camera on an optical frame (Z forward, Y down) has rpy_degrees = [90, -90, 0].
[camera]
link = "head_pan_link"
position = [0.2, 0.0, 0.2]      # in the link's frame; default [0, 0, 0]
rpy_degrees = [0, 20, 0]        # roll, pitch (down is positive), yaw; default [0, 0, 0]
vertical_fov_degrees = 60

# The planar laser scanner; without this table the robot has none. It scans the plane of its X and Y
# axes, and its X axis is the middle of its field of view. No joint that moves may carry it.
[laser]
link = "laser_link"
position = [0.0, 0.0, 0.0]      # in the link's frame; default [0, 0, 0]
rpy_degrees = [0, 0, 0]         # roll, pitch, yaw; default [0, 0, 0]
fov_degrees = 220
range = 25.0                    # farthest distance
min_range = 0.05                # nearest distance; default 0
noise = 0.02                    # standard deviation of a distance; default 0

# The base: the root link of the URDF, which drives and turns on the ground.
[base]
footprint_radius = 0.3          # circle around the root's origin, or:
# footprint_rectangle = [-0.3, -0.25, 0.3, 0.25]   # min x, min y, max x, max y
forward_step = 0.1              # farthest drive of one action; default 0.1
turn_step_degrees = 5.0         # farthest turn of one action; default 5.002 (0.0873 rad)
root_height = 0.0               # height of the root's origin above the ground; default 0

# The joints that actions move, in the order of the actions: radians, or meters where prismatic.
[[joints]]
name = "shoulder_pan_joint"
step = 0.196                    # farthest move of one action
min = -1.5                      # narrower limits than the URDF's; default: the URDF's
max = 1.5

[[joints]]
name = "shoulder_lift_joint"
step = 0.196

# Limits instead of the URDF's, or for want of them: lower, upper; of any revolute or prismatic joint.
# Without both, a revolute joint has -pi to pi and a prismatic one -1 to 1 m, with a warning.
[limits]
torso_lift_joint = [0.0, 0.38]

# Where joints start, controlled or not; default 0, or the limit nearest to 0.
[start_pose]
torso_lift_joint = 0.2
elbow_flex_joint = 1.57

# The collision spheres.
[spheres]
eps = 0.020                     # farthest gap between surface and spheres; default 0.020
tau = 0.040                     # farthest protrusion of a sphere; default 0.040
max_gap = 0.050                 # without max_spheres: no gap is wider, if eps allows; default 0.050
# max_spheres = 100             # of the whole robot, instead of max_gap; default: 100, and more
#                               # where gaps would be wider than max_gap
clip_height = 0.020             # lowest height above the ground that matters; default 0.020

# A link that differs, by its name. One of: other tolerances, skip, merge_with_parent, spheres.
[spheres.links.torso_lift_link]
eps = 0.030
tau = 0.050
max_spheres = 20
clip_height = 0.0

[spheres.links.estop_link]
skip = true                     # no spheres

[spheres.links.wrist_roll_link]
merge_with_parent = true        # one set of spheres for it and its parent

[spheres.links.laser_link]
spheres = [[0.0, 0.0, 0.0, 0.05]]   # taken as they are: x, y, z, radius in the link's frame

# Pairs of links that may touch.
[self_collision]
ignore = [["torso_lift_link", "shoulder_pan_link"]]
)toml";
}

}  // namespace galactic::bake
