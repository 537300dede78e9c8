"""MPPI: solves the task `pick` without learning, by trying many plans in each step (Williams et al. 2017).

    python3 mppi.py world.pack

From the state of one home, a batch of homes goes on with as many plans: the best plan so far, with noise. Their mean,
weighted by what they cost, is the next best plan, and its first action is done. Prints how the episodes ended, and how
many steps the plans took a second.
"""

import argparse
import time

import numpy as np
import galactic

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("world")
parser.add_argument("--plans", type=int, default=128, help="how many are tried in each step")
parser.add_argument("--steps", type=int, default=15, help="how far a plan goes")
parser.add_argument("--episodes", type=int, default=10)
args = parser.parse_args()

NOISE, HELD_STEPS = 0.6, 5  # standard deviation of actions, and for how many steps it is the same
TEMPERATURE = 0.3  # of the weights, in standard deviations of the costs
SUCCESS = 50  # what it is worth

world = galactic.World(args.world)
# As the state of one goes on in the other: the same world, options and seed.
home, trials = (
    galactic.Simulator(world, envs, task="pick", geodesic=True, auto_reset=False, threads=1, seed=3)
    for envs in (1, args.plans)
)
names = [action.name for action in world.actions]
hand, terminate = names.index("hand"), names.index("terminate")
parts = home.observation_parts
rng = np.random.default_rng(1)


def costs(plans):
    """What each plan, (plans, steps, actions), costs from where the home is now."""
    trials.restore_state(home.save_state())  # one state, into all
    cost = np.zeros(len(plans))
    is_on = np.ones(len(plans), bool)
    for n in range(plans.shape[1]):
        trials.step(np.ascontiguousarray(plans[:, n]))
        # The way along the floor to where the hand reaches the target, where there is one, and the hand's way to it.
        reach = np.linalg.norm(trials.observations[:, parts["grip_target"]], axis=1)
        way = trials.observations[:, parts["geodesic"]][:, 0]
        cost += is_on * (reach + np.where(way >= 0, way, reach))
        ends = is_on & trials.dones
        # The sooner the better; what ends otherwise has failed.
        cost[ends] += np.where(trials.successes[ends], SUCCESS * (n / plans.shape[1] - 1), SUCCESS)
        is_on &= ~trials.dones
    return cost


def improved(best):
    """A better plan, (steps, actions), than the best one so far."""
    noise = rng.normal(0, NOISE, (args.plans, -(-args.steps // HELD_STEPS), len(names)))
    plans = np.clip(best + np.repeat(noise, HELD_STEPS, axis=1)[:, : args.steps], -1, 1)
    plans[0] = best
    # The hand grasps whatever it touches, and the task ends by itself.
    plans[..., hand], plans[..., terminate] = 1, -1
    cost = costs(plans.astype(np.float32))
    weights = np.exp((cost.min() - cost) / (TEMPERATURE * cost.std() + 1e-6))
    return np.average(plans, axis=0, weights=weights)


solved = steps = 0
began = time.perf_counter()
for episode in range(min(args.episodes, world.episodes)):
    if episode in home.skipped_episodes:
        continue
    home.reset([episode])
    best = np.zeros((args.steps, len(names)))
    taken = 0
    while not home.idle[0]:
        best = improved(best)
        home.step(best[:1])
        best = np.concatenate([best[1:], best[-1:]])
        taken += 1
    ending = galactic.EpisodeEnd(int(home.endings[0]))
    print(f"episode {episode}: {ending.name} after {taken} steps")
    solved += ending == galactic.EpisodeEnd.SUCCESS
    steps += taken * args.plans * args.steps
print(f"solved {solved}, {steps / (time.perf_counter() - began):,.0f} planned steps a second")
