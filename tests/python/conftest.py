"""What the tests share: the small home, and random actions in it."""

import os
import pathlib
import threading
from concurrent.futures import ThreadPoolExecutor

# As galactic.learning.ranks.launch has it in ranks, with whose runs those of this process are compared bit for bit. To be
# said before OpenBLAS is read, which comes with numpy.
_PROCESSOR = pathlib.Path("/proc/cpuinfo")
if _PROCESSOR.is_file() and " avx512vl " in _PROCESSOR.read_text(
    encoding="utf-8", errors="replace"
):
    os.environ.setdefault("OPENBLAS_CORETYPE", "SKYLAKEX")

import numpy as np  # noqa: E402
import pytest  # noqa: E402

import galactic  # noqa: E402


@pytest.fixture(scope="session")
def world_path() -> pathlib.Path:
    return pathlib.Path(os.environ["GALACTIC_TEST_WORLD"])


@pytest.fixture(scope="session")
def world(world_path: pathlib.Path) -> galactic.World:
    return galactic.World(world_path)


@pytest.fixture
def draw_actions():
    """A function that draws actions: from -1 to 1, seldom terminating."""
    generator = np.random.default_rng(20240611)

    def draw(envs: int, count: int) -> np.ndarray:
        actions = generator.uniform(-1, 1, (envs, count)).astype(np.float32)
        actions[:, -1] = np.where(generator.random(envs) < 0.01, 1, -1)
        return actions

    return draw


@pytest.fixture
def played(world: galactic.World, draw_actions) -> galactic.Simulator:
    """20 envs, after steps in which hands closed."""
    envs = 20
    simulator = galactic.Simulator(world, envs=envs, threads=1, seed=7, task="none")
    for _ in range(60):
        actions = draw_actions(envs, 8)
        actions[:, -2] = 1
        simulator.step(actions)
    return simulator


@pytest.fixture
def refused_at_once():
    """A function that calls each of `calls` so many times, each in a thread of its own, all at once;
    what the RuntimeErrors among them said."""

    def run(*calls, times: int) -> list[str]:
        begin = threading.Barrier(len(calls))
        refusals: list[str] = []

        def repeat(call) -> None:
            begin.wait()
            for _ in range(times):
                try:
                    call()
                except RuntimeError as error:
                    refusals.append(str(error))

        with ThreadPoolExecutor(len(calls)) as threads:
            for thread in [threads.submit(repeat, call) for call in calls]:
                thread.result()
        return refusals

    return run
