"""Bends paths of the whole robot away from what they pass, by Gauss-Newton (as GPMP2, Mukadam et al. 2018).

    python3 optimize_motion.py world.pack

Each path follows the floor from one place to another, as close around corners as it gets, with joints that move
evenly. Two costs make it better: how much it bends, and how far spheres of the robot come nearer than a margin to
anything. Prints, before and after, how many motions from waypoint to waypoint are free, and how far the robot is
from anything, at least and on average.
"""

import argparse

import numpy as np
import galactic

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("world")
parser.add_argument("--paths", type=int, default=5)
parser.add_argument("--margin", type=float, default=0.15, help="meters that spheres shall keep")
parser.add_argument("--steps", type=int, default=40)
parser.add_argument("--seed", type=int, default=1)
args = parser.parse_args()

SPACING = 0.1  # between waypoints, meters; joints and base turn by twice as much, radians, at most
WEIGHT = 10.0  # of the clearance, against smoothness
MOST_STEP = 0.05  # of a waypoint in each round, meters and radians
ENOUGH = 0.01  # meters of clearance where a path begins and ends

world = galactic.World(args.world)
home = galactic.Simulator(world, 1, threads=1)
scene = galactic.PlanningScene(home)
finder = galactic.PathFinder(world, home.env_state(0).scene, scene.base[:3])
rng = np.random.default_rng(args.seed)
moved = [action.position for action in world.actions if action.position is not None]
lower, upper = np.clip(world.limits, -np.pi, np.pi).T
# Columns of a path, (n, 4 + positions): what may be bent, and which of that are joints.
joints = [4 + position for position in moved]
free = [0, 2, 3, *joints]


def least_clearances(path):
    """Of each pose of a path, (n, 4 + positions): how far the sphere nearest to anything is from it."""
    return scene.clearances(path[:, :4], path[:, 4:], 0.5).distance.min(axis=1)


def drawn_pose():
    """Base and joints, (4 + positions,), where the robot has room."""
    while True:
        place = finder.places[rng.integers(len(finder.places))]
        pose = np.r_[place, rng.uniform(-np.pi, np.pi), home.env_state(0).joint_positions]
        pose[joints] = rng.uniform(lower[moved], upper[moved])
        itself = scene.touch_themselves(pose[None, 4:])[0]
        if not itself and least_clearances(pose[None])[0] > ENOUGH:
            return pose


def path_between(start, goal):
    """Waypoints along the floor, (n, 4 + positions)."""
    corners = finder.fields(goal[None, :3]).path(start[:3])
    along = np.r_[0, np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))]
    way = goal - start
    way[3] = np.remainder(way[3] + np.pi, 2 * np.pi) - np.pi
    share = np.linspace(0, 1, 2 + int(max(along[-1], np.abs(way[3:]).max() / 2) / SPACING))
    path = start + share[:, None] * way
    for axis in range(3):
        path[:, axis] = np.interp(share * along[-1], along, corners[:, axis])
    path[[0, -1], :3] = start[:3], goal[:3]
    return path


def bent(path):
    """The path after the descent: its ends stay, and so do the heights, which are the floor's."""
    path = path.copy()
    differences = np.diff(np.eye(len(path)), axis=0)[:, 1:-1]
    waypoints, size = len(path) - 2, len(free)
    smooth = np.einsum("nm,kl->nkml", differences.T @ differences, np.eye(size))
    each = np.arange(waypoints)
    for _ in range(args.steps):
        near = scene.clearances(path[1:-1, :4], path[1:-1, 4:], args.margin)
        lacking = np.maximum(args.margin - near.distance, 0)  # (waypoints, spheres)
        slopes = np.concatenate([near.base_gradient, near.joint_gradient], axis=2)[..., free]
        gradient = (differences.T @ np.diff(path, axis=0))[:, free]
        gradient -= WEIGHT * np.einsum("ns,nsk->nk", lacking, slopes)
        curvature = smooth.copy()
        curvature[each, :, each] += WEIGHT * np.einsum("nsk,nsl->nkl", slopes, slopes)
        step = np.linalg.solve(curvature.reshape(2 * (waypoints * size,)), gradient.ravel())
        path[1:-1, free] -= np.clip(step.reshape(waypoints, size), -MOST_STEP, MOST_STEP)
        path[1:-1, joints] = np.clip(path[1:-1, joints], lower[moved], upper[moved])
    return path


def verdict(path):
    """In words."""
    ways = scene.motions_free(path[:-1, :4], path[:-1, 4:], path[1:, :4], path[1:, 4:])
    clearances = least_clearances(path)
    return f"{ways.mean():.0%} free, {clearances.min():+.3f} m clear, {clearances.mean():.3f} on average"


for number in range(args.paths):
    path = path_between(drawn_pose(), drawn_pose())
    print(f"path {number}: {len(path)} waypoints, {verdict(path)}; bent: {verdict(bent(path))}")
