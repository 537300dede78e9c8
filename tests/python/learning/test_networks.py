"""The policies: the paper's parameter counts, memory across episodes, normalization."""

import contextlib

import pytest
import torch
from torch.nn import functional

from galactic.learning.encoders import Inputs, Tanh
from galactic.learning.policies.distributions import ActionDistribution
from galactic.learning.policies.networks import PolicyShape, make_policy
from galactic.learning.policies.normalization import Normalizer
from galactic.learning.policies.sight import SIGHT
from galactic.learning.sequences import run_gru
from galactic.learning.updates.precision import Precision

ARM_OF_SEVEN = PolicyShape(state=26, motions=9)


def parameters(policy: torch.nn.Module) -> int:
    return sum(parameter.numel() for parameter in policy.parameters())


@pytest.mark.parametrize(
    "network, count", [("simple_cnn", 4_046_999), ("resnet9", 4_338_007), ("resnet18", 5_906_647)]
)
def test_the_networks_have_exactly_the_parameters_of_table_4(network: str, count: int) -> None:
    assert parameters(make_policy(network, ARM_OF_SEVEN)) == count


@pytest.mark.parametrize("network", ["simple_cnn", "resnet9", "resnet18"])
def test_the_heads_have_the_parameters_of_the_paper(network: str) -> None:
    policy = make_policy(network, ARM_OF_SEVEN)
    assert parameters(policy.action) + parameters(policy.critic) == 11_799


def some_inputs(network: str, steps: int, envs: int, edge: int = 128) -> Inputs:
    random = torch.Generator().manual_seed(7)
    state = torch.randn(steps, envs, 26, generator=random)
    images: dict[str, torch.Tensor] = {}
    if "rgb" in SIGHT[network]:
        rgb = torch.randint(0, 256, (steps, envs, edge, edge, 3), generator=random)
        images["rgb"] = rgb.to(torch.uint8)
    if "depth" in SIGHT[network]:
        images["depth"] = 12.0 * torch.rand(steps, envs, edge, edge, generator=random)
    return Inputs(state, previous=torch.randn(steps, envs, 11, generator=random), **images)


POLICIES = [
    ("state", False),
    ("state", True),
    ("depth", False),
    ("depth", True),
    ("simple_cnn", False),
    ("resnet9", False),
]


@pytest.mark.parametrize("network, recurrent", POLICIES)
def test_a_sequence_equals_its_steps_one_after_another(network: str, recurrent: bool) -> None:
    torch.manual_seed(3)
    policy = make_policy(network, ARM_OF_SEVEN, recurrent=recurrent)
    steps, envs = 6, 3
    inputs = some_inputs(network, steps, envs)
    starts = torch.zeros(steps, envs, dtype=torch.bool)
    starts[0, 1] = starts[2, 0] = starts[5, 2] = starts[2, 1] = starts[3, 1] = True
    hidden = policy.initial_hidden(envs, torch.device("cpu"))
    if hidden is not None:
        hidden = torch.randn_like(hidden)
    with torch.no_grad():
        whole = policy(inputs, hidden, starts)
        for step in range(steps):
            row = Inputs(*(None if part is None else part[step : step + 1] for part in inputs))
            one = policy(row, hidden, starts[step : step + 1])
            hidden = one.hidden
            torch.testing.assert_close(one.values[0], whole.values[step])
            torch.testing.assert_close(one.actions.mean[0], whole.actions.mean[step])
    if hidden is not None:
        torch.testing.assert_close(hidden, whole.hidden)


@pytest.mark.parametrize("network, recurrent", POLICIES)
def test_the_actor_does_not_see_what_the_critic_alone_sees(network: str, recurrent: bool) -> None:
    torch.manual_seed(8)
    apart = (4, 5, 19)
    shape = ARM_OF_SEVEN._replace(critic_only=apart, normalize=True, closeup=0.3)
    policy = make_policy(network, shape, recurrent=recurrent)
    steps, envs = 3, 2
    inputs = some_inputs(network, steps, envs)
    inputs.state.requires_grad_()
    hidden = policy.initial_hidden(envs, torch.device("cpu"))
    starts = torch.zeros(steps, envs, dtype=torch.bool)
    columns = torch.zeros(26, dtype=torch.bool)
    columns[list(apart)] = True

    def gradient(of: torch.Tensor) -> torch.Tensor:
        return torch.autograd.grad(of.sum(), inputs.state, retain_graph=True)[0].abs().sum((0, 1))

    outputs = policy(inputs, hidden, starts)
    acted = policy.act(inputs, hidden, starts).actions
    for actions in (outputs.actions, acted):
        for part in (actions.mean, actions.log_std, actions.logits):
            felt = gradient(part)
            assert not felt[columns].any() and felt[~columns].all()
    for values in (outputs.values, policy.value(inputs, hidden, starts)):
        assert gradient(values).all()


def test_what_nobody_hides_leaves_a_network_as_it_was() -> None:
    names = {name for name, _ in make_policy("state", ARM_OF_SEVEN, recurrent=True).named_modules()}
    assert not names & {"blinkers", "value_encoder"}


@pytest.mark.parametrize("log_std", [None, -0.5])
@pytest.mark.parametrize("network, recurrent", POLICIES[:-1])  # a GroupNorm mixes no types here
def test_heads_are_float32_after_a_network_of_bfloat16(
    network: str, recurrent: bool, log_std: float | None
) -> None:
    torch.manual_seed(11)
    policy = make_policy(network, ARM_OF_SEVEN, recurrent=recurrent, initial_log_std=log_std)
    with torch.no_grad():
        policy.critic.bias.fill_(9.0)  # neighbors in bfloat16 are 1/16 apart there
        policy.action.linear.bias.uniform_(0.1, 1.0)
    steps, envs = 3, 4
    inputs = some_inputs(network, steps, envs)
    hidden = policy.initial_hidden(envs, torch.device("cpu"))
    starts = torch.zeros(steps, envs, dtype=torch.bool)
    features: dict[torch.nn.Module, torch.Tensor] = {}
    for head in (policy.action.linear, policy.critic):
        head.register_forward_pre_hook(lambda head, seen: features.update({head: seen[0]}))
    with torch.no_grad():
        with torch.autocast("cpu", dtype=torch.bfloat16):
            found = policy(inputs, hidden, starts)
            values = policy.value(inputs, hidden, starts)
            acted = policy.act(inputs, hidden, starts).actions
        wide = {head: seen.float() for head, seen in features.items()}
        rows, wanted = (
            functional.linear(wide[head], head.weight, head.bias)
            for head in (policy.action.linear, policy.critic)
        )
    for one in (found.values, values, *found.actions[:3], *acted[:3]):
        assert one.dtype == torch.float32
    for one in (found.values, values):
        assert torch.equal(one, wanted.squeeze(-1))
        assert not torch.equal(one, one.bfloat16().float())
    for actions in (found.actions, acted):
        assert torch.equal(actions.mean, torch.tanh(rows[..., :9]))
        assert torch.equal(actions.logits, rows[..., -3::2] - rows[..., -4::2])
        assert not torch.equal(actions.logits, actions.logits.bfloat16().float())


@pytest.mark.parametrize("network, recurrent", POLICIES[:-1])  # a GroupNorm mixes no types here
def test_the_state_is_not_rounded_in_a_network_of_bfloat16(network: str, recurrent: bool) -> None:
    """7.01 m would be 7 m."""
    torch.manual_seed(12)
    policy = make_policy(network, ARM_OF_SEVEN, recurrent=recurrent)
    with torch.no_grad():
        for name, parameter in policy.named_parameters():
            if "visual" not in name and "eyes" not in name:
                parameter.mul_(3.0)  # of heads that act on what they see
    inputs = some_inputs(network, 1, 4)
    near = inputs._replace(state=torch.full_like(inputs.state, 7.0))
    far = inputs._replace(state=torch.full_like(inputs.state, 7.01))
    assert torch.equal(near.state.bfloat16(), far.state.bfloat16())
    hidden = policy.initial_hidden(4, torch.device("cpu"))
    starts = torch.zeros(1, 4, dtype=torch.bool)
    with torch.no_grad(), torch.autocast("cpu", dtype=torch.bfloat16):
        one, other = (policy(seen, hidden, starts) for seen in (near, far))
    assert not torch.equal(one.values, other.values)
    assert not torch.equal(one.actions.mean, other.actions.mean)


def test_bfloat16_is_for_networks_that_see_images(monkeypatch: pytest.MonkeyPatch) -> None:
    begun: list[tuple[str, torch.dtype]] = []

    def autocast(device: str, dtype: torch.dtype) -> contextlib.nullcontext:
        begun.append((device, dtype))
        return contextlib.nullcontext()

    monkeypatch.setattr(torch, "autocast", autocast)
    for flags in (torch.backends.cuda.matmul, torch.backends.cudnn):
        monkeypatch.setattr(flags, "allow_tf32", flags.allow_tf32)
    monkeypatch.setattr(torch.backends.cudnn, "benchmark", torch.backends.cudnn.benchmark)
    Precision("bf16", torch.device("cuda"), sees_images=False).autocast()
    assert not begun
    Precision("bf16", torch.device("cuda")).autocast()
    assert begun == [("cuda", torch.bfloat16)]


def test_memory_does_not_cross_the_start_of_an_episode() -> None:
    torch.manual_seed(4)
    rnn = torch.nn.GRU(5, 8)
    inputs = torch.randn(10, 4, 5)
    starts = torch.rand(10, 4) < 0.3
    hidden = torch.randn(4, 8)
    outputs, last = run_gru(rnn, inputs, hidden, starts)
    for env in range(4):
        memory = hidden[env]
        for step in range(10):
            if starts[step, env]:
                memory = torch.zeros(8)
            memory = rnn(inputs[step, env].view(1, 1, 5), memory.view(1, 1, 8))[0].view(8)
            torch.testing.assert_close(outputs[step, env], memory)
        torch.testing.assert_close(last[env], memory)
    assert 4 < int(starts.sum()) < 36


@pytest.mark.parametrize("steps", [1, 6])
def test_memory_is_float32_in_a_network_of_bfloat16(steps: int) -> None:
    """On a GPU, torch would compute it in float16."""
    torch.manual_seed(6)
    rnn = torch.nn.GRU(5, 8)
    inputs, hidden = torch.randn(steps, 4, 5).bfloat16(), torch.randn(4, 8).bfloat16()
    starts = torch.rand(steps, 4) < 0.3
    seen: list[object] = []
    rnn.register_forward_pre_hook(lambda _, given: seen.extend((given[0][0].dtype, given[1].dtype)))
    rnn.register_forward_pre_hook(lambda *_: seen.append(torch.is_autocast_cpu_enabled()))
    with torch.autocast("cpu", dtype=torch.bfloat16):
        found = run_gru(rnn, inputs, hidden, starts)
    assert seen == [torch.float32, torch.float32, False]
    for one, wanted in zip(found, run_gru(rnn, inputs.float(), hidden.float(), starts)):
        assert one.dtype == torch.float32 and torch.equal(one, wanted)


def test_gradients_stop_at_the_start_of_an_episode() -> None:
    torch.manual_seed(5)
    rnn = torch.nn.GRU(5, 8)
    inputs = torch.randn(6, 1, 5, requires_grad=True)
    starts = torch.zeros(6, 1, dtype=torch.bool)
    starts[3] = True
    outputs, _ = run_gru(rnn, inputs, torch.zeros(1, 8), starts)
    outputs[5].sum().backward()
    assert inputs.grad is not None
    assert (inputs.grad[:3] == 0).all() and (inputs.grad[3:] != 0).any(dim=-1).all()


@pytest.mark.parametrize("network", ["state", "depth"])
def test_actions_and_values_apart_are_those_of_both_together(network: str) -> None:
    policy = make_policy(network, ARM_OF_SEVEN)
    inputs = some_inputs(network, 4, 3)
    starts = torch.zeros(4, 3, dtype=torch.bool)
    whole = policy(inputs, None, starts)
    acted = policy.act(inputs, None, starts)
    torch.testing.assert_close(policy.value(inputs, None, starts), whole.values)
    torch.testing.assert_close(acted.actions.mean, whole.actions.mean)
    # Only where values cost a pass through the eyes, they come with the actions.
    assert torch.equal(acted.values, whole.values) is not policy.values_apart


@pytest.mark.parametrize("edge", [36, 37, 43, 44, 64, 128])
def test_eyes_see_images_of_any_size(edge: int) -> None:
    """What was drawn in the last rows and columns, too, but for those behind the last stride."""
    policy = make_policy("depth", ARM_OF_SEVEN, image_size=edge)
    inputs = some_inputs("depth", 1, 2, edge)
    starts = torch.ones(1, 2, dtype=torch.bool)
    assert policy(inputs, None, starts).values.shape == (1, 2)
    assert policy.eyes is not None and inputs.depth is not None
    depth = inputs.depth.clone().requires_grad_()
    policy.eyes(inputs._replace(depth=depth)).square().sum().backward()
    assert depth.grad is not None
    seen = (depth.grad != 0.0).any(0).any(0)
    reach = 36 + 8 * ((edge - 36) // 8)
    assert seen[:reach, :reach].float().mean() > 0.7  # not what is further than 10 m
    assert not seen[reach:].any() and not seen[:, reach:].any()


def test_eyes_see_what_is_far_as_the_paper_does() -> None:
    policy = make_policy("depth", ARM_OF_SEVEN, image_size=36)
    inputs = some_inputs("depth", 1, 1, 36)

    def sees(meters: float) -> torch.Tensor:
        return policy.eyes(inputs._replace(depth=torch.full((1, 1, 36, 36), meters)))

    assert torch.equal(sees(10.0), sees(70.0)) and not torch.equal(sees(10.0), sees(9.0))


@pytest.mark.parametrize("network", ["state", "simple_cnn"])
def test_decisions_are_never_surer_than_their_limit(network: str) -> None:
    found = {}
    for limit in (0.0, 3.0):
        torch.manual_seed(5)
        policy = make_policy(network, ARM_OF_SEVEN, odds_limit=limit)
        policy.action.linear.weight.data.normal_(0.0, 3.0)
        hidden = policy.initial_hidden(50, torch.device("cpu"))
        found[limit] = policy(
            some_inputs(network, 1, 50), hidden, torch.ones(1, 50, dtype=torch.bool)
        ).actions
    free, limited = found[0.0], found[3.0]
    assert free.logits.abs().max() > 9.0 and 2.9 < limited.logits.abs().max() <= 3.0
    assert torch.equal(free.mode(), limited.mode()) and torch.equal(free.mean, limited.mean)
    # Near even odds, they are as they were.
    near = free.logits.abs() < 1.0
    torch.testing.assert_close(limited.logits[near], free.logits[near], rtol=0.0, atol=0.05)
    assert near.any()


def test_pictures_are_scaled_as_the_paper_says() -> None:
    from galactic.learning.encoders import images

    rgb = torch.full((1, 1, 2, 2, 3), 255, dtype=torch.uint8)
    depth = torch.tensor([0.0, 5.0, 10.0, 70.0]).view(1, 1, 2, 2)
    seen = images(Inputs(torch.zeros(1, 1, 26), rgb, depth))
    assert seen.shape == (1, 4, 2, 2) and seen.is_contiguous(memory_format=torch.channels_last)
    assert (seen[0, :3] == 1.0).all()
    torch.testing.assert_close(seen[0, 3].flatten(), torch.tensor([0.0, 0.5, 1.0, 1.0]))


def test_the_quick_tanh_is_tanh() -> None:
    inputs = torch.linspace(-20.0, 20.0, 4001, requires_grad=True)
    ours = Tanh()(inputs)
    (gradient,) = torch.autograd.grad(ours.sum(), inputs)
    torch.testing.assert_close(ours, torch.tanh(inputs), rtol=0.0, atol=3e-7)
    (expected,) = torch.autograd.grad(torch.tanh(inputs).sum(), inputs)
    torch.testing.assert_close(gradient, expected, rtol=0.0, atol=6e-7)


@pytest.mark.parametrize("decides", [True, False])
def test_log_probability_and_entropy_equal_those_of_torch(decides: bool) -> None:
    random = torch.Generator().manual_seed(6)
    mean = torch.randn(50, 9, generator=random)
    log_std = torch.randn(50, 9, generator=random)
    logits = 2.0 * torch.randn(50, 2, generator=random)
    ours = ActionDistribution(mean, log_std, logits, decides)
    noise = torch.cat(
        [torch.randn(50, 9, generator=random), torch.rand(50, 2, generator=random)], 1
    )
    action = ours.sample(noise)
    gaussian = torch.distributions.Normal(mean, log_std.exp())
    decisions = torch.distributions.Bernoulli(logits=logits)
    count = 2 if decides else 1
    log_prob = gaussian.log_prob(action[:, :9]).sum(1)
    log_prob += decisions.log_prob(action[:, 9:])[:, :count].sum(1)
    entropy = gaussian.entropy().sum(1) + decisions.entropy()[:, :count].sum(1)
    torch.testing.assert_close(ours.log_prob(action), log_prob, rtol=1e-5, atol=1e-5)
    torch.testing.assert_close(ours.entropy(), entropy, rtol=1e-5, atol=1e-5)
    if decides:
        assert 0.1 < float(action[:, 10].mean()) < 0.9
    else:
        assert (action[:, 10] == 0.0).all() and (ours.mode()[:, 10] == 0.0).all()


def test_samples_follow_the_odds() -> None:
    logits = torch.tensor([[-2.0, 1.0]]).expand(20_000, 2)
    uniform = torch.rand(20_000, 2, generator=torch.Generator().manual_seed(8))
    noise = torch.cat([torch.zeros(20_000, 1), uniform], 1)
    ones = torch.zeros(20_000, 1)
    action = ActionDistribution(ones, ones, logits, True).sample(noise)
    # Three standard errors of 20,000 draws are below 0.011.
    torch.testing.assert_close(
        action[:, 1:].mean(0), torch.sigmoid(logits[0]), rtol=0.0, atol=0.011
    )


def test_a_normalizer_that_absorbs_in_parts_knows_the_whole() -> None:
    random = torch.Generator().manual_seed(9)
    rows = 5.0 + 3.0 * torch.randn(1000, 4, generator=random)
    rows[:, 3] = 2.0
    normalizer = Normalizer(4)
    for part in rows.split([10, 490, 500]):
        # Two ranks of half a part each.
        ranks = [normalizer.sums(half, normalizer.center) for half in part.chunk(2)]
        normalizer.absorb(ranks[0] + ranks[1])
    expected = (rows - rows.mean(0)) / torch.sqrt(rows.var(0, unbiased=False) + 1e-5)
    torch.testing.assert_close(normalizer(rows), expected.clamp(-10.0, 10.0), rtol=0.0, atol=1e-4)
    assert float(normalizer(torch.full((1, 4), 1e6)).max()) == 10.0


def test_a_normalizer_stands_still_until_it_absorbs() -> None:
    policy = make_policy("state", ARM_OF_SEVEN._replace(normalize=True))
    before = {name: value.clone() for name, value in policy.state_dict().items()}
    policy(some_inputs("state", 3, 5), None, torch.zeros(3, 5, dtype=torch.bool))
    assert all(torch.equal(value, before[name]) for name, value in policy.state_dict().items())
    assert "normalize.mean" in before


@pytest.mark.parametrize("recurrent", [False, True])
@pytest.mark.parametrize("scales", [(0.2, 0.0), (0.0, 0.04), (0.2, 0.04)])
def test_closeups_are_seen_beside_the_normalized_state(
    recurrent: bool, scales: tuple[float, float]
) -> None:
    shape = PolicyShape(26, 9, normalize=True, closeup=scales[0], second_closeup=scales[1])
    policy = make_policy("state", shape, recurrent=recurrent)
    state = torch.full((1, 1, 26), 0.05)
    normal, *closeups = policy._seen(Inputs(state)).split(26, -1)
    torch.testing.assert_close(normal, policy.normalize(state))
    for closeup, scale in zip(closeups, filter(None, scales), strict=True):
        torch.testing.assert_close(closeup, torch.tanh(state / scale))
    starts = torch.ones(1, 1, dtype=torch.bool)
    hidden = policy.initial_hidden(1, torch.device("cpu"))
    assert policy(Inputs(state), hidden, starts).actions.mean.shape == (1, 1, 9)
