"""The build folder, installed below a prefix of its own: what the tests of this folder begin with."""

from __future__ import annotations

import argparse
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
OPTIONS = argparse.Namespace()


def run(*command: object, **more: object) -> str:
    done = subprocess.run([str(one) for one in command], capture_output=True, text=True, **more)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


class Installed(unittest.TestCase):
    COMPONENTS: tuple[str, ...]

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.prefix = pathlib.Path(cls.folder.name, "prefix")
        for component in cls.COMPONENTS:
            run(
                OPTIONS.cmake,
                "--install",
                OPTIONS.build,
                "--prefix",
                cls.prefix,
                "--component",
                component,
            )

    @classmethod
    def tearDownClass(cls) -> None:
        cls.folder.cleanup()


def main() -> None:
    parser = argparse.ArgumentParser()
    for name in ("--cmake", "--cpack", "--compiler"):
        parser.add_argument(name, required=True)
    for name in ("--build", "--source", "--packs"):
        parser.add_argument(name, type=pathlib.Path, required=True)
    _, rest = parser.parse_known_args(namespace=OPTIONS)
    unittest.main(module="__main__", argv=[sys.argv[0], *rest], verbosity=2)
