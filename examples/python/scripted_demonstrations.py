"""Demonstrations: a script of one's own shows how it is done, and a network clones it.

    python3 scripted_demonstrations.py homes.pack unseen.pack demos

Records episodes of Mobile Pick into the folder `demos`, learns from those that were solved, and plays each episode of
the other world once, with the script and with its clone. Prints how many episodes each of them solves: 274 and 288 of
400 in the sample apartment.

The expert drives along the path to the target and then moves its hand there. It goes by what the clone sees, too;
`galactic.ScriptedPolicy` solves more, by plans that do not follow from what a policy sees. While it is recorded, its
arms and wheels do something else than it wants, and it shows how one gets back from there (DART: Laskey et al.
2017). With `--noise 0` the clone solves none: where its own mistakes lead, it has never been.
"""

import argparse
from typing import Any

import numpy as np
import torch
import galactic
from torch import nn

TASK: dict[str, Any] = {"task": "pick", "episode_steps": 200, "geodesic": True}
ENVS, NEAR, LIFT = 100, 0.8, 0.15  # meters


class Script:
    """Drives to the target along the floor, then has the hand follow it, and closes the hand on the way."""

    def __init__(self, homes):
        self.simulator = homes.simulators[0]
        self.parts = homes.observation_parts
        actions = homes.world.actions
        self.column = {action.name: number for number, action in enumerate(actions)}
        self.turn_step = actions[self.column["turn"]].step
        self.joints = [action for action in actions if action.position is not None]
        self.arm = galactic.PlanningScene(self.simulator)
        self.rest = self.simulator.env_states().joint_positions[0]
        self.shape = homes.action_space.shape

    def act(self, observations):
        seen = {name: observations[:, part] for name, part in self.parts.items()}
        ahead, _, right = seen["robot_target"].T
        is_near = np.hypot(ahead, right) < NEAR
        _, cosine, sine = seen["geodesic"][:, :3].T
        bearing = np.where(is_near, np.arctan2(right, ahead), np.arctan2(-sine, cosine))
        actions = np.zeros(self.shape, np.float32)
        actions[:, self.column["turn"]] = np.clip(bearing / self.turn_step, -1, 1)
        actions[:, self.column["forward"]] = ~is_near & (np.abs(bearing) < 0.3)
        actions[:, self.column["hand"]] = is_near
        ways = seen["robot_target"] - seen["robot_grip"]
        # From above, over the edge of whatever the target stands on.
        ways[:, 1] += LIFT * (np.hypot(ways[:, 0], ways[:, 2]) > 0.2)
        postures = self.simulator.env_states().joint_positions
        for env in np.flatnonzero(~self.simulator.idle):
            # On the road, the arm goes back to where it was in the beginning.
            moves = (self.rest - postures[env])[[joint.position for joint in self.joints]]
            if is_near[env]:
                moves = self.reach(postures[env], np.clip(ways[env], -0.15, 0.15))
            for joint, move in zip(self.joints, moves):
                actions[env, self.column[joint.name]] = np.clip(move / joint.step, -1, 1)
        return actions

    def reach(self, posture, way):
        """Changes of the joints that move the hand by `way`, seen from the base: damped least squares
        (Nakamura and Hanafusa 1986), with differences of 0.01 for derivatives."""
        columns = []
        for joint in self.joints:
            moved = posture.copy()
            moved[joint.position] += 0.01
            columns.append((self.grip(moved) - self.grip(posture)) / 0.01)
        jacobian = np.stack(columns, axis=1)
        return jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 0.0025 * np.eye(3), way)

    def grip(self, posture):
        self.arm.set_joints(posture)
        return self.arm.world_from_grip((0, 0, 0, 0)).translation


class Clone(nn.Module):
    """What the expert would do: motions, and log-odds of closing the hand."""

    def __init__(self, states, actions, width=256):
        super().__init__()
        self.mean, self.spread = states.mean(0), states.std(0) + 1e-3
        self.layers = nn.Sequential(
            nn.Linear(2 * states.shape[1], width),
            nn.Tanh(),
            nn.Linear(width, width),
            nn.Tanh(),
            nn.Linear(width, actions - 1),
        )

    def forward(self, states):
        """Also sees them through a magnifying glass: at the hand, centimeters matter."""
        normalized = (states - self.mean) / self.spread
        return self.layers(torch.cat([normalized, torch.tanh(5 * states)], -1))

    @torch.no_grad()
    def act(self, observations):
        found = self(torch.from_numpy(observations)).numpy()
        hand = found[:, -1:] > 0
        return np.hstack([np.clip(found[:, :-1], -1, 1), hand, np.zeros_like(hand)])


def record(world, folder, episodes, noise):
    """What the script wants to do, while something else is done: noise that changes slowly, so that it leads
    away, where that of each step by itself would cancel out."""
    homes = galactic.VectorEnv(world, ENVS, **TASK)
    script = Script(homes)
    random = np.random.default_rng(1)
    pushes = np.zeros(script.shape)
    observations, _ = homes.reset()
    with galactic.DemonstrationWriter(folder, homes, expert="a script", world=world) as writer:
        while len(writer) < episodes:
            actions = script.act(observations)
            pushes = 0.8 * pushes + 0.6 * noise * random.normal(size=pushes.shape)
            pushes[:, -2:] = 0  # decisions
            then, rewards, _, _, infos = homes.step(np.clip(actions + pushes, -1, 1))
            writer.add(observations, actions, rewards, infos)
            observations = then


def learn(folder, updates):
    shown = galactic.Demonstrations(folder)
    solved = [one for one in shown if one.is_solved]
    states = torch.from_numpy(np.concatenate([one.state[:-1] for one in solved]))
    actions = torch.from_numpy(np.concatenate([one.actions for one in solved]))
    print(
        f"{len(solved)} of {len(shown)} demonstrations solved their episode, in {len(states)} steps"
    )
    clone = Clone(states, actions.shape[1])
    optimizer = torch.optim.Adam(clone.parameters(), 1e-3)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, updates)
    for update in range(updates):
        rows = torch.randint(len(states), (512,))
        found, wanted = clone(states[rows]), actions[rows]
        motions = nn.functional.mse_loss(found[:, :-1], wanted[:, :-2])
        hand = nn.functional.binary_cross_entropy_with_logits(found[:, -1], wanted[:, -2])
        optimizer.zero_grad()
        (motions + hand).backward()
        optimizer.step()
        schedule.step()
        if (update + 1) % (updates // 4) == 0:
            print(f"after {update + 1} updates: motions {motions:.4f}, hand {hand:.4f}", flush=True)
    return clone


def solved_by(make_policy, world):
    """How many episodes of a world a policy solves, each played once, and how many there are."""
    homes = galactic.VectorEnv(world, ENVS, order="partition", **TASK)
    policy = make_policy(homes)
    observations, _ = homes.reset()
    solved = ended = 0
    while not homes.idle.all():
        observations, _, terminations, truncations, infos = homes.step(policy.act(observations))
        ended += np.count_nonzero(terminations | truncations)
        solved += np.count_nonzero(homes.simulators[0].successes)
    return solved, ended


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("world", help="a world pack, where the demonstrations are recorded")
    parser.add_argument("unseen", help="another one, which script and clone are judged by")
    parser.add_argument("folder", help="for the demonstrations")
    parser.add_argument("--episodes", type=int, default=500, help="to record")
    parser.add_argument("--updates", type=int, default=4000, help="of the clone")
    parser.add_argument("--noise", type=float, default=0.5, help="in the motions, deviation")
    given = parser.parse_args()
    torch.manual_seed(1)
    record(given.world, given.folder, given.episodes, given.noise)
    clone = learn(given.folder, given.updates)
    for name, make in (("the script", Script), ("its clone", lambda homes: clone)):
        solved, ended = solved_by(make, given.unseen)
        print(f"{name} solves {solved} of {ended} episodes of {given.unseen}")
