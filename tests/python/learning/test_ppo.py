"""Advantages, losses, rollouts and updates against plain references, and toys that must be solved."""

import dataclasses

import numpy as np
import pytest
import torch

from galactic.learning.encoders import Inputs
from galactic.learning.playing.evaluation import Actor
from galactic.learning.policies.distributions import ActionDistribution
from galactic.learning.policies.networks import Outputs, Policy, PolicyShape, make_policy
from galactic.learning.ranks.distributed import Group
from galactic.learning.refusals import SettingsError
from galactic.learning.rollouts.collector import Collector, CollectorOptions
from galactic.learning.rollouts.environments import Observation
from galactic.learning.rollouts.noise import action_noise, episode_noise, mini_batch_envs
from galactic.learning.rollouts.rollout import advantages
from galactic.learning.settings import Settings
from galactic.learning.trainer import Trainer
from galactic.learning.updates.ppo import Batch, PpoLearner, ppo_loss
from galactic.learning.updates.precision import Precision
from galactic.learning.updates.schedules import PacedRate, log_std_limit_at
from toys import Look, ReachAndGrasp, Remember

CPU = torch.device("cpu")
TOY = dict(network="state", precision="fp32", width=32, normalize=True, log_std="parameter")


def test_advantages_equal_the_sum_of_discounted_errors() -> None:
    random = np.random.default_rng(1)
    steps, envs, gamma, lam = 12, 5, 0.9, 0.8
    rewards, values = random.normal(size=(steps, envs)), random.normal(size=(steps + 1, envs))
    ends = random.random((steps, envs)) < 0.2
    expected = np.zeros((steps, envs))
    for env in range(envs):
        for step in range(steps):
            weight = 1.0
            for later in range(step, steps):
                goes_on = 0.0 if ends[later, env] else 1.0
                following = gamma * goes_on * values[later + 1, env]
                error = rewards[later, env] + following - values[later, env]
                expected[step, env] += weight * error
                weight *= gamma * lam * goes_on
    found = advantages(*map(torch.from_numpy, (rewards, values, ends)), gamma, lam)
    np.testing.assert_allclose(found.numpy(), expected, atol=1e-12)
    assert 0.1 < ends.mean() < 0.9


def test_the_loss_is_the_clipped_surrogate() -> None:
    random = np.random.default_rng(2)
    count, settings = 400, Settings(clip=0.2, value_coefficient=0.5, value_clip=0.3)
    logits = torch.from_numpy(random.normal(size=(count, 2)))
    mean = torch.zeros(count, 1, dtype=torch.float64)
    distribution = ActionDistribution(mean, mean, logits, True)
    actions = torch.from_numpy(random.integers(0, 2, size=(count, 3)).astype(float))
    new = distribution.log_prob(actions)
    old = new + torch.from_numpy(random.normal(scale=0.3, size=count))
    fields = [torch.from_numpy(random.normal(size=count)) for _ in range(4)]
    values, old_values, gains, returns = fields
    loss = ppo_loss(
        Outputs(distribution, values, None),
        Batch(actions, old, old_values, gains, returns),
        settings,
        entropy_coefficient=0.01,
        steps=2.0 * count,
    )
    total, clipped = 0.0, 0
    for i in range(count):
        ratio = np.exp(float(new[i] - old[i]))
        kept = min(max(ratio, 0.8), 1.2)
        total -= min(ratio * float(gains[i]), kept * float(gains[i]))
        near = min(max(float(values[i]), float(old_values[i]) - 0.3), float(old_values[i]) + 0.3)
        error = max((float(values[i]) - float(returns[i])) ** 2, (near - float(returns[i])) ** 2)
        total += 0.5 * 0.5 * error - 0.01 * float(distribution.entropy()[i])
        clipped += ratio != kept
    assert loss.total.item() == pytest.approx(total / (2.0 * count), abs=1e-9)
    assert loss.sums["clipped"].item() == clipped and 0.1 * count < clipped < 0.9 * count


def collector_of(envs: ReachAndGrasp, policy: Policy, horizon: int, seed: int = 1) -> Collector:
    options = CollectorOptions(horizon, seed, gamma=0.9)
    collector = Collector(envs, policy, options, Precision("fp32", CPU), CPU)
    collector.reset()
    return collector


def toy_policy(recurrent: bool = False, seed: int = 0) -> Policy:
    torch.manual_seed(seed)
    shape = PolicyShape(state=4, motions=2, decides_terminate=False)
    return make_policy("state", shape, recurrent=recurrent, width=32, initial_log_std=-0.5)


@pytest.mark.parametrize("recurrent", [False, True])
def test_a_rollout_is_what_the_policy_did_and_saw(recurrent: bool) -> None:
    """Stepped by hand: observations, memories, values, log-probabilities, and both kinds of end."""
    policy = toy_policy(recurrent)
    collector = collector_of(ReachAndGrasp(6, halves=2, limit=2), policy, horizon=7)
    by_hand = ReachAndGrasp(6, limit=2)
    state = torch.zeros(6, 4)

    by_hand.reset(Observation(state))
    hidden, starts = policy.initial_hidden(6, CPU), torch.ones(1, 6, dtype=torch.bool)
    kinds = {"terminated": 0, "truncated": 0, "neither": 0}
    with torch.no_grad():
        for update in range(3):
            rollout = collector.collect(update)
            noise = torch.from_numpy(
                action_noise(1, range(6), range(update * 7, update * 7 + 7), 2)
            )
            for step in range(7):
                # Sums of a half's rows may end with other bits than those of all.
                torch.testing.assert_close(rollout.state[step], state)
                outputs = policy(Inputs(state[None]), hidden, starts)
                actions = outputs.actions.sample(noise[step][None])
                torch.testing.assert_close(rollout.actions[step], actions[0])
                torch.testing.assert_close(rollout.values[step], outputs.values[0])
                log_probs = outputs.actions.log_prob(actions)[0]
                torch.testing.assert_close(rollout.log_probs[step], log_probs)
                by_hand.send(0, actions[0].numpy(), Observation(state))
                result = by_hand.recv(0)
                hidden = outputs.hidden
                expected = torch.from_numpy(result.rewards.copy())
                if result.timeouts is not None:
                    # A value for the last observation, with the memory of that moment.
                    cut = torch.from_numpy(result.timeouts.envs)
                    last = Inputs(torch.from_numpy(result.timeouts.state)[None])
                    kept = None if hidden is None else hidden[cut]
                    none = torch.zeros(1, len(cut), dtype=torch.bool)
                    expected[cut] += 0.9 * policy.value(last, kept, none)[0]
                torch.testing.assert_close(rollout.rewards[step], expected)
                ended = torch.from_numpy(result.terminated | result.truncated)
                assert torch.equal(rollout.ends[step], ended)
                starts = ended[None].clone()
                kinds["terminated"] += int(result.terminated.sum())
                kinds["truncated"] += int(result.truncated.sum())
                kinds["neither"] += int((~ended).sum())
    assert min(kinds.values()) > 5, kinds


def test_halves_do_not_change_a_rollout() -> None:
    whole = collector_of(ReachAndGrasp(8), toy_policy(), horizon=9).collect(0)
    halves = collector_of(ReachAndGrasp(8, halves=2), toy_policy(), horizon=9).collect(0)
    for name in ("state", "actions", "log_probs", "values", "rewards", "ends", "starts"):
        torch.testing.assert_close(getattr(halves, name), getattr(whole, name))


def test_noise_is_normal_and_uniform_and_depends_on_env_and_step_only() -> None:
    noise = action_noise(5, range(40), range(30, 130), motions=9)
    assert noise.shape == (100, 40, 11) and noise.dtype == np.float32
    normal, uniform = noise[..., :9], noise[..., 9:]
    # Standard errors of 36,000 and 8,000 draws; five of them.
    assert abs(normal.mean()) < 5 / 36_000**0.5 and abs(normal.std() - 1) < 5 / 72_000**0.5
    assert abs(uniform.mean() - 0.5) < 5 * 0.2887 / 8_000**0.5
    assert uniform.min() >= 0.0 and uniform.max() < 1.0
    correlations = np.corrcoef(noise.reshape(-1, 11).T) - np.eye(11)
    assert np.abs(correlations).max() < 0.08
    np.testing.assert_array_equal(action_noise(5, range(7, 9), range(60, 61), 9)[0], noise[30, 7:9])
    assert (action_noise(6, range(40), range(30, 130), 9) != noise).mean() > 0.99


def test_policies_are_judged_by_other_noise_than_they_learn_with() -> None:
    learned = action_noise(5, range(40), range(30, 130), 9)
    judged = episode_noise(5, np.arange(40)[None], np.arange(30, 130)[:, None], 9)
    assert judged.shape == learned.shape and (judged != learned).mean() > 0.99
    correlations = np.corrcoef(judged.reshape(-1, 11).T, learned.reshape(-1, 11).T) - np.eye(22)
    assert np.abs(correlations).max() < 0.08
    policy, seen, starts = toy_policy().eval(), torch.zeros(40, 4), np.ones(40, bool)
    episodes, steps = np.arange(40), np.full(40, 30)
    actor = Actor(policy, deterministic=False, seed=5)
    actor.begin(40)
    acted = actor.act(Observation(seen), starts, episodes, steps)
    with torch.inference_mode():
        actions = policy.act(Inputs(seen[None]), None, torch.from_numpy(starts[None])).actions
        sampled = actions.sample(torch.from_numpy(episode_noise(5, episodes, steps, 2)[None]))
    np.testing.assert_array_equal(acted, sampled[0])


@pytest.mark.parametrize("mean", [0.0, -100.0, 3000.0])
def test_advantages_far_from_zero_are_normalized_as_others_are(mean: float) -> None:
    learner = PpoLearner(toy_policy(), Settings(**TOY), Group.alone())
    raw = torch.randn(32, 512, generator=torch.Generator().manual_seed(0)) + mean
    scaled, count = learner._normalized(raw)
    assert count == raw.numel()
    exact = raw.double().numpy()
    np.testing.assert_allclose(scaled, (exact - exact.mean()) / exact.std(), atol=2e-3)
    assert abs(scaled.double().mean().item()) < 1e-3
    assert abs(scaled.double().std(unbiased=False).item() - 1.0) < 1e-4


def test_mini_batches_are_the_same_for_one_rank_and_for_two() -> None:
    whole = mini_batch_envs(3, epoch=4, envs=range(0, 24), parts=3)
    first = mini_batch_envs(3, epoch=4, envs=range(0, 12), parts=3)
    second = mini_batch_envs(3, epoch=4, envs=range(12, 24), parts=3)
    np.testing.assert_array_equal(whole, np.concatenate([first, second + 12], axis=1))
    assert sorted(whole.flatten()) == list(range(24))
    assert (mini_batch_envs(3, 5, range(0, 24), 3) != whole).any()


def train(envs: ReachAndGrasp, settings: Settings, updates: int) -> list[float]:
    """The success rate of each update's episodes."""
    torch.manual_seed(settings.seed)
    shape = PolicyShape(envs.state_size, envs.motions, False, settings.normalize)
    policy = make_policy(settings.network, shape, image_size=settings.image_size,
                         recurrent=settings.recurrent, width=settings.width,
                         initial_log_std=-0.5)  # fmt: skip
    learner = PpoLearner(policy, settings, Group.alone())
    options = CollectorOptions(settings.horizon, settings.seed, settings.gamma)
    collector = Collector(envs, policy, options, learner.precision, CPU)
    collector.reset()
    rates = []
    for update in range(updates):
        rollout = collector.collect(update)
        learner.update(rollout, update, update / updates)
        sums = collector.episodes
        rates.append(sums.successes / max(sums.episodes, 1.0))
    return rates


def test_a_policy_without_memory_learns_to_reach_and_grasp() -> None:
    settings = Settings(envs=64, mini_batches=4, epochs=4, horizon=20, learning_rate=3e-3, **TOY)
    rates = train(ReachAndGrasp(64, halves=2), settings, updates=60)
    # Random decisions grasp too early: a few percent.
    assert rates[0] < 0.2 and np.mean(rates[-5:]) > 0.9, rates


def test_what_only_an_image_shows_is_learned_by_eyes_and_by_nothing_else() -> None:
    rates = {}
    for network in ("depth", "state"):
        chosen = {**TOY, "network": network}
        chosen |= {"image_size": Look.EDGE} if network == "depth" else {}
        settings = Settings(
            envs=64, mini_batches=4, epochs=4, horizon=20, learning_rate=2e-3, **chosen
        )
        rates[network] = train(Look(64, halves=2), settings, updates=35)
    assert np.mean(rates["depth"][-5:]) > 0.85, rates
    assert np.mean(rates["state"][-5:]) < 0.3, rates


def test_memory_is_learned_by_a_gru_and_by_nothing_else() -> None:
    rates = {}
    for recurrent in (True, False):
        settings = Settings(envs=64, mini_batches=2, epochs=4, horizon=16, learning_rate=3e-3,
                            recurrent=recurrent, **TOY)  # fmt: skip
        rates[recurrent] = train(Remember(64), settings, updates=40)
    assert np.mean(rates[True][-5:]) > 0.95, rates
    assert np.mean(rates[False][-5:]) < 0.65, rates


def test_exploration_is_limited_along_the_schedule() -> None:
    settings = Settings(network="state", log_std="parameter", final_log_std=-2.0)
    limits = [log_std_limit_at(settings, progress) for progress in (0.0, 0.2, 0.6, 1.0)]
    assert limits == pytest.approx([-0.5, -0.5, -1.25, -2.0])
    assert log_std_limit_at(Settings(), 1.0) == 2.0
    policy = make_policy("state", PolicyShape(state=4, motions=2), initial_log_std=-0.5)
    learner = PpoLearner(policy, settings, Group.alone())
    learner._limit_exploration(0.6)
    assert policy.action.log_std is not None
    assert policy.action.log_std.tolist() == pytest.approx([-1.25, -1.25])
    # The optimizer's flat parameters are the same memory.
    assert -1.25 in learner.optimizer.parameters.tolist()


def test_a_paced_rate_finds_the_one_whose_divergence_is_wanted() -> None:
    for steepness in (1e4, 1e6):
        rate = PacedRate(target_kl=0.01)
        shares = [rate.share]
        for _ in range(40):
            rate.follow(steepness * (1e-2 * rate.share) ** 2)
            shares.append(rate.share)
        assert steepness * (1e-2 * shares[-1]) ** 2 == pytest.approx(0.01)
        steps = np.divide(shares[1:], shares[:-1])
        assert shares[0] < 0.05 and 0.5 <= steps.min() and steps.max() <= 1.2001
    # Where nothing is too far, the schedule's rate; where everything is, hardly any.
    for kl, end in ((1e-9, 1.0), (0.0, 1.0), (1e9, PacedRate.LEAST)):
        rate = PacedRate(target_kl=0.01)
        for _ in range(40):
            rate.follow(kl)
        assert rate.share == end
    rate.follow(float("nan"))
    assert rate.share == PacedRate.LEAST


def test_without_a_wanted_divergence_the_rate_is_the_schedules() -> None:
    rate = PacedRate(target_kl=0.0)
    rate.follow(1.0)
    assert rate.share == 1.0


def test_a_policy_of_little_noise_stays_near_itself_where_the_rate_is_paced() -> None:
    """A trained policy begins anew: Adam knows no gradient yet, and its first steps are the longest."""
    divergences = {}
    for target in (0.0, 0.01):
        torch.manual_seed(1)
        envs = ReachAndGrasp(64)
        settings = Settings(envs=64, horizon=20, learning_rate=3e-3, target_kl=target, epochs=2,
                            mini_batches=4, **TOY)  # fmt: skip
        shape = PolicyShape(envs.state_size, envs.motions, False, settings.normalize)
        policy = make_policy("state", shape, width=settings.width, initial_log_std=-3.0)
        learner = PpoLearner(policy, settings, Group.alone())
        collector = Collector(envs, policy, CollectorOptions(settings.horizon, 1, settings.gamma),
                              learner.precision, CPU)  # fmt: skip
        collector.reset()
        divergences[target] = [
            learner.update(collector.collect(update), update, 0.0)["kl"] for update in range(40)
        ]
        rate = learner.optimizer.learning_rate
    free, paced = divergences.values()
    assert free[0] > 0.05 and max(paced) < 0.04, divergences
    # From then on it is about what is wanted, where the schedule's rate leads further.
    assert 0.005 < np.mean(paced[-20:]) < 0.02 < np.mean(free[-20:]), divergences
    assert rate < 2e-3


def test_a_rate_is_not_paced_by_what_is_always_zero() -> None:
    """The divergence is measured before each mini-batch's step: there has to be one before."""
    for epochs, mini_batches in ((1, 2), (2, 1), (1, 1)):
        settings = Settings(envs=8, horizon=8, network="state", width=16, target_kl=0.01, learning_rate=1.0,
                            epochs=epochs, mini_batches=mini_batches)  # fmt: skip
        toy = ReachAndGrasp(settings.envs, halves=settings.halves)
        trainer = Trainer(settings, toy, Group.alone(), None)
        trainer.begin()
        kl = trainer._iterate()[0]["kl"]
        if epochs * mini_batches > 1:
            assert kl > 0.0
            settings.require_pace()
            continue
        assert kl == pytest.approx(0.0, abs=1e-9)
        with pytest.raises(SettingsError, match="--mini-batches 1 there is no other; take more of"):
            settings.require_pace()
    dataclasses.replace(settings, target_kl=0.0).require_pace()
