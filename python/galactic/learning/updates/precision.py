"""Precision of arithmetic on GPUs: float32, TF32 or bfloat16."""

from __future__ import annotations

import contextlib

import torch


class Precision:
    """How networks are computed. `fp32`: in float32. `tf32`: multiplications with 10 bits of
    mantissa. `bf16`: if the network `sees_images`, the layers before the memory are computed in
    bfloat16, except FullLinear layers; those and the memory (multiplied as with `tf32`), losses and
    parameters stay in float32. On processors, everything is fp32."""

    def __init__(self, name: str, device: torch.device, *, sees_images: bool = True):
        self.tunes = device.type == "cuda"
        """Whether cuDNN times its convolutions anew for each shape of their inputs: see
        cudnn.benchmark."""
        self._bf16 = name == "bf16" and device.type == "cuda" and sees_images
        if device.type == "cuda":
            quick = name in ("tf32", "bf16")
            torch.backends.cuda.matmul.allow_tf32 = quick
            torch.backends.cudnn.allow_tf32 = quick
            torch.backends.cudnn.benchmark = self.tunes

    def autocast(self) -> contextlib.AbstractContextManager[None]:
        """The context for every use of a policy."""
        if self._bf16:
            return torch.autocast("cuda", dtype=torch.bfloat16)
        return contextlib.nullcontext()
