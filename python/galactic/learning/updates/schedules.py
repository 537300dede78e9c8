"""What changes in the course of a run: schedules of its settings, by the share of the run that is done, 0 to 1,
and the pace that is measured."""

from __future__ import annotations

import math

from galactic.learning.settings import Settings


def learning_rate_at(settings: Settings, progress: float) -> float:
    return _between(settings.learning_rate, settings.learning_rate_end, progress)


def entropy_at(settings: Settings, progress: float) -> float:
    end = settings.entropy if settings.entropy_end < 0.0 else settings.entropy_end
    return _between(settings.entropy, end, progress)


def teacher_weight_at(settings: Settings, progress: float) -> float:
    if progress >= settings.teacher_share:
        return 0.0
    return _between(settings.teacher_weight, 0.0, progress / settings.teacher_share)


def log_std_limit_at(settings: Settings, progress: float) -> float:
    """The most that a parameter of `log_std` may be."""
    if settings.final_log_std >= 2.0:
        return 2.0
    return _between(settings.initial_log_std, settings.final_log_std, (progress - 0.2) / 0.8)


def _between(start: float, end: float, progress: float) -> float:
    return start + (end - start) * min(max(progress, 0.0), 1.0)


class PacedRate:
    """The share of the scheduled learning rate that keeps the divergence of an update, which grows with
    the square of the rate, at `target_kl`: PPO's adaptive penalty (Schulman et al. 2017, section 4)
    with the rate in the penalty's place. Precise policies need it most: the less noise they act with,
    the further a step of the same length leads away. The divergence of an update is the mean over its
    mini-batches of what it was before each one's step: 0 before the first."""

    FIRST = 0.01
    """Adam's first steps are the longest it makes, and may lead a trained policy far away."""
    LEAST = 1e-3

    def __init__(self, target_kl: float):
        self.target_kl = target_kl
        self.share = 1.0 if target_kl == 0.0 else self.FIRST

    def follow(self, kl: float) -> None:
        """After an update of divergence `kl`. Falls at once, rises slowly."""
        if self.target_kl == 0.0 or not math.isfinite(kl):
            return
        wanted = math.sqrt(self.target_kl / max(kl, 1e-12))
        self.share = min(max(self.share * min(max(wanted, 0.5), 1.2), self.LEAST), 1.0)
