"""Modules without their numbers, for those who will fill them with what a file holds."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import Any

import torch
from torch import nn
from torch.overrides import TorchFunctionMode

_MAKERS = (torch.empty, torch.full, torch.ones, torch.zeros)


class Outlined(TorchFunctionMode):
    """While in force, modules are made of tensors that have shapes and no memory (torch's device `meta`), whatever
    their size: nothing is initialized, and no random number is drawn. Tensors that are made of numbers are
    what they always are. Torch 2 has a context for its devices; 1.13 has none."""

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
    """Gives outlined tensors of a module memory on the processor, which is not initialized."""
    module._apply(lambda one: torch.empty_like(one, device="cpu") if one.is_meta else one)
