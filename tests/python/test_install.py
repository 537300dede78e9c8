"""cmake --install puts the package where an interpreter of the prefix finds it."""

import os
import pathlib
import subprocess
import sys


def test_below_the_prefix(tmp_path, world_path):
    build = os.environ["GALACTIC_BUILD_DIR"]
    command = ["cmake", "--install", build, "--component", "python", "--prefix", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (package,) = tmp_path.rglob("galactic/__init__.py")
    assert package.relative_to(tmp_path).parts[0] == "lib"
    assert (package.parent / "LICENSE").read_text().startswith("MIT License")
    program = "import galactic, sys; print(galactic.__file__, galactic.World(sys.argv[1]))"
    done = subprocess.run(
        [sys.executable, "-B", "-c", program, world_path],
        env={**os.environ, "PYTHONPATH": str(package.parent.parent)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(package))


def test_a_package_that_is_not_built_says_what_to_build(tmp_path):
    """As CMake leaves it before the target is built."""
    sources = pathlib.Path(os.environ["GALACTIC_SOURCE_DIR"]) / "python" / "galactic"
    (tmp_path / "galactic").symlink_to(sources)
    command = [sys.executable, "-B", "-c", "import galactic"]
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True)
    version = "{}.{}".format(*sys.version_info)
    assert done.stderr.splitlines()[-1] == (
        f"ModuleNotFoundError: galactic has no compiled module for Python {version}; build it: "
        "cmake --build --preset release --target galactic_python (docs/python.md)"
    )
