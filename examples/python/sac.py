"""Soft actor-critic in one file: a robot learns to pick things up from a replay buffer.

    python3 sac.py homes.pack --unseen unseen.pack -o pick.pt
    python3 sac.py unseen.pack --play pick.pt

The same task as in ppo.py, learned off-policy (Haarnoja et al. 2018): each step of each home is learned from several
times. The first command trains, keeps the policy in pick.pt, and plays each episode of the other world once; the
second only plays.
"""

import argparse
import collections
import copy
import math
import time
from typing import Any

import numpy as np
import torch
import galactic
from galactic.learning import ActionParameters, export_module
from torch import nn
from torch.distributions import Normal

TASK: dict[str, Any] = {
    "task": "pick",
    "episode_steps": 200,
    # What a robot with a map knows, and what it is paid for: how long the path along the floor still is.
    "geodesic": True,
    "geodesic_weight": 1,
    # Whether something was in its way in the last step, and what that costs.
    "bump": True,
    "bump_penalty": 0.03,
}
ENVS, KEPT_STEPS, FIRST_STEPS = 256, 4000, 40
BATCH, UPDATES = 512, 4
LEARNING_RATE, GAMMA, FOLLOW = 1e-3, 0.99, 0.005
# The policy is as random as that on average, in nats for each of its actions.
ENTROPY = -0.2


class Agent(nn.Module):
    """A policy of Gaussians that tanh squashes: motions and the hand. Terminating does nothing in this task."""

    def __init__(self, seen, actions, width=128):
        super().__init__()
        self.policy = perceptron(2 * seen, width, 2 * actions)
        self.register_buffer("mean", torch.zeros(seen))
        self.register_buffer("scale", torch.ones(seen))

    def features(self, observations):
        """Normalized, and through a magnifying glass: beside meters across a home, centimeters at the
        hand would be lost."""
        normalized = ((observations - self.mean) * self.scale).clamp(-10, 10)
        return torch.cat([normalized, torch.tanh(5 * observations)], -1)

    def act(self, features):
        """Actions in [-1, 1], and how likely they were."""
        mean, deviation = self.policy(features).chunk(2, -1)
        chosen = Normal(mean, deviation.clamp(-5, 1).exp(), validate_args=False)
        drawn = chosen.rsample()
        squashed = 2 * (math.log(2) - drawn - nn.functional.softplus(-2 * drawn))
        return torch.tanh(drawn), (chosen.log_prob(drawn) - squashed).sum(-1)

    def likeliest(self, features):
        return torch.tanh(self.policy(features).chunk(2, -1)[0])


class Actor(nn.Module):
    """What a policy pack plays of the agent: its likeliest actions, as a pack draws from no Gaussians that are
    squashed."""

    def __init__(self, agent):
        super().__init__()
        self.agent = agent

    def forward(self, inputs):
        return ActionParameters(self.agent.likeliest(self.agent.features(inputs.state)))


def perceptron(inputs, width, outputs):
    return nn.Sequential(
        nn.Linear(inputs, width),
        nn.ReLU(),
        nn.Linear(width, width),
        nn.ReLU(),
        nn.Linear(width, outputs),
    )


class Critics(nn.Module):
    """Two, of which the lower one is believed (Fujimoto et al. 2018)."""

    def __init__(self, seen, actions, width=128):
        super().__init__()
        self.both = nn.ModuleList(perceptron(2 * seen + actions, width, 1) for _ in range(2))

    def forward(self, features, actions):
        inputs = torch.cat([features, actions], -1)
        return torch.cat([one(inputs) for one in self.both], -1)


class Replay:
    """The last steps of all homes, the oldest of which make room for new ones."""

    def __init__(self, seen, actions):
        shapes = {
            "before": (seen,),
            "actions": (actions,),
            "rewards": (),
            "after": (seen,),
            "ended": (),
        }
        self.arrays = {
            name: torch.zeros(KEPT_STEPS * ENVS, *shape) for name, shape in shapes.items()
        }
        self.steps = 0

    def add(self, **arrays):
        at = self.steps % KEPT_STEPS * ENVS
        for name, values in arrays.items():
            self.arrays[name][at : at + ENVS] = torch.as_tensor(values)
        self.steps += 1

    def sample(self):
        which = torch.randint(min(self.steps, KEPT_STEPS) * ENVS, (BATCH,))
        return {name: values[which] for name, values in self.arrays.items()}

    def seen(self):
        return self.arrays["before"][: min(self.steps, KEPT_STEPS) * ENVS]


class Learner:
    def __init__(self, seen, actions):
        self.agent, self.critics = Agent(seen, actions), Critics(seen, actions)
        self.followers = copy.deepcopy(self.critics)
        self.log_worth = torch.tensor(math.log(0.1), requires_grad=True)
        self.optimizers = [
            torch.optim.Adam(parameters, LEARNING_RATE)
            for parameters in (self.critics.parameters(), self.agent.parameters(), [self.log_worth])
        ]

    def update(self, batch):
        before, after = self.agent.features(batch["before"]), self.agent.features(batch["after"])
        worth = self.log_worth.exp().detach()
        with torch.no_grad():
            actions, log_probs = self.agent.act(after)
            then = self.followers(after, actions).min(-1).values - worth * log_probs
            # What time cuts off could have gone on; after what the task ends, there is nothing.
            wanted = batch["rewards"] + GAMMA * (1 - batch["ended"]) * then
        values = self.critics(before, batch["actions"])
        self.descend(0, (values - wanted[:, None]).square().mean())
        actions, log_probs = self.agent.act(before)
        self.descend(1, (worth * log_probs - self.critics(before, actions).min(-1).values).mean())
        surplus = (log_probs.detach() + ENTROPY * actions.shape[-1]).mean()
        self.descend(2, -self.log_worth * surplus)
        with torch.no_grad():
            for follower, leader in zip(self.followers.parameters(), self.critics.parameters()):
                follower.lerp_(leader, FOLLOW)

    def descend(self, which, loss):
        self.optimizers[which].zero_grad()
        loss.backward()
        self.optimizers[which].step()


def train(world, steps, seed, file):
    torch.manual_seed(seed)
    homes = galactic.VectorEnv(world, ENVS, seed=seed, **TASK)
    seen, count = homes.single_observation_space.shape[0], homes.single_action_space.shape[0] - 1
    learner, replay = Learner(seen, count), Replay(seen, count)
    agent = learner.agent
    ended: collections.deque[tuple[bool, float]] = collections.deque(maxlen=1000)
    observations, _ = homes.reset()
    began = said = time.perf_counter()
    for number in range(-(-steps // ENVS)):
        with torch.no_grad():
            actions, _ = agent.act(agent.features(torch.from_numpy(observations)))
        if number < FIRST_STEPS:
            actions.uniform_(-1, 1)
        terminate = torch.zeros(ENVS, 1)
        after, rewards, terminations, _, infos = homes.step(
            torch.cat([actions, terminate], -1).numpy()
        )
        replay.add(
            before=observations,
            actions=actions,
            rewards=rewards,
            after=galactic.reached(after, infos),
            ended=terminations,
        )
        observations = after
        if "final_info" in infos:
            of, final = infos["_final_info"], infos["final_info"]
            ended.extend(zip(final["success"][of], final["episode"]["r"][of]))
        if number == FIRST_STEPS:
            agent.mean, deviation = replay.seen().mean(0), replay.seen().std(0)
            agent.scale = 1 / (deviation + 1e-3)
        if number > FIRST_STEPS:
            for _ in range(UPDATES):
                learner.update(replay.sample())
        now, done = time.perf_counter(), (number + 1) * ENVS
        if (now - said > 5 or done >= steps) and ended:
            said = now
            (solved, paid), rate = np.mean(list(ended), axis=0), done / (now - began)
            worth = learner.log_worth.exp().item()
            what = f"{solved:.1%} solved, {paid:.1f} paid, entropy at {worth:.3f}"
            print(f"{done:9,} steps, {rate:,.0f} a second: {what}", flush=True)
    torch.save({"agent": agent.state_dict(), "sizes": {"seen": seen, "actions": count}}, file)
    return agent


@torch.no_grad()
def play(agent, world, *, likeliest):
    """The share of a world's episodes that are solved, each played once."""
    homes = galactic.VectorEnv(world, 100, order="partition", **TASK)
    observations, _ = homes.reset()
    ended = solved = 0
    while not homes.idle.all():
        features = agent.features(torch.from_numpy(observations))
        actions = agent.likeliest(features) if likeliest else agent.act(features)[0]
        terminate = torch.zeros(len(actions), 1)
        observations, _, _, _, infos = homes.step(torch.cat([actions, terminate], -1).numpy())
        if "final_info" in infos:
            ended += infos["_final_info"].sum()
            solved += infos["final_info"]["success"].sum()
    return solved / ended


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("world", help="a world pack: to learn in, or to play in")
    parser.add_argument("--unseen", help="another one, which is played in the end")
    parser.add_argument("--steps", type=float, default=1e6, help="of all homes together")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output", default="sac.pt", help="where the policy is kept")
    parser.add_argument("--play", metavar="FILE", help="play this policy, and train none")
    parser.add_argument("--pack", metavar="FILE", help="also write it as a policy pack")
    given = parser.parse_args()
    if given.play:
        kept = torch.load(given.play)
        agent = Agent(**kept["sizes"])
        agent.load_state_dict(kept["agent"])
    else:
        agent = train(given.world, int(given.steps), given.seed, given.output)
    if given.pack:
        homes = galactic.VectorEnv(given.world, 1, **TASK)
        # Nobody terminates.
        export_module(given.pack, Actor(agent), homes, discrete=((0,),))
    torch.manual_seed(given.seed)
    played = given.unseen or given.world
    sampled, likeliest = (play(agent, played, likeliest=one) for one in (False, True))
    print(f"solved of {played}: {sampled:.1%} by sampled actions, {likeliest:.1%} by the likeliest")
