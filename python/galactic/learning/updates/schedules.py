"""What changes in the course of a run: settings that are scheduled by the share of the run that is
done, 0 to 1, and the learning rate that is paced by measurement."""

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
    """The upper limit of the parameters of `log_std`."""
    if settings.final_log_std >= 2.0:
        return 2.0
    return _between(settings.initial_log_std, settings.final_log_std, (progress - 0.2) / 0.8)


def _between(start: float, end: float, progress: float) -> float:
    return start + (end - start) * min(max(progress, 0.0), 1.0)


class PacedRate:
    """Adapts the share of the scheduled learning rate to keep the divergence of an update, which
    grows with the square of the rate, at `target_kl`. This is PPO's adaptive penalty (Schulman et
    al. 2017, section 4), with the rate in place of the penalty. Precise policies need it most: the
    less noise they act with, the more a step of the same length changes them. The divergence of an
    update is measured before the step of each mini-batch (0 before the first), and averaged."""

    FIRST = 0.01
    """The share at the start: Adam's first steps are its longest, and may ruin a trained policy."""
    LEAST = 1e-3

    def __init__(self, target_kl: float):
        self.target_kl = target_kl
        self.share = 1.0 if target_kl == 0.0 else self.FIRST

    def follow(self, kl: float) -> None:
        """Adapts the share after an update of divergence `kl`. It falls quickly and rises
        slowly."""
        if self.target_kl == 0.0 or not math.isfinite(kl):
            return
        wanted = math.sqrt(self.target_kl / max(kl, 1e-12))
        self.share = min(max(self.share * min(max(wanted, 0.5), 1.2), self.LEAST), 1.0)
