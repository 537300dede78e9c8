"""Plays each episode of a world once with a policy of one's own, and says how they end."""

import collections
import sys

import numpy as np
import galactic

world = galactic.World(sys.argv[1])
homes = galactic.VectorEnv(world, 64, task="pick", order="partition", observation="dict")
column = {action.name: number for number, action in enumerate(world.actions)}
turn_step = world.actions[column["turn"]].step


def drive_to_target(observations):
    """Turns to the target and drives there, with a hand that grasps all the time."""
    ahead, up, right = observations["robot_target"].T
    bearing = np.arctan2(right, ahead)
    actions = np.zeros(homes.action_space.shape, np.float32)
    actions[:, column["turn"]] = bearing / turn_step
    actions[:, column["forward"]] = np.abs(bearing) < 0.2
    actions[:, column["hand"]] = 1
    return actions


endings = {}
observations, infos = homes.reset()
while not homes.idle.all():
    actions = drive_to_target(observations)
    observations, rewards, terminations, truncations, infos = homes.step(actions)
    for env in np.flatnonzero(terminations | truncations):
        final = infos["final_info"]
        endings[int(final["episode_index"][env])] = galactic.EpisodeEnd(final["ending"][env])
for end, count in collections.Counter(endings.values()).most_common():
    print(f"{end.name}: {count} of {len(endings)} episodes")
solved = [episode for episode, end in endings.items() if end == galactic.EpisodeEnd.SUCCESS]
print(f"solved: {sorted(solved)}")
