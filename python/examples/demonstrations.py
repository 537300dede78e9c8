"""Demonstrations to imitate: plays each episode of a world once with the scripted policy, and saves
what it saw and did in those that it solved."""

import sys

import numpy as np
import galactic

homes = galactic.VectorEnv(sys.argv[1], 64, task="rearrange", order="partition")
(simulator,) = homes.simulators
expert = galactic.ScriptedPolicy(simulator)

observations, _ = homes.reset()
steps = []
solved = []
while not simulator.idle.all():
    playing = ~simulator.idle
    episodes = simulator.episodes()
    actions = expert.act()
    steps.append((episodes[playing], observations[playing], actions[playing]))
    observations, rewards, terminations, truncations, infos = homes.step(actions)
    solved += episodes[simulator.successes].tolist()

played, seen, done = (np.concatenate(rows) for rows in zip(*steps))
# Episode after episode, those that it solved.
order = np.argsort(played, kind="stable")
order = order[np.isin(played[order], solved)]
np.savez(
    "demonstrations.npz",
    episodes=played[order],
    observations=seen[order],
    actions=done[order],
)
print(f"{len(solved)} of {len(set(played))} episodes solved, {len(order)} steps saved")
