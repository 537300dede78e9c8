"""The examples of README.md and docs/python.md run."""

import os
import pathlib
import re
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(os.environ["GALACTIC_SOURCE_DIR"])


def test_random_homes(world_path, tmp_path):
    script = ROOT / "python" / "examples" / "random_homes.py"
    done = subprocess.run(
        [sys.executable, "-B", script, world_path], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert "(100, 23) (100, 128, 128, 3)" in done.stdout.splitlines()[-1]
    assert np.load(tmp_path / "seen.npy").shape == (128, 512, 3)


def test_the_lines_of_the_readme(world_path):
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert blocks
    for block in blocks:
        done = subprocess.run(
            [sys.executable, "-B", "-c", block],
            cwd=world_path.parent,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        assert "'rgb': (256, 128, 128, 3)" in done.stdout
