"""Builds wheels of the package with CMake: the build backend of pyproject.toml (PEP 517, PEP 660).

It needs nothing but Python, CMake and what the project needs, so that `pip install .` works without a
network. `--config-settings cmake-args=...` adds options for CMake, `build-dir=...` keeps the build.
"""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).parents[2]
Settings = dict[str, str] | None


def get_requires_for_build_wheel(config_settings: Settings = None) -> list[str]:
    return []


get_requires_for_build_editable = get_requires_for_build_sdist = get_requires_for_build_wheel


def build_wheel(
    wheel_directory: str,
    config_settings: Settings = None,
    metadata_directory: str | None = None,
) -> str:
    with tempfile.TemporaryDirectory() as folder:
        stage = pathlib.Path(folder, "stage")
        build = _build_folder(config_settings, pathlib.Path(folder, "build"))
        _build(build, config_settings, stage)
        _run("cmake", "--install", build, "--component", "python")
        files = {
            path.relative_to(stage).as_posix(): path.read_bytes()
            for path in sorted(stage.rglob("*"))
            if path.is_file()
        }
    return _write_wheel(wheel_directory, files)


def build_editable(
    wheel_directory: str,
    config_settings: Settings = None,
    metadata_directory: str | None = None,
) -> str:
    """A wheel that leads to the build tree, whose Python files are links to the sources."""
    build = _build_folder(config_settings, ROOT / "build" / "editable")
    _build(build, config_settings, None)
    return _write_wheel(wheel_directory, {"galactic.pth": f"{build / 'python'}\n".encode()})


def build_sdist(sdist_directory: str, config_settings: Settings = None) -> str:
    """The files that git tracks."""
    stem = f"galactic-{_version()}"
    names = _run("git", "-C", ROOT, "ls-files", "-z", capture=True).split("\0")
    path = pathlib.Path(sdist_directory, f"{stem}.tar.gz")
    with tarfile.open(path, "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for name in filter(None, names):
            archive.add(ROOT / name, f"{stem}/{name}", recursive=False)
        text = _metadata().encode()
        entry = tarfile.TarInfo(f"{stem}/PKG-INFO")
        entry.size = len(text)
        archive.addfile(entry, io.BytesIO(text))
    return path.name


def _build_folder(settings: Settings, default: pathlib.Path) -> pathlib.Path:
    return pathlib.Path((settings or {}).get("build-dir", default)).resolve()


def _build(build: pathlib.Path, settings: Settings, stage: pathlib.Path | None) -> None:
    options = {
        "CMAKE_BUILD_TYPE": "Release",
        # Three times as fast from nothing.
        "CMAKE_UNITY_BUILD": "ON",
        "GALACTIC_BUILD_PYTHON": "ON",
        "GALACTIC_BUILD_BAKE": "OFF",
        "GALACTIC_BUILD_TESTS": "OFF",
        "GALACTIC_BUILD_BENCHMARKS": "OFF",
        "GALACTIC_PYTHON": sys.executable,
    }
    if stage is not None:
        options["GALACTIC_PYTHON_FOLDER"] = str(stage)
    defined = [f"-D{name}={value}" for name, value in options.items()]
    more = shlex.split((settings or {}).get("cmake-args", ""))
    _run("cmake", "-S", ROOT, "-B", build, *defined, *more)
    jobs = str(len(os.sched_getaffinity(0)))
    _run("cmake", "--build", build, "--target", "galactic_python", "--parallel", jobs)


def _run(*command: str | pathlib.Path, capture: bool = False) -> str:
    output = subprocess.PIPE if capture else None
    done = subprocess.run([str(part) for part in command], check=True, stdout=output, text=True)
    return done.stdout or ""


def _project() -> dict:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def _version() -> str:
    """That of the project, which a header says."""
    text = (ROOT / "runtime/include/galactic/version.h").read_text(encoding="utf-8")
    numbers = re.findall(r"#define GALACTIC_VERSION_\w+ (\d+)", text)
    assert len(numbers) == 3, "version.h names no version"
    return ".".join(numbers)


def _metadata() -> str:
    project = _project()
    lines = [
        "Metadata-Version: 2.1",
        "Name: galactic",
        f"Version: {_version()}",
        f"Summary: {project['description']}",
        f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {name}" for name in project["dependencies"]),
    ]
    for extra, names in project["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {name}; extra == "{extra}"' for name in names]
    lines.append("Description-Content-Type: text/markdown")
    return "\n".join(lines) + "\n\n" + (ROOT / "README.md").read_text(encoding="utf-8")


def _tag() -> str:
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"{python}-{python}-{platform}"


def _write_wheel(folder: str, files: dict[str, bytes]) -> str:
    stem = f"galactic-{_version()}"
    information = f"{stem}.dist-info"
    wheel = "\n".join(
        ["Wheel-Version: 1.0", "Generator: galactic_build", "Root-Is-Purelib: false"]
        + [f"Tag: {_tag()}", ""]
    )
    files = {
        **files,
        f"{information}/METADATA": _metadata().encode(),
        f"{information}/WHEEL": wheel.encode(),
    }
    record = io.StringIO()
    rows = csv.writer(record, lineterminator="\n")
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        rows.writerow([name, f"sha256={digest}", len(content)])
    rows.writerow([f"{information}/RECORD", "", ""])
    path = pathlib.Path(folder, f"{stem}-{_tag()}.whl")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
        archive.writestr(f"{information}/RECORD", record.getvalue())
    return path.name
