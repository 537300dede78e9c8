"""Adam on all parameters of a policy at once."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from galactic.learning.saving.checkpoint import require_tensors


class FlatAdam:
    """Adam (Kingma and Ba 2015) with the norm of the gradient clipped.

    The parameters of the policy become views of one flat tensor, and their gradients views of
    another. So there is one sum over ranks, one norm and one step, instead of one per layer, which
    would take most of the time of a small network. The policy must stay on its device.
    """

    def __init__(self, policy: nn.Module, learning_rate: float, epsilon: float):
        views = list(policy.parameters())
        size = sum(view.numel() for view in views)
        device = views[0].device
        self.parameters = nn.Parameter(torch.empty(size, device=device))
        self.gradients = torch.zeros(size, device=device)
        self.parameters.grad = self.gradients
        first = 0
        for view in views:
            # Keep the order of axes in memory, so that channels_last weights remain so. Do not keep
            # gaps between elements, as in slices of other tensors: the next parameter would lie in
            # them.
            strides = torch.empty_like(view, memory_format=torch.preserve_format).stride()
            place = (view.shape, strides, first)
            flat = self.parameters.data.as_strided(*place)
            flat.copy_(view.data)
            view.data = flat
            view.grad = self.gradients.as_strided(*place)
            first += view.numel()
        self._adam = torch.optim.Adam([self.parameters], learning_rate, eps=epsilon)

    @property
    def learning_rate(self) -> float:
        return self._adam.param_groups[0]["lr"]

    @learning_rate.setter
    def learning_rate(self, rate: float) -> None:
        self._adam.param_groups[0]["lr"] = rate

    def clear(self) -> None:
        """Sets all gradients to zero, in place."""
        self.gradients.zero_()

    def step(self, most_norm: float) -> Tensor:
        """One step. The norm of the gradient is clipped to `most_norm`, unless that is 0. Returns
        the norm before clipping."""
        norm = torch.linalg.vector_norm(self.gradients)
        if most_norm > 0.0:
            self.gradients.mul_(torch.clamp(most_norm / (norm + 1e-6), max=1.0))
        self._adam.step()
        return norm

    def state_dict(self) -> dict[str, Tensor]:
        """Moments and step count; the parameters are saved with the policy."""
        return dict(self._adam.state[self.parameters])

    def load_state_dict(self, state: dict[str, Tensor]) -> None:
        """Raises ValueError unless `state` is that of an optimizer of as many parameters after at
        least one step."""
        moments = dict.fromkeys(("exp_avg", "exp_avg_sq"), self.parameters)
        require_tensors(state, {"step": torch.tensor(0.0), **moments})
        own = self._adam.state[self.parameters]
        for name, value in state.items():
            own[name] = value.to(self.parameters.device) if value.dim() else value.clone()
