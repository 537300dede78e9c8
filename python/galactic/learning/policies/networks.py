"""The policies: the paper's three networks; two for processors, `state` without a camera and
`depth` with one; and those around a user-defined encoder.

Every policy is the same plain chain, kept in these attributes so that an exporter can walk it:

    normalize   Normalizer of the state, or None
    closeup     Closeup of the state, or None
    eyes        DepthCNN: depth -> numbers behind those of the state, or None
    blinkers    Blinkers: keeps from the actor what the critic alone sees, or None
    encoder     inputs -> features
    rnn         nn.GRU of one layer, or None
    action      ActorHead: one FullLinear for means, log-stds (unless those are a parameter), decisions
    critic      FullLinear: the value

A policy without `rnn` (class FeedForwardPolicy) has two encoders, `encoder` for the actor and
`value_encoder` for the critic, which share only the modules before them. A policy with `rnn` has a
`value_encoder` after it if the critic sees more than the actor. So does an EncoderPolicy, whose
memory, if any, is in the encoder.

Rows of `action.linear`: a mean for each motion (before tanh), a log-std for each, then two logits (no,
yes) each for hand and terminate.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn

from galactic.learning.encoders import (
    FEATURES,
    DepthCNN,
    Encoder,
    FullLinear,
    Inputs,
    ResNet,
    SimpleCNN,
    StateEncoder,
    orthogonal,
    perceptron,
)
from galactic.learning.policies.distributions import (
    DECISIONS,
    HIGHEST_LOG_STD,
    LOWEST_LOG_STD,
    ActionDistribution,
)
from galactic.learning.policies.normalization import Closeup, Normalizer
from galactic.learning.policies.sight import IMAGE_SIZE, SIGHT
from galactic.learning.sequences import run_gru


class Outputs(NamedTuple):
    """What a policy computes from its Inputs."""

    actions: ActionDistribution  # of shape [T, n]
    values: Tensor  # [T, n]
    hidden: Tensor | None  # [n, H] after the last step; None without a GRU


class PolicyShape(NamedTuple):
    """Sizes that depend on the world, and the choices that all policies share."""

    state: int  # numbers in a row of observations
    motions: int  # continuous actions
    decides_terminate: bool = True
    normalize: bool = False
    closeup: float = 0.0  # a scale of the Closeup of the state; 0: none
    second_closeup: float = 0.0  # another one
    critic_only: tuple[int, ...] = ()  # columns of that row that the actor does not see

    @property
    def closeups(self) -> tuple[float, ...]:
        """The scales that are in use."""
        return tuple(scale for scale in (self.closeup, self.second_closeup) if scale > 0.0)

    @property
    def seen(self) -> int:
        """How many numbers the critic reads of the state, including closeups."""
        return self.state * (1 + len(self.closeups))

    @property
    def apart(self) -> int:
        """How many of these only the critic reads."""
        return len(self.critic_only) * (1 + len(self.closeups))


class Blinkers(nn.Module):
    """Rows [..., S + F], the state as Policy sees it and F = `features` -> the columns that the
    actor sees (Pinto et al. 2018, asymmetric actor-critic)."""

    def __init__(self, shape: PolicyShape, features: int):
        super().__init__()
        firsts = range(0, shape.seen, shape.state)
        apart = [first + column for first in firsts for column in shape.critic_only]
        ahead = sorted(set(range(shape.seen + features)) - set(apart))
        # Not persistent: they follow from the shape, which checkpoints hold.
        self.register_buffer("ahead", torch.tensor(ahead), persistent=False)
        self.register_buffer("aside", torch.tensor(apart), persistent=False)

    ahead: Tensor
    aside: Tensor

    def forward(self, seen: Tensor) -> Tensor:
        return seen.index_select(-1, self.ahead)

    def hidden(self, seen: Tensor) -> Tensor:
        """The columns that only the critic sees."""
        return seen.index_select(-1, self.aside)


class ActorHead(nn.Module):
    """Features [..., F] -> ActionDistribution. A single linear layer, hence a single matrix
    multiplication.

    `initial_log_std` None: log-stds are outputs of the layer, clamped to [-5, 2] (paper); a number:
    they are parameters that do not depend on the state, with this initial value. `odds_limit`: the
    log-odds of a decision stay between -`odds_limit` and `odds_limit`; 0: no limit.
    """

    def __init__(self, features: int, shape: PolicyShape, initial_log_std: float | None = None,
                 odds_limit: float = 0.0):  # fmt: skip
        super().__init__()
        self.motions = shape.motions
        self.decides_terminate = shape.decides_terminate
        self.odds_limit = odds_limit
        self.log_std: nn.Parameter | None = None
        if initial_log_std is not None:
            self.log_std = nn.Parameter(torch.full((shape.motions,), initial_log_std))
        rows = shape.motions * (2 if self.log_std is None else 1) + 2 * DECISIONS
        self.linear = FullLinear(features, rows)
        orthogonal(self.linear, 0.01)

    def forward(self, features: Tensor) -> ActionDistribution:
        rows = self.linear(features)
        mean = torch.tanh(rows[..., : self.motions])
        if self.log_std is None:
            log_std = rows[..., self.motions : 2 * self.motions]
        else:
            log_std = self.log_std.expand_as(mean)
        log_std = log_std.clamp(LOWEST_LOG_STD, HIGHEST_LOG_STD)
        choices = rows[..., -2 * DECISIONS :]
        odds = choices[..., 1::2] - choices[..., 0::2]
        if self.odds_limit > 0.0:
            odds = torch.tanh(odds * (1.0 / self.odds_limit)) * self.odds_limit
        return ActionDistribution(mean, log_std, odds, self.decides_terminate)

    def limit_log_std(self, highest: float = HIGHEST_LOG_STD) -> None:
        """Clamps log-stds that are parameters: outside the range to which forward() clamps them, no
        gradient would lead back."""
        if self.log_std is not None:
            with torch.no_grad():
                self.log_std.clamp_(LOWEST_LOG_STD, highest)

    def start_terminate(self, logit: float) -> None:
        """Makes `logit` the log-odds of terminating, whatever the features are."""
        with torch.no_grad():
            self.linear.weight[-2:] = 0.0
            self.linear.bias[-2:] = torch.tensor([-0.5 * logit, 0.5 * logit])


class Policy(nn.Module):
    """What the trainer asks of a policy."""

    hidden_size = 0
    """Size of the memory of each env; 0: no memory."""
    needs_previous = False
    values_apart = False
    """Whether value() costs less than forward(): then values are computed after the rollout."""

    action: ActorHead

    def __init__(self, shape: PolicyShape, eyes: DepthCNN | None = None):
        super().__init__()
        self.normalize = Normalizer(shape.state) if shape.normalize else None
        self.closeup = Closeup(shape.closeups) if shape.closeups else None
        self.eyes = eyes
        features = eyes.features if eyes else 0
        self.blinkers = Blinkers(shape, features) if shape.critic_only else None

    def forward(self, inputs: Inputs, hidden: Tensor | None, starts: Tensor) -> Outputs:
        """`hidden` [n, H] is the memory before the first step; `starts` [T, n] bool marks where an
        episode begins and the memory is cleared."""
        raise NotImplementedError

    def act(self, inputs: Inputs, hidden: Tensor | None, starts: Tensor) -> Outputs:
        """forward() for rollouts: with `values_apart`, `values` are not computed, and must not be
        used."""
        return self(inputs, hidden, starts)

    def value(self, inputs: Inputs, hidden: Tensor | None, starts: Tensor) -> Tensor:
        """The values alone, [T, n]."""
        return self(inputs, hidden, starts).values

    def initial_hidden(self, envs: int, device: torch.device) -> Tensor | None:
        """An empty memory, [envs, H], or None."""
        return torch.zeros(envs, self.hidden_size, device=device) if self.hidden_size else None

    def _seen(self, inputs: Inputs) -> Tensor:
        """The state and the output of the eyes, as the critic reads them."""
        state = inputs.state
        parts = [state if self.normalize is None else self.normalize(state)]
        if self.closeup is not None:
            parts.append(self.closeup(state))
        if self.eyes is not None:
            parts.append(self.eyes(inputs))
        return parts[0] if len(parts) == 1 else torch.cat(parts, -1)

    def _by_actor(self, seen: Tensor) -> Tensor:
        """The same as the actor reads it."""
        return seen if self.blinkers is None else self.blinkers(seen)

    def _judged(self, features: Tensor, seen: Tensor, join: nn.Module | None) -> Tensor:
        """The features as the critic reads them, joined with what only the critic sees."""
        if self.blinkers is None or join is None:
            return features
        return join(torch.cat([features, self.blinkers.hidden(seen)], -1))


class FeedForwardPolicy(Policy):
    """Two separate perceptrons, actor and critic, without memory; they share their eyes, if there
    are any."""

    def __init__(self, shape: PolicyShape, width: int, layers: int, activation: str,
                 initial_log_std: float | None, odds_limit: float,
                 eyes: DepthCNN | None):  # fmt: skip
        super().__init__(shape, eyes)
        self.values_apart = eyes is None
        seen = shape.seen + (eyes.features if eyes else 0)
        self.encoder = perceptron(seen - shape.apart, width, layers, activation)
        self.value_encoder = perceptron(seen, width, layers, activation)
        self.action = ActorHead(width, shape, initial_log_std, odds_limit)
        self.critic = orthogonal(FullLinear(width, 1), 1.0)

    def forward(self, inputs: Inputs, hidden: Tensor | None, starts: Tensor) -> Outputs:
        seen = self._seen(inputs)
        values = self.critic(self.value_encoder(seen)).squeeze(-1)
        return Outputs(self.action(self.encoder(self._by_actor(seen))), values, None)

    def act(self, inputs: Inputs, hidden: Tensor | None, starts: Tensor) -> Outputs:
        if not self.values_apart:
            return self(inputs, hidden, starts)
        seen = self._seen(inputs)
        return Outputs(self.action(self.encoder(self._by_actor(seen))), seen[..., 0], None)

    def value(self, inputs: Inputs, hidden: Tensor | None, starts: Tensor) -> Tensor:
        return self.critic(self.value_encoder(self._seen(inputs))).squeeze(-1)


class RecurrentPolicy(Policy):
    """An encoder, a GRU, and heads for actor and critic. If the critic sees more than the actor, a
    layer before its head joins that with the features."""

    def __init__(self, encoder: Encoder, shape: PolicyShape, width: int,
                 initial_log_std: float | None, odds_limit: float,
                 eyes: DepthCNN | None = None):  # fmt: skip
        super().__init__(shape, eyes)
        self.hidden_size = width
        self.needs_previous = encoder.needs_previous
        self.encoder = encoder
        self.rnn = nn.GRU(encoder.features, width)
        self.action = ActorHead(width, shape, initial_log_std, odds_limit)
        self.value_encoder: nn.Module | None = None
        if shape.critic_only:
            self.value_encoder = perceptron(width + shape.apart, width, 1, "tanh")
        self.critic = orthogonal(FullLinear(width, 1), 1.0)
        for name, parameter in self.rnn.named_parameters():
            if "weight" in name:
                nn.init.orthogonal_(parameter)
            else:
                nn.init.zeros_(parameter)

    def forward(self, inputs: Inputs, hidden: Tensor | None, starts: Tensor) -> Outputs:
        assert hidden is not None
        seen = self._seen(inputs)
        features = self.encoder(inputs._replace(state=self._by_actor(seen)))
        features, hidden = run_gru(self.rnn, features, hidden, starts)
        judged = self._judged(features, seen, self.value_encoder)
        return Outputs(self.action(features), self.critic(judged).squeeze(-1), hidden)


class EncoderPolicy(Policy):
    """An encoder, with or without a memory of its own, and heads for actor and critic. If the
    critic sees more than the actor, a layer before its head joins that with the features."""

    def __init__(self, encoder: Encoder, shape: PolicyShape, initial_log_std: float | None,
                 odds_limit: float):  # fmt: skip
        super().__init__(shape)
        self.hidden_size = encoder.memory
        self.needs_previous = encoder.needs_previous
        self.encoder = encoder
        width = encoder.features
        self.action = ActorHead(width, shape, initial_log_std, odds_limit)
        self.value_encoder: nn.Module | None = None
        if shape.critic_only:
            self.value_encoder = perceptron(width + shape.apart, width, 1, "tanh")
        self.critic = orthogonal(FullLinear(width, 1), 1.0)

    def forward(self, inputs: Inputs, hidden: Tensor | None, starts: Tensor) -> Outputs:
        seen = self._seen(inputs)
        inputs = inputs._replace(state=self._by_actor(seen))
        if hidden is None:
            features = self.encoder(inputs)
        else:
            features, memory = self.encoder(inputs, hidden, starts)
            hidden = memory.float()
        judged = self._judged(features, seen, self.value_encoder)
        return Outputs(self.action(features), self.critic(judged).squeeze(-1), hidden)


def make_policy(network: str, shape: PolicyShape, *, image_size: int = IMAGE_SIZE,
                recurrent: bool = False, width: int = 128, layers: int = 2,
                activation: str = "tanh", initial_log_std: float | None = None,
                odds_limit: float = 0.0, own: Encoder | None = None) -> Policy:  # fmt: skip
    """Makes the policy of this name, one of SIGHT, or one around the user-defined encoder `own`.

    `image_size`, `recurrent`, `width`, `layers`, `activation` and `initial_log_std` apply to
    `state` and `depth`; the paper's networks are fixed. With `own`, `recurrent` puts a GRU of
    `width` behind the encoder, and `initial_log_std` applies, too. Weights come from torch's global
    random stream.
    """
    if own is not None:
        if recurrent:
            return RecurrentPolicy(own, shape, width, initial_log_std, odds_limit)
        return EncoderPolicy(own, shape, initial_log_std, odds_limit)
    if network in ("state", "depth"):
        eyes = DepthCNN(image_size, width) if network == "depth" else None
        if not recurrent:
            return FeedForwardPolicy(
                shape, width, layers, activation, initial_log_std, odds_limit, eyes
            )
        seen = shape.seen - shape.apart + (eyes.features if eyes else 0)
        encoder: Encoder = StateEncoder(seen, width, layers, activation)
        return RecurrentPolicy(encoder, shape, width, initial_log_std, odds_limit, eyes)
    if network == "simple_cnn":
        return RecurrentPolicy(
            SimpleCNN(shape.seen - shape.apart), shape, FEATURES, None, odds_limit
        )
    if network in ("resnet9", "resnet18"):
        blocks = 1 if network == "resnet9" else 2
        encoder = ResNet(shape.seen - shape.apart, shape.motions + DECISIONS, blocks)
        return RecurrentPolicy(encoder, shape, FEATURES, None, odds_limit)
    raise ValueError(f'"{network}" is not a network; the networks are {", ".join(SIGHT)}')
