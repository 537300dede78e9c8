"""A task of one's own that looks through a camera: bring the target into view.

    python3 find_target.py world.pack
"""

import sys

import numpy as np
import galactic


class Find(galactic.Task):
    """Pays the share of the image that the target fills, ends where that is `enough`."""

    images = {"width": 48, "height": 48, "color": None, "semantics": "objects"}
    options = {"episode_steps": 100}
    measures = ("most_seen",)

    def __init__(self, enough=0.002):
        self.enough = enough

    def prepare(self, envs):
        self.memory = {"most_seen": np.zeros(envs.num_envs, np.float32)}

    def begin(self, envs, which):
        self.memory["most_seen"][which] = target_share(envs)[which]

    def step(self, envs):
        seen = target_share(envs)
        np.maximum(self.memory["most_seen"], seen, out=self.memory["most_seen"])
        return galactic.Outcome(seen, successes=seen >= self.enough)

    def measure(self, envs, which):
        return {"most_seen": self.memory["most_seen"][which]}


def target_share(envs):
    """How much of each env's image its target fills, 0 to 1, float32 (n,)."""
    ids = len(envs.renderers[""].semantic_names) + envs.states.target
    return (envs.images["semantics"].T == ids).mean(axis=(0, 1), dtype=np.float32)


if __name__ == "__main__":
    homes = galactic.VectorEnv(sys.argv[1], 32, task=Find, seed=3)
    homes.reset()
    found: list[bool] = []
    most_seen: list[float] = []
    turn = np.zeros(homes.action_space.shape, np.float32)
    turn[:, [action.name for action in homes.world.actions].index("turn")] = 1.0
    for _ in range(200):
        final = homes.step(turn)[4].get("final_info")
        if final is not None:
            found.extend(final["success"][final["_success"]])
            most_seen.extend(final["most_seen"][final["_most_seen"]])
    print(f"turning where it stands, the robot found {sum(found)} of {len(found)} targets")
    print(f"at most {100 * max(most_seen):.1f} % of an image were the target")
