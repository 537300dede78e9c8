"""Point navigation in any home: drive to a random place of the floor, seen by a laser."""

import sys

import numpy as np
import galactic


class PointNav(galactic.Task):
    """Drive to within `radius` meters of a goal that the robot is told of (PointGoal navigation:
    Anderson et al. 2018). Pays each meter of the shortest way, and 2 for an arrival. Measures SPL, the
    success weighted by how much longer the driven way was than the shortest one.

    In each scene there are so many goals, anywhere on the floor of its first start.
    """

    options = {
        "episode_steps": 200,
        "bump": True,
        "laser_beams": 32,
        "laser_heights": [0.25, 0.8],
        "laser_range": 4,
        "geodesic": False,
        "geodesic_weight": 0,
    }
    parts = {"to_goal": 2, "way": 3}
    measures = ("spl",)

    def __init__(self, goals=100, radius=0.25, bump_penalty=0.03):
        self.goals = goals
        self.radius = radius
        self.bump_penalty = bump_penalty

    def prepare(self, envs):
        episodes = envs.world.episode_table()
        random = np.random.default_rng(envs.seed)
        can_start = np.ones(len(episodes.scene), bool)
        can_start[envs.simulator.skipped_episodes] = False
        self.ways = {}
        for scene in np.unique(episodes.scene[can_start]):
            here = np.flatnonzero(can_start & (episodes.scene == scene))
            starts = episodes.base[here, :3]
            finder = galactic.PathFinder(envs.world, scene, starts[0])
            goals = random.integers(len(finder.places), size=self.goals)
            self.ways[scene] = finder.fields(finder.places[goals])
            # Elsewhere, such as upstairs, are other floors.
            can_start[here] = np.isfinite(self.ways[scene].distances(starts))
        self.episodes = np.flatnonzero(can_start)
        count = envs.num_envs
        self.memory = {
            "goal": np.zeros(count, np.int64),
            "way": np.zeros(count, np.float32),
            "shortest": np.zeros(count, np.float32),
            "driven": np.zeros(count, np.float32),
            "place": np.zeros((count, 3), np.float32),
        }

    def choose(self, envs, which):
        drawn = envs.uniform("episode")[which, 0]
        return self.episodes[(drawn * len(self.episodes)).astype(int)]

    def begin(self, envs, which):
        drawn = envs.uniform("goal")[which, 0]
        self.memory["goal"][which] = (drawn * self.goals).astype(int)
        way, places = self.way(envs), envs.states.world_from_root.translation
        self.memory["way"][which] = self.memory["shortest"][which] = way[which]
        self.memory["driven"][which] = 0
        self.memory["place"][which] = places[which]

    def step(self, envs):
        now = self.way(envs)
        has_arrived = now < self.radius
        rewards = self.memory["way"] - now + 2 * has_arrived
        rewards -= self.bump_penalty * envs.observations["bump"][:, 0]
        self.memory["way"][:] = now
        places = envs.states.world_from_root.translation
        self.memory["driven"] += np.linalg.norm(places - self.memory["place"], axis=1)
        self.memory["place"][:] = places
        return galactic.Outcome(rewards, successes=has_arrived)

    def measure(self, envs, which):
        has_arrived = self.memory["way"][which] < self.radius
        shortest, driven = self.memory["shortest"][which], self.memory["driven"][which]
        return {"spl": has_arrived * shortest / np.maximum(np.maximum(shortest, driven), 1e-6)}

    def observe(self, envs):
        """Seen from the robot, ahead and to the right: where the goal is, meters, and in which direction
        the way there begins, with its length."""
        roots = envs.states.world_from_root
        apart, begins = np.zeros((2, envs.num_envs, 3), np.float32)
        for scene, ways in self.ways.items():
            here = envs.states.scene == scene
            places, goals = roots.translation[here], self.memory["goal"][here]
            apart[here] = ways.goals[goals] - places
            begins[here] = ways.directions(places, goals)
        root_from_world = np.swapaxes(roots.matrix[:, :3, :3], 1, 2)
        to_goal, way = (
            (root_from_world @ seen[..., None])[:, [0, 2], 0] for seen in (apart, begins)
        )
        return {"to_goal": to_goal, "way": np.column_stack([way, self.memory["way"]])}

    def way(self, envs):
        """How long the ways to the goals are, meters."""
        lengths = np.zeros(envs.num_envs, np.float32)
        for scene, ways in self.ways.items():
            here = envs.states.scene == scene
            places = envs.states.world_from_root.translation[here]
            lengths[here] = ways.distances(places, self.memory["goal"][here])
        return lengths


if __name__ == "__main__":
    homes = galactic.VectorEnv(sys.argv[1], 32, task=PointNav, observation="dict")
    observations, _ = homes.reset()
    column = {action.name: number for number, action in enumerate(homes.world.actions)}
    turn_step = homes.world.actions[column["turn"]].step
    arrived = ended = 0
    for step in range(600):
        ahead, right = observations["to_goal"].T
        bearing = np.arctan2(right, ahead)
        actions = np.zeros(homes.action_space.shape, np.float32)
        actions[:, column["turn"]] = bearing / turn_step
        actions[:, column["forward"]] = np.abs(bearing) < 0.3
        observations, rewards, terminations, truncations, infos = homes.step(actions)
        arrived += terminations.sum()
        ended += (terminations | truncations).sum()
    print(f"straight ahead, {arrived} of {ended} robots arrive")
