"""The spaces of observations and actions: Gymnasium's if it is installed, otherwise minimal
replacements under the same names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

try:
    from gymnasium.spaces import Box, Dict, MultiDiscrete, Space
    from gymnasium.vector.utils import batch_space
except ImportError:

    class Space:  # type: ignore[no-redef]
        """A set of values, from which samples can be drawn, and which can be asked whether it
        contains a value."""

        def __init__(self, shape: tuple[int, ...] | None, dtype: Any = None) -> None:
            self.shape = shape
            self.dtype = None if dtype is None else np.dtype(dtype)
            self._np_random: np.random.Generator | None = None

        @property
        def np_random(self) -> np.random.Generator:
            if self._np_random is None:
                self._np_random = np.random.default_rng()
            return self._np_random

        def seed(self, seed: int | None = None) -> None:
            self._np_random = np.random.default_rng(seed)

        def sample(self) -> Any:
            raise NotImplementedError

        def contains(self, value: Any) -> bool:
            raise NotImplementedError

        def __contains__(self, value: Any) -> bool:
            return self.contains(value)

    class Box(Space):  # type: ignore[no-redef]
        """Arrays with all elements between `low` and `high`, both included."""

        def __init__(
            self, low: Any, high: Any, shape: Sequence[int] | None = None, dtype: Any = np.float32
        ) -> None:
            if shape is None:
                shape = np.shape(low)
            super().__init__(tuple(shape), dtype)
            self.low = np.broadcast_to(np.asarray(low, self.dtype), self.shape)
            self.high = np.broadcast_to(np.asarray(high, self.dtype), self.shape)

        def sample(self) -> np.ndarray:
            if np.issubdtype(self.dtype, np.integer):
                low, high = self.low.astype(np.int64), self.high.astype(np.int64)
                return self.np_random.integers(low, high, endpoint=True).astype(self.dtype)
            bounded = np.isfinite(self.low) & np.isfinite(self.high)
            uniform = self.np_random.uniform(
                np.where(bounded, self.low, 0), np.where(bounded, self.high, 1)
            )
            values = np.where(bounded, uniform, self.np_random.normal(size=self.shape))
            return np.clip(values, self.low, self.high).astype(self.dtype)

        def contains(self, value: Any) -> bool:
            return (
                isinstance(value, np.ndarray)
                and np.can_cast(value.dtype, self.dtype)
                and value.shape == self.shape
                and bool(np.all(value >= self.low) and np.all(value <= self.high))
            )

        def __eq__(self, other: object) -> bool:
            return (
                isinstance(other, Box)
                and (self.shape, self.dtype) == (other.shape, other.dtype)
                and np.array_equal(self.low, other.low)
                and np.array_equal(self.high, other.high)
            )

        def __repr__(self) -> str:
            return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"

    class MultiDiscrete(Space):  # type: ignore[no-redef]
        """Arrays of whole numbers, each from 0 up to, but not including, its entry in `nvec`."""

        def __init__(self, nvec: Any, dtype: Any = np.int64) -> None:
            self.nvec = np.asarray(nvec, dtype)
            super().__init__(self.nvec.shape, dtype)

        def sample(self) -> np.ndarray:
            return self.np_random.integers(0, self.nvec).astype(self.dtype)

        def contains(self, value: Any) -> bool:
            return (
                isinstance(value, np.ndarray)
                and np.issubdtype(value.dtype, np.integer)
                and value.shape == self.shape
                and bool(np.all(value >= 0) and np.all(value < self.nvec))
            )

        def __eq__(self, other: object) -> bool:
            return (
                isinstance(other, MultiDiscrete)
                and self.dtype == other.dtype
                and np.array_equal(self.nvec, other.nvec)
            )

        def __repr__(self) -> str:
            return f"MultiDiscrete({self.nvec.tolist()})"

    class Dict(Space):  # type: ignore[no-redef]
        """Dictionaries that have, under each name, a value of that name's space."""

        def __init__(self, spaces: Mapping[str, Space]) -> None:
            super().__init__(None)
            self.spaces = dict(spaces)

        def seed(self, seed: int | None = None) -> None:
            for number, space in enumerate(self.spaces.values()):
                space.seed(None if seed is None else seed + number)

        def sample(self) -> dict[str, Any]:
            return {name: space.sample() for name, space in self.spaces.items()}

        def contains(self, value: Any) -> bool:
            return (
                isinstance(value, Mapping)
                and value.keys() == self.spaces.keys()
                and all(space.contains(value[name]) for name, space in self.spaces.items())
            )

        def __getitem__(self, name: str) -> Space:
            return self.spaces[name]

        def __iter__(self) -> Any:
            return iter(self.spaces)

        def __len__(self) -> int:
            return len(self.spaces)

        def keys(self) -> Any:
            return self.spaces.keys()

        def items(self) -> Any:
            return self.spaces.items()

        def __eq__(self, other: object) -> bool:
            return isinstance(other, Dict) and self.spaces == other.spaces

        def __repr__(self) -> str:
            return f"Dict({self.spaces})"

    def batch_space(space: Space, n: int = 1) -> Space:
        """The space of `n` stacked values of `space`."""
        if isinstance(space, Dict):
            return Dict({name: batch_space(one, n) for name, one in space.spaces.items()})
        if isinstance(space, Box):
            return Box(
                np.broadcast_to(space.low, (n, *space.low.shape)),
                np.broadcast_to(space.high, (n, *space.high.shape)),
                dtype=space.dtype,
            )
        if isinstance(space, MultiDiscrete):
            return MultiDiscrete(np.broadcast_to(space.nvec, (n, *space.nvec.shape)))
        raise TypeError(f"cannot batch the space {space}")


__all__ = ["Box", "Dict", "MultiDiscrete", "Space", "batch_space"]
