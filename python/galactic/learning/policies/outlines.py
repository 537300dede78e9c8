"""Modules without memory for their tensors, to be filled from a file later."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import Any

import torch
from torch import nn
from torch.overrides import TorchFunctionMode

_MAKERS = (torch.empty, torch.full, torch.ones, torch.zeros)


class Outlined(TorchFunctionMode):
    """Within this context, modules get tensors that have shapes but no memory (torch's device
    `meta`): nothing is initialized, and no random numbers are drawn. Tensors made from given
    numbers are not affected. Torch 2 has such a context for devices; torch 1.13 has not."""

    def __torch_function__(
        self,
        func: Callable[..., Any],
        types: Collection[type],
        args: tuple[Any, ...] = (),
        kwargs: Mapping[str, Any] | None = None,
    ) -> Any:
        given = dict(kwargs or {})
        if func in _MAKERS and given.get("device") is None:
            given["device"] = "meta"
        return func(*args, **given)


def give_memory(module: nn.Module) -> None:
    """Gives the outlined tensors of a module uninitialized memory on the processor."""
    module._apply(lambda one: torch.empty_like(one, device="cpu") if one.is_meta else one)
