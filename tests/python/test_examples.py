"""The examples of README.md, docs/python.md and examples/python run; learning/test_learning_examples.py has those that learn."""

import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

ROOT = pathlib.Path(os.environ["GALACTIC_SOURCE_DIR"])


def test_random_homes(world_path, tmp_path):
    printed = output_of("random_homes.py", world_path, folder=tmp_path)
    assert "(100, 23) (100, 128, 128, 3)" in printed.splitlines()[-1]
    assert np.load(tmp_path / "seen.npy").shape == (128, 512, 3)


def output_of(name, *arguments, folder=None):
    script = ROOT / "examples" / "python" / name
    done = subprocess.run(
        [sys.executable, "-B", script, *arguments], cwd=folder, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_evaluate_policy(world_path):
    """Of the four episodes, the robot cannot start in one."""
    printed = output_of("evaluate_policy.py", world_path)
    counts = [int(number) for number in re.findall(r": (\d) of 3 episodes", printed)]
    assert sum(counts) == 3
    assert "solved: [0, 3]" in printed


def test_own_task(world_path):
    printed = output_of("own_task.py", world_path)
    steps = [int(step) for step in re.findall(r"step (\d+): ", printed)]
    assert min(steps) < 200 <= max(steps)
    # With 32 envs and 100 steps at most, and no more meters than the home has.
    episodes, paid = re.search(r"(\d+) episodes, which paid (\S+) m", printed).groups()
    assert int(episodes) >= 32 * 4 and -3 < float(paid) < 3


def test_find_target(world_path):
    """In a small home, targets are in view, at some distance."""
    printed = output_of("find_target.py", world_path)
    found, ended = re.search(r"found (\d+) of (\d+) targets", printed).groups()
    assert int(ended) > 200 and int(found) == int(ended)
    assert 0.2 < float(re.search(r"at most (\S+) % of an image", printed).group(1)) < 20


def test_point_nav(world_path):
    """In a small home, most goals are straight ahead."""
    arrived, ended = re.search(
        r"straight ahead, (\d+) of (\d+) robots", output_of("point_nav.py", world_path)
    ).groups()
    assert 0.6 * int(ended) < int(arrived) < int(ended)


def test_draw_data_set(world_path, tmp_path):
    printed = output_of("draw_data_set.py", world_path, folder=tmp_path)
    images, with_target = map(int, re.findall(r"\d+", printed.splitlines()[0]))
    assert images == 640 and with_target > 500
    # The points of a target are within it.
    assert 0 < float(re.findall(r"at most (\S+) m", printed)[0]) < 0.15
    with np.load(tmp_path / "images.npz") as data:
        shapes = {name: array.shape[1:] for name, array in data.items()}
    assert shapes == {
        "rgb": (72, 96, 3),
        "depth": (72, 96),
        "is_target": (72, 96),
        "target_box": (4,),
        "world_from_camera": (4, 4),
        "intrinsics": (3, 3),
    }


def test_cameras(world_path, tmp_path):
    image = pytest.importorskip("PIL.Image")
    printed = output_of("cameras.py", world_path, tmp_path / "cameras.png")
    assert "head_depth: float32 (64, 120, 160)\n" in printed
    assert re.search(r"5120 images in \S+ s, steps included: \S+ a second\n", printed)
    with image.open(tmp_path / "cameras.png") as sheet:
        pixels = np.asarray(sheet)
    assert f"{pixels.shape[1]} x {pixels.shape[0]} pixels" in printed
    seen, far, behind = np.split(pixels, 3)
    # Only depth is gray.
    assert (far == far[..., :1]).all()
    assert not (seen == seen[..., :1]).all() and not (behind == behind[..., :1]).all()


def test_mppi(world_path):
    """Of the four episodes, the robot cannot start in one."""
    printed = output_of("mppi.py", world_path, "--plans", "64")
    assert re.findall(r"episode (\d): SUCCESS after \d+ steps\n", printed) == ["0", "1", "3"]
    assert re.search(r"solved 3, [\d,]+ planned steps a second\n", printed)


def test_optimize_motion(world_path):
    """Bent, all paths are free, and keep farther away where there was too little room."""
    printed = output_of("optimize_motion.py", world_path)
    number = r"([+-]?[\d.]+)"
    verdict = rf"{number}% free, {number} m clear, {number} on average"
    paths = re.findall(rf"path \d: \d+ waypoints, {verdict}; bent: {verdict}\n", printed)
    assert len(paths) == 5
    before, after = np.split(np.array(paths, float), 2, axis=1)
    assert (before[:, 0] < 100).any() and (after[:, 0] == 100).all()
    assert (after[:, 1] >= before[:, 1]).all() and (after[:, 1] > 0.02).all()
    assert (after[:, 2] > before[:, 2] + 0.01).all()


def test_ray_casts(world_path, tmp_path):
    """The home is 3 m wide, and the robot, the table and what stands on it can be seen from above."""
    image = pytest.importorskip("PIL.Image")
    printed = output_of("ray_casts.py", world_path, tmp_path / "rays.png")
    from_above, lidar = re.findall(r"(\d+) rays, \S+ a second: (.*)\n", printed)
    counts = dict(one.split() for one in from_above[1].split(", "))
    assert {"SCENE", "OBJECT", "ROBOT"} <= set(counts)
    assert sum(map(int, counts.values())) == int(from_above[0])
    assert int(lidar[0]) == 32 * 720 and "ROBOT" not in lidar[1]
    assert 0 < float(re.search(r"is (\S+) m from the lidar", printed)[1]) < 3
    with image.open(tmp_path / "rays.png") as picture:
        colors = {color for _, color in picture.getcolors(1 << 20)}
    assert {(60, 140, 250), (250, 140, 40), (240, 210, 60)} <= colors


def test_type_checkers_accept_the_examples(tmp_path):
    """What users write after them, theirs accept, too: galactic has types (py.typed)."""
    pytest.importorskip("mypy")
    (tmp_path / "readme.py").write_text("\n".join(readme_blocks()), encoding="utf-8")
    examples = sorted((ROOT / "examples" / "python").glob("*.py"))
    # Ours are what is tested: those of torch take a minute to read.
    config = tmp_path / "pyproject.toml"
    without_torch = '[[tool.mypy.overrides]]\nmodule = ["torch.*"]\nfollow_imports = "skip"\n'
    config.write_text((ROOT / "pyproject.toml").read_text(encoding="utf-8") + without_torch)
    options = ["--config-file", config, "--check-untyped-defs", "--cache-dir", tmp_path / "cache"]
    done = subprocess.run(
        [sys.executable, "-B", "-m", "mypy", *options, tmp_path / "readme.py", *examples],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def readme_blocks():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert blocks
    return blocks


def test_the_lines_of_the_readme(world_path):
    for block in readme_blocks():
        done = subprocess.run(
            [sys.executable, "-B", "-c", block],
            cwd=world_path.parent,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        assert "'rgb': (256, 128, 128, 3)" in done.stdout
