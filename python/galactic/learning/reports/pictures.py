"""Pictures of a policy at play, from behind the robot: a contact sheet, and a video.

An evaluation plays too many episodes to draw them all, so a few of them are played again, with a camera.
"""

from __future__ import annotations

import contextlib
import dataclasses
import pathlib
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

import galactic
from galactic.files import replacing, write_atomically
from galactic.learning.homes import SUCCESS, Homes
from galactic.learning.playing.evaluation import Actor, EpisodeResult, rows_of
from galactic.learning.settings import Settings
from galactic.learning.user_code.own_tasks import MakeTask

WIDTH, HEIGHT = 256, 192
MOMENTS = 6
"""Columns of a contact sheet."""
FRAMES_PER_SECOND = 20
_LABEL_HEIGHT = 16
_GREEN, _RED = (24, 110, 52), (150, 40, 36)


@dataclass
class Film:
    """An episode as frames: the first shows its beginning, and each other one the result of a
    step."""

    episode: int
    target: str  # the name of the object that is to be moved
    frames: list[np.ndarray] = field(default_factory=list)  # each [HEIGHT, WIDTH, 3] uint8
    ending: int = 0  # an EpisodeEnd
    reward: float = 0.0  # the sum

    @property
    def label(self) -> str:
        ending = galactic.EpisodeEnd(self.ending).name.lower().replace("_", " ")
        # The name comes last, as narrow pictures cut it off.
        return f"episode {self.episode}: {ending}, {len(self.frames) - 1} steps, {self.target}"

    @property
    def color(self) -> tuple[int, int, int]:
        return _GREEN if self.ending == SUCCESS else _RED


def require_tools(video: bool) -> None:
    """Raises galactic.Error, which says what to install, if a tool for making pictures is
    missing."""
    try:
        import PIL  # noqa: F401
    except ImportError:
        raise _unsupported("Pillow", "python3-pil") from None
    if video and not shutil.which("ffmpeg"):
        raise _unsupported("ffmpeg on the PATH", "ffmpeg")


def require_png(file: pathlib.Path) -> None:
    """Raises galactic.Error if the name of a contact sheet does not end in .png."""
    if file.suffix.lower() != ".png":
        message = "pictures are PNG files; end the name with .png"
        raise galactic.Error(galactic.ErrorCode.UNSUPPORTED, str(file), message)


def require_video(file: pathlib.Path) -> None:
    """Raises galactic.Error if ffmpeg cannot write a format of this name. Tries by writing one
    frame to a temporary file with the same name."""
    with tempfile.TemporaryDirectory(prefix="galactic-video-") as folder:
        blank = Film(0, "", [np.zeros((HEIGHT, WIDTH, 3), np.uint8)])
        _require_encoded(_encode([blank], pathlib.Path(folder) / file.name), file)


def choose(results: Sequence[EpisodeResult], count: int) -> list[int]:
    """Up to `count` episodes: first successes, about half if there are enough of both, then
    failures; of each kind the first ones."""
    successes = [one.episode for one in results if one.success]
    failures = [one.episode for one in results if not one.success]
    shown = min(len(successes), max((count + 1) // 2, count - len(failures)))
    return successes[:shown] + failures[: count - shown]


def film(world: galactic.World, settings: Settings, actor: Actor, episodes: Sequence[int],
         threads: int, task: MakeTask | None = None) -> list[Film]:  # fmt: skip
    """Plays `episodes` side by side, one env for each. A policy's actions may depend on the last
    bits of sums, and so on how many envs it acts in. So an episode may end differently than in the
    evaluation; its Film has the ending."""
    envs = len(episodes)
    alone = dataclasses.replace(settings, envs=envs, halves=1, mini_batches=1)
    onlooker = {"camera": "follow", "width": WIDTH, "height": HEIGHT}
    homes = Homes(world, alone, threads, task=task, is_evaluation=True, onlooker=onlooker)
    seen = rows_of(homes)
    homes.begin_episodes(dict(enumerate(episodes)), seen)
    assert homes.shown is not None
    kinds = world.episode_table().target_kind
    films = [
        Film(episode, world.objects[kinds[episode]], [frame])
        for episode, frame in zip(episodes, homes.shown)
    ]
    actor.begin(envs)
    step = 0
    while any(not one.ending for one in films):
        at_start, steps = np.full(envs, step == 0), np.full(envs, step)
        homes.send(0, actor.act(seen, at_start, np.array(episodes), steps), seen)
        rewards, endings = homes.recv(0).rewards, homes.endings(0)
        for env, one in enumerate(films):
            if not one.ending:
                one.frames.append(homes.shown[env])
                one.ending = int(endings[env])
                one.reward += float(rewards[env])
        step += 1
    homes.close()
    return films


def write_contact_sheet(films: Sequence[Film], file: pathlib.Path) -> None:
    """A PNG with a row for each film: from its first frame to its last."""
    rows = []
    for one in films:
        moments = np.linspace(0, len(one.frames) - 1, MOMENTS).round().astype(int)
        shown = ", ".join(map(str, moments))
        label = f"{one.label}, return {one.reward:.1f}; shown after {shown}"
        rows.append(_label(label, one.color, MOMENTS * WIDTH))
        rows.append(np.concatenate([one.frames[moment] for moment in moments], axis=1))
    from PIL import Image

    sheet = Image.fromarray(np.concatenate(rows))
    write_atomically(file, lambda handle: sheet.save(handle, format="PNG"))


def write_video(films: Sequence[Film], file: pathlib.Path) -> None:
    """Writes all films side by side, each until its end, in the format that the file's name
    implies. An existing file is replaced only by a complete video."""
    with replacing(file) as place:
        _require_encoded(_encode(films, place), file)


def _require_encoded(said: str | None, file: pathlib.Path) -> None:
    if said is not None:
        message = f"ffmpeg did not write it: {said}"
        raise galactic.Error(galactic.ErrorCode.IO, str(file), message)


def _encode(films: Sequence[Film], file: pathlib.Path) -> str | None:
    """Why ffmpeg did not write the video, in its words; None where it did."""
    columns = min(4, len(films))
    rows = -(-len(films) // columns)
    height = HEIGHT + _LABEL_HEIGHT
    canvas = np.zeros((rows * height, columns * WIDTH, 3), np.uint8)
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    command += ["-s", f"{columns * WIDTH}x{rows * height}", "-r", str(FRAMES_PER_SECOND), "-i", "-"]
    command += ["-pix_fmt", "yuv420p", str(file.absolute())]
    cells = []
    for number, one in enumerate(films):
        row, column = divmod(number, columns)
        cell = canvas[row * height : (row + 1) * height, column * WIDTH : (column + 1) * WIDTH]
        cell[:_LABEL_HEIGHT] = _label(one.label, one.color, WIDTH)
        cells.append(cell[_LABEL_HEIGHT:])
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdin is not None and process.stderr is not None
        with contextlib.suppress(BrokenPipeError):  # The error output below says why ffmpeg ended.
            for moment in range(max(len(one.frames) for one in films)):
                for one, cell in zip(films, cells):
                    cell[:] = one.frames[min(moment, len(one.frames) - 1)]
                process.stdin.write(canvas.tobytes())
            process.stdin.close()
        said = process.stderr.read().decode(errors="replace").strip()
    return said if process.returncode else None


def _label(text: str, color: tuple[int, int, int], width: int) -> np.ndarray:
    """A line of text on a strip, [_LABEL_HEIGHT, width, 3] uint8."""
    from PIL import Image, ImageDraw

    strip = Image.new("RGB", (width, _LABEL_HEIGHT), color)
    ImageDraw.Draw(strip).text((6, 2), text, fill=(255, 255, 255))
    return np.asarray(strip)


def _unsupported(what: str, package: str) -> galactic.Error:
    message = f"need {what}, which is not here; install it (Debian: {package})"
    return galactic.Error(galactic.ErrorCode.UNSUPPORTED, "pictures", message)
