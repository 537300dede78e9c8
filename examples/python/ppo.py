"""PPO in one file: a robot learns to pick things up, along a path that it knows, from numbers alone.

    python3 ppo.py homes.pack --unseen unseen.pack -o pick.pt
    python3 ppo.py unseen.pack --play pick.pt

The first command trains, in Mobile Pick as the preset `quick` of galactic.train has it. It prints, every few
seconds, how many of the latest episodes were solved, keeps the policy in pick.pt, and plays each episode of the
other world once, of which that policy solves 95.8 % (seed 1) or 96.0 % (seed 2) in the sample apartment, after three
minutes of one core. The second command only plays.
"""

import argparse
import collections
import time
from typing import Any

import numpy as np
import torch
import galactic
from galactic.learning import ActionParameters, export_module
from torch import nn
from torch.distributions import Bernoulli, Normal

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
ENVS, HORIZON, EPOCHS, MINI_BATCHES = 1024, 32, 2, 4
LEARNING_RATE, GAMMA, LAMBDA, CLIP = 1e-3, 0.99, 0.95, 0.2
VALUE_WEIGHT, ENTROPY_WEIGHT, MOST_GRADIENT = 0.5, 1e-3, 2.0
FIRST_LOG_STD, LAST_LOG_STD = -0.5, -1.5


class Agent(nn.Module):
    """Actor and critic side by side. Motions are Gaussian, the hand closes or does not; terminating does
    nothing in this task, so nobody decides it."""

    mean: torch.Tensor
    variance: torch.Tensor
    count: torch.Tensor

    def __init__(self, seen, motions, width=128):
        super().__init__()
        self.actor = perceptron(2 * seen, width, motions + 1, 0.01)
        self.critic = perceptron(2 * seen, width, 1, 1.0)
        self.log_std = nn.Parameter(torch.full((motions,), FIRST_LOG_STD))
        self.register_buffer("mean", torch.zeros(seen, dtype=torch.float64))
        self.register_buffer("variance", torch.ones(seen, dtype=torch.float64))
        self.register_buffer("count", torch.zeros((), dtype=torch.float64))

    def features(self, observations):
        """Normalized, and through a magnifying glass: beside meters across a home, centimeters at the
        hand would be lost."""
        mean, scale = self.mean.float(), self.variance.add(1e-5).rsqrt().float()
        normalized = ((observations - mean) * scale).clamp(-10, 10)
        return torch.cat([normalized, torch.tanh(5 * observations)], -1)

    def policy(self, features):
        found = self.actor(features)
        return Policy(torch.tanh(found[..., :-1]), self.log_std.exp(), found[..., -1])

    def values(self, features):
        return self.critic(features).squeeze(-1)

    def absorb(self, observations):
        """Takes them into mean and variance (Chan, Golub, LeVeque 1979). After an update, so that the policy
        that learns is the one that acted."""
        rows = observations.flatten(0, -2).double()
        total = self.count + len(rows)
        shift, share = rows.mean(0) - self.mean, len(rows) / total
        spread = rows.var(0, unbiased=False)
        self.variance += share * (spread - self.variance) + share * (1 - share) * shift**2
        self.mean += share * shift
        self.count.copy_(total)


class Actor(nn.Module):
    """What a policy pack plays of the agent."""

    def __init__(self, agent):
        super().__init__()
        self.agent = agent

    def forward(self, inputs):
        found = self.agent.actor(self.agent.features(inputs.state))
        hand_logits = found[..., -1:]
        return ActionParameters(torch.tanh(found[..., :-1]), self.agent.log_std, (hand_logits,))


class Policy:
    """What the agent may do next: motions [..., motions], and a decision of the hand."""

    def __init__(self, mean, deviation, hand_logits):
        self.motions = Normal(mean, deviation.expand_as(mean), validate_args=False)
        self.hand = Bernoulli(logits=hand_logits, validate_args=False)

    def act(self, likeliest=False):
        """Actions as the simulator takes them: motions, hand, terminate."""
        motions = self.motions.mean if likeliest else self.motions.sample()
        hand = (self.hand.probs.round() if likeliest else self.hand.sample()).unsqueeze(-1)
        return torch.cat([motions, hand, torch.zeros_like(hand)], -1)

    def log_prob(self, actions):
        """Of samples as they were drawn: that the simulator clamps them is a matter of the world."""
        of_motions = self.motions.log_prob(actions[..., :-2]).sum(-1)
        return of_motions + self.hand.log_prob(actions[..., -2])

    def entropy(self):
        return self.motions.entropy().sum(-1) + self.hand.entropy()


def perceptron(inputs, width, outputs, last_gain):
    layers = [nn.Linear(inputs, width), nn.Linear(width, width), nn.Linear(width, outputs)]
    for layer, gain in zip(layers, (2**0.5, 2**0.5, last_gain)):
        nn.init.orthogonal_(layer.weight, gain)
        nn.init.zeros_(layer.bias)
    return nn.Sequential(layers[0], nn.Tanh(), layers[1], nn.Tanh(), layers[2])


class Rollout:
    """HORIZON steps of all homes. The simulator writes what happens right into these tensors."""

    def __init__(self, homes):
        self.homes = homes
        self.arrays = homes.buffers(HORIZON)
        self.actions = torch.zeros(HORIZON, ENVS, *homes.single_action_space.shape)
        self.log_probs = torch.zeros(HORIZON, ENVS)
        # One row more: what is seen after the last step.
        self.observations = torch.from_numpy(self.arrays["state"])
        self.rewards = torch.from_numpy(self.arrays["rewards"])
        self.ended: collections.deque[tuple[bool, float]] = collections.deque(maxlen=1000)
        homes.observe(out={"state": self.arrays["state"][HORIZON]})

    @torch.no_grad()
    def collect(self, agent):
        """One half of the homes simulates while the network acts in the other."""
        self.observations[0] = self.observations[HORIZON]
        self.cut_off = []
        for step in range(HORIZON):
            for half in (0, 1):
                if step > 0:
                    self.receive(step - 1, half)
                rows = self.homes.rows(half)
                policy = agent.policy(agent.features(self.observations[step, rows]))
                actions = policy.act()
                self.actions[step, rows] = actions
                self.log_probs[step, rows] = policy.log_prob(actions)
                lands = {"state": self.arrays["state"][step + 1, rows]}
                for name in ("rewards", "terminations", "truncations"):
                    lands[name] = self.arrays[name][step, rows]
                self.homes.send(actions.numpy(), half, out=lands)
        for half in (0, 1):
            self.receive(HORIZON - 1, half)

    def receive(self, step, half):
        _, _, _, truncations, infos = self.homes.recv(half)
        if "final_info" in infos:
            ended, final = infos["_final_info"], infos["final_info"]
            self.ended.extend(zip(final["success"][ended], final["episode"]["r"][ended]))
            first = self.homes.rows(half).start
            for env in np.flatnonzero(truncations):
                self.cut_off.append((step, first + env, infos["final_obs"][env]))

    @torch.no_grad()
    def advantages(self, agent):
        """Generalized advantage estimates (Schulman et al. 2016), and what the values should have been.

        An episode that the task ends is worth nothing from there on. One that time cuts off is worth what
        the critic makes of its last observation, which is not the one behind it in the rollout: there, the
        next episode has begun already.
        """
        values = agent.values(agent.features(self.observations))
        rewards = self.rewards.clone()
        if self.cut_off:
            steps, envs, last = zip(*self.cut_off)
            after = agent.values(agent.features(torch.from_numpy(np.stack(last))))
            rewards[list(steps), list(envs)] += GAMMA * after
        ended = torch.from_numpy(self.arrays["terminations"] | self.arrays["truncations"])
        goes_on = 1.0 - ended.float()
        surprise = rewards + GAMMA * values[1:] * goes_on - values[:-1]
        found = torch.zeros(HORIZON + 1, ENVS)
        for step in reversed(range(HORIZON)):
            found[step] = surprise[step] + GAMMA * LAMBDA * goes_on[step] * found[step + 1]
        return found[:-1], found[:-1] + values[:-1]


def update(agent, optimizer, rollout):
    """Proximal policy optimization (Schulman et al. 2017): mini-batches of steps in any order."""
    advantages, returns = rollout.advantages(agent)
    scaled = (advantages - advantages.mean()) / (advantages.std() + 1e-5)
    everything = (rollout.observations[:-1], rollout.actions, rollout.log_probs, scaled, returns)
    flat = [each.flatten(0, 1) for each in everything]
    for _ in range(EPOCHS):
        for chosen in torch.randperm(HORIZON * ENVS).chunk(MINI_BATCHES):
            observations, actions, log_probs, advantage, wanted = (each[chosen] for each in flat)
            features = agent.features(observations)
            policy = agent.policy(features)
            ratio = (policy.log_prob(actions) - log_probs).exp()
            clipped = ratio.clamp(1 - CLIP, 1 + CLIP)
            gain = torch.minimum(ratio * advantage, clipped * advantage).mean()
            value_loss = 0.5 * (agent.values(features) - wanted).square().mean()
            entropy = policy.entropy().mean()
            loss = VALUE_WEIGHT * value_loss - gain - ENTROPY_WEIGHT * entropy
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(agent.parameters(), MOST_GRADIENT)
            optimizer.step()
    agent.absorb(rollout.observations[:-1])


def train(world, steps, seed, file):
    torch.manual_seed(seed)
    homes = galactic.VectorEnv(world, ENVS, halves=2, copy=False, seed=seed, **TASK)
    seen, actions = homes.single_observation_space.shape[0], homes.single_action_space.shape[0]
    agent = Agent(seen, actions - 2)
    optimizer = torch.optim.Adam(agent.parameters(), LEARNING_RATE, eps=1e-5)
    rollout = Rollout(homes)
    updates = -(-steps // (HORIZON * ENVS))
    began = said = time.perf_counter()
    for number in range(updates):
        progress = number / updates
        optimizer.param_groups[0]["lr"] = LEARNING_RATE * (1 - progress)
        rollout.collect(agent)
        update(agent, optimizer, rollout)
        # Noise that the policy leans on to the end is missing when it does what is likeliest.
        most = FIRST_LOG_STD + (LAST_LOG_STD - FIRST_LOG_STD) * max(0, (progress - 0.2) / 0.8)
        agent.log_std.data.clamp_(max=most)
        now, done = time.perf_counter(), (number + 1) * HORIZON * ENVS
        if (now - said > 5 or number == updates - 1) and rollout.ended:
            said = now
            (solved, paid), rate = np.mean(list(rollout.ended), axis=0), done / (now - began)
            what = f"{solved:.1%} solved, {paid:.1f} paid"
            print(f"{done:9,} steps, {rate:,.0f} a second: {what}", flush=True)
    sizes = {"seen": seen, "motions": actions - 2}
    torch.save({"agent": agent.state_dict(), "sizes": sizes, "steps": done, "seed": seed}, file)
    return agent


@torch.no_grad()
def play(agent, world, *, likeliest):
    """The share of a world's episodes that are solved, each played once."""
    homes = galactic.VectorEnv(world, 100, order="partition", **TASK)
    observations, _ = homes.reset()
    ended = solved = 0
    while not homes.idle.all():
        policy = agent.policy(agent.features(torch.from_numpy(observations)))
        observations, _, _, _, infos = homes.step(policy.act(likeliest).numpy())
        if "final_info" in infos:
            ended += infos["_final_info"].sum()
            solved += infos["final_info"]["success"].sum()
    return solved / ended


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("world", help="a world pack: to learn in, or to play in")
    parser.add_argument("--unseen", help="another one, which is played in the end")
    parser.add_argument("--steps", type=float, default=6e6, help="of all homes together")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output", default="ppo.pt", help="where the policy is kept")
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
        # The hand closes or does not, and nobody terminates.
        export_module(given.pack, Actor(agent), homes, discrete=((0, 1), (0,)))
    torch.manual_seed(given.seed)
    played = given.unseen or given.world
    sampled, likeliest = (play(agent, played, likeliest=one) for one in (False, True))
    print(f"solved of {played}: {sampled:.1%} by sampled actions, {likeliest:.1%} by the likeliest")
