"""Plays each episode of a world once with a policy of one's own, and says how they end."""

import collections
import sys

import numpy as np
import galactic

world = galactic.World(sys.argv[1])
homes = galactic.VectorEnv(
    world, 64, task="pick", order="partition", observation="dict", geodesic=True
)
column = {action.name: number for number, action in enumerate(world.actions)}
turn_step = world.actions[column["turn"]].step
random = np.random.default_rng(1)


def grope_for_target(observations):
    """Drives to the target along the floor, and gropes about there with a hand that grasps all the time."""
    length, cosine, sine = observations["geodesic"][:, :3].T
    bearing = np.arctan2(-sine, cosine)
    actions = random.uniform(-1, 1, homes.action_space.shape).astype(np.float32)
    is_far = length > 0.8
    actions[is_far] = 0
    actions[is_far, column["turn"]] = (bearing / turn_step)[is_far]
    actions[is_far, column["forward"]] = (np.abs(bearing) < 0.2)[is_far]
    actions[:, column["hand"]] = 1
    return actions


endings = {}
observations, infos = homes.reset()
while not homes.idle.all():
    actions = grope_for_target(observations)
    observations, rewards, terminations, truncations, infos = homes.step(actions)
    for env in np.flatnonzero(terminations | truncations):
        final = infos["final_info"]
        endings[int(final["episode_index"][env])] = galactic.EpisodeEnd(final["ending"][env])
for end, count in collections.Counter(endings.values()).most_common():
    print(f"{end.name}: {count} of {len(endings)} episodes")
solved = [episode for episode, end in endings.items() if end == galactic.EpisodeEnd.SUCCESS]
print(f"solved: {sorted(solved)}")
