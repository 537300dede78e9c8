"""cmake --install puts the package where an interpreter of the prefix finds it."""

import os
import subprocess
import sys


def test_below_the_prefix(tmp_path, world_path):
    build = os.environ["GALACTIC_BUILD_DIR"]
    command = ["cmake", "--install", build, "--component", "python", "--prefix", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (package,) = tmp_path.rglob("galactic/__init__.py")
    assert package.relative_to(tmp_path).parts[0] == "lib"
    program = "import galactic, sys; print(galactic.__file__, galactic.World(sys.argv[1]))"
    done = subprocess.run(
        [sys.executable, "-B", "-c", program, world_path],
        env={**os.environ, "PYTHONPATH": str(package.parent.parent)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(package))
