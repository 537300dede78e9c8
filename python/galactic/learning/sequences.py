"""A GRU over rollouts in which episodes end and begin."""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn.utils.rnn import PackedSequence


def run_gru(rnn: nn.GRU, inputs: Tensor, hidden: Tensor, starts: Tensor) -> tuple[Tensor, Tensor]:
    """Runs `rnn` over T steps of n envs. The memory of an env is cleared where an episode starts.

    inputs [T, n, F], hidden [n, H] from before the first step, starts [T, n] bool. Returns outputs
    [T, n, H] and the memory after the last step, [n, H].

    Each stretch between two starts is a sequence of its own. Sorted by length they are one packed
    sequence, so that cuDNN, or one loop in C++, does all of it (Wijmans et al., DD-PPO, do the same).

    Computed in float32, whatever the precision of the layers around it: under autocast to bfloat16,
    torch still lets cuDNN run a GRU in float16, in which small gradients would underflow.
    """
    with torch.autocast(inputs.device.type, enabled=False):
        return _run_gru(rnn, inputs.float(), hidden.float(), starts)


def _run_gru(rnn: nn.GRU, inputs: Tensor, hidden: Tensor, starts: Tensor) -> tuple[Tensor, Tensor]:
    if len(inputs) == 1:
        kept = hidden * (~starts[0]).unsqueeze(-1)
        outputs, last = rnn(inputs, kept.unsqueeze(0))
        return outputs, last[0]
    packing = _Packing(starts)
    first = hidden[packing.env] * packing.continued.unsqueeze(-1)
    flat = inputs.flatten(0, 1)
    packed = PackedSequence(flat[packing.rows], packing.batch_sizes)
    outputs, last = rnn(packed, first.unsqueeze(0))
    unpacked = torch.empty(
        (flat.shape[0], rnn.hidden_size), dtype=outputs.data.dtype, device=flat.device
    )
    unpacked = unpacked.index_copy(0, packing.rows, outputs.data)
    return unpacked.view(*starts.shape, -1), last[0][packing.last_of_env]


class _Packing:
    """Where each step of [T, n] stands in a packed sequence.

    rows         [T n] index into the flattened steps, in the order of the packed data
    batch_sizes  [longest] on the processor, as PackedSequence wants it
    env          [stretches]
    continued    [stretches] bool: goes on from the step before the first
    last_of_env  [n] the stretch that an env ends with
    """

    def __init__(self, starts: Tensor):
        steps, envs = starts.shape
        device = starts.device
        begins = starts.clone()
        begins[0] = True
        # Env after env, so that a stretch ends where the next one of the list begins.
        env, first = begins.t().nonzero(as_tuple=True)
        position = env * steps + first
        end = torch.cat([position[1:], position.new_tensor([steps * envs])])
        length = end - position
        length, order = torch.sort(length, descending=True, stable=True)
        self.env = env[order]
        first = first[order]
        self.continued = ~starts[first, self.env]
        step = torch.arange(int(length[0]), device=device)
        alive = step[:, None] < length[None, :]
        self.batch_sizes = alive.sum(1).cpu()
        self.rows = ((first + step[:, None]) * envs + self.env)[alive]
        self.last_of_env = torch.empty(envs, dtype=torch.long, device=device)
        ends = first + length == steps
        self.last_of_env[self.env[ends]] = ends.nonzero().squeeze(1)
