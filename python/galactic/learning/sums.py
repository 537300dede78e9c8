"""Named sums: over mini-batches, and over ranks in a single exchange."""

from __future__ import annotations

from collections.abc import Mapping

import torch
from torch import Tensor

from galactic.learning.ranks.distributed import Group


class Sums:
    """Adds up named numbers in double precision, on the device where they are."""

    def __init__(self) -> None:
        self._names: tuple[str, ...] = ()
        self._row: Tensor | None = None

    def add(self, numbers: Mapping[str, Tensor]) -> None:
        """Adds one number of each name."""
        names, row = tuple(numbers), torch.stack(tuple(numbers.values())).double()
        assert self._row is None or names == self._names, (names, self._names)
        self._names, self._row = names, row if self._row is None else self._row + row

    def by_name(self) -> dict[str, Tensor]:
        """The sums so far."""
        return {} if self._row is None else dict(zip(self._names, self._row))


def over_ranks(group: Group, numbers: Mapping[str, float | Tensor]) -> dict[str, float]:
    """Adds up numbers over all ranks, in double precision. Every rank must give the same names in
    the same order."""
    known = {name: float(one) for name, one in numbers.items() if not isinstance(one, Tensor)}
    found = {name: one for name, one in numbers.items() if isinstance(one, Tensor)}
    row = torch.tensor(list(known.values()), dtype=torch.float64, device=group.device)
    if found:
        row = torch.cat([row, torch.stack(tuple(found.values())).double()])
    return dict(zip((*known, *found), group.sum(row).tolist()))
