"""Which policy becomes best.pt."""

from __future__ import annotations

import dataclasses
import json
import pathlib

import pytest

from galactic.learning.policies.networks import Policy
from galactic.learning.refusals import CheckpointError
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.saving import checkpoint
from galactic.learning.saving.checkpoint import Score, load_policy
from galactic.learning.trainer import Trainer, Validation
from trainers import SETTINGS, UPDATE, make_trainer


def validation(*scores: tuple[float, float]) -> Validation:
    """Episodes of these means, one pair of them for each validation."""
    left = iter(scores)

    def validate(policy: Policy) -> EpisodeSums:
        success, mean_return = next(left)
        return EpisodeSums(10.0, 10.0 * success, 0.0, 10.0 * mean_return, 100.0)

    return validate


def make_validated(folder: pathlib.Path, *scores: tuple[float, float]) -> Trainer:
    """A run that is validated after each second update, and saved after each third."""
    settings = dataclasses.replace(SETTINGS, validate_every=2 * UPDATE)
    return make_trainer(folder, settings, validation=validation(*scores))


@pytest.mark.parametrize(
    "scores, best",
    [
        ([(0.2, 1.0), (0.9, 0.0), (0.5, 9.0), (0.1, 9.0)], 1),
        # Among as many successes the return decides: of none, as in a task that knows none, or of all.
        ([(0.0, 1.0), (0.0, 9.0), (0.0, 5.0), (0.0, 2.0)], 1),
        ([(1.0, 3.0), (1.0, 4.0), (0.9, 9.0), (1.0, 3.5)], 1),
        ([(0.0, -5.0), (0.0, -7.0), (0.0, -6.0), (0.0, -9.0)], 0),
        # The later one has learned longer.
        ([(0.5, 2.0), (0.5, 2.0), (0.4, 3.0), (0.5, 2.0)], 3),
    ],
)
def test_the_best_has_most_successes_or_the_largest_return_among_them(
    tmp_path: pathlib.Path, scores: list[tuple[float, float]], best: int
) -> None:
    trainer = make_validated(tmp_path, *scores)
    trainer.begin()
    trainer.train()
    kept = load_policy(tmp_path / "best.pt")
    assert kept.steps == 2 * UPDATE * (best + 1)
    assert (kept.success, kept.mean_return) == scores[best]
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert (report["best_success"], report["best_return"]) == scores[best]


class Killed(BaseException):
    pass


def killed_behind_its_best(folder: pathlib.Path) -> None:
    """Its latest checkpoint is of its third update, its best policy of the fourth."""
    trainer = make_validated(folder, (0.2, 1.0), (0.9, 3.0))

    def kill(moment) -> None:
        if trainer.updates == 5:
            raise Killed

    trainer.callback = kill
    trainer.begin()
    with pytest.raises(Killed):
        trainer.train()
    assert trainer.checkpoints.steps == 3 * UPDATE


def test_a_resumed_run_replaces_the_best_only_by_one_as_good(tmp_path: pathlib.Path) -> None:
    killed_behind_its_best(tmp_path)
    resumed = make_validated(tmp_path, (0.5, 3.0), (0.9, 2.0), (0.9, 3.0))
    resumed.resume()
    resumed.train(pause_at=6 * UPDATE)
    kept = load_policy(tmp_path / "best.pt")
    assert (kept.success, kept.mean_return, kept.steps) == (0.9, 3.0, 4 * UPDATE)
    resumed.train()
    assert load_policy(tmp_path / "best.pt").steps == 8 * UPDATE


def test_without_a_best_one_a_resumed_run_keeps_the_next(tmp_path: pathlib.Path) -> None:
    killed_behind_its_best(tmp_path)
    (tmp_path / "best.pt").unlink()
    resumed = make_validated(tmp_path, (0.1, 3.0), (0.0, 4.0), (0.0, 5.0))
    resumed.resume()
    resumed.train()
    assert load_policy(tmp_path / "best.pt").success == 0.1


def test_a_damaged_best_one_is_refused_with_what_to_do(tmp_path: pathlib.Path) -> None:
    killed_behind_its_best(tmp_path)
    (tmp_path / "best.pt").write_bytes(b"no policy")
    with pytest.raises(CheckpointError) as refused:
        make_validated(tmp_path).resume()
    assert str(refused.value) == (
        f"{tmp_path / 'best.pt'} cannot be read as a checkpoint: found 9 bytes of something else, or a part "
        "of one; move it away, and the run keeps the best policy from here on"
    )


@pytest.mark.parametrize(
    "score, other",
    [
        (Score(), Score(0.0, -1e9)),
        (Score(0.5), Score(0.5, -1e9)),
        (Score(0.4, 9.0), Score(0.5)),
        (Score(0.5, 1.0), Score(0.5, 2.0)),
    ],
)
def test_what_is_not_known_is_below_what_is(score: Score, other: Score) -> None:
    assert score.is_below(other) and not other.is_below(score)
    assert not score.is_below(score) and not other.is_below(other)
