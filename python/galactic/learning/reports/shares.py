"""Shares of episodes, with confidence intervals."""

from __future__ import annotations

import math

NORMAL_QUANTILE = 1.959963984540054
"""The 97.5 % quantile of the normal distribution, for intervals of 95 %."""


def interval(share: float, count: float) -> tuple[float, float]:
    """The 95 % confidence interval of the rate behind a share of `count` independent episodes
    (Wilson 1927). From 0 to 1 if `count` is 0."""
    if count <= 0:
        return 0.0, 1.0
    square = NORMAL_QUANTILE**2
    middle = share + square / (2.0 * count)
    reach = NORMAL_QUANTILE * math.sqrt(
        share * (1.0 - share) / count + square / (4.0 * count * count)
    )
    scale = 1.0 + square / count
    return max(0.0, (middle - reach) / scale), min(1.0, (middle + reach) / scale)


def percent(share: float, count: float) -> str:
    """0.945 of 400 as 94.5 % (91.8 to 96.3)."""
    low, high = interval(share, count)
    return f"{100.0 * share:.1f} % ({100.0 * low:.1f} to {100.0 * high:.1f})"


def percent_of(share: float, count: float) -> str:
    """0.945 of 400 as 94.5 % (91.8 to 96.3) of 400 episodes."""
    return f"{percent(share, count)} of {count:.0f} episode{'' if count == 1 else 's'}"
