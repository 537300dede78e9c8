#!/usr/bin/env python3
"""Bakes, checks, simulates and draws every asset below a folder, and tells what warned and what failed.

    scripts/try_assets.py ASSETS [-o FOLDER] [--jobs N] [--only TEXT]

A style check of the tools on whatever lies there: nothing is known of a file but its name. Scenes get
objects, a robot and episodes of the sample world, objects and robots a place in the sample apartment. Each
tool runs as a user would type it, with its defaults. Everything goes into FOLDER: packs, logs, pictures and
index.html, a page with the table and the pictures. The assets themselves are only read.

A tool may refuse an asset, in one line that says why: what nobody can read, or what has no place anywhere.
The exit code is 1 when anything else went wrong: another end of galactic-bake, or something that was baked and
is refused, cannot be simulated or not drawn.
"""

import argparse
import concurrent.futures
import dataclasses
import fnmatch
import html
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator, Sequence

ROOT = pathlib.Path(__file__).resolve().parent.parent
SAMPLE = ROOT / "packs/sample"
DATASET_SUFFIX = ".scene_dataset_config.json"
EPISODE_SUFFIX = ".episode_set.json"
MESH_SUFFIXES = {".glb", ".gltf", ".obj", ".ply", ".stl", ".dae", ".fbx", ".off", ".usd", ".usda", ".usdc", ".usdz"}
# What people know of folders, and files do not say.
KNOWN = {"ycb/*": ["--up", "z"], "gso/*": ["--up", "z"]}
# A mesh whose path has one of these words is a scene, any other is an object.
SCENE_WORDS = ("scene", "stage", "room", "house")
REFUSED = (3, 5)
# Processor time, so that what passes on an idle machine passes on a busy one; and when to give up waiting.
PROCESSOR_SECONDS = 900
WAITING_SECONDS = 4 * PROCESSOR_SECONDS


@dataclasses.dataclass
class Asset:
    kind: str  # scene, object, robot, episodes or dataset
    source: pathlib.Path | None  # None: of a dataset
    name: str
    pack: pathlib.Path
    options: list[str] = dataclasses.field(default_factory=list)
    # Texture packs that it shares with others.
    textures: list[pathlib.Path] = dataclasses.field(default_factory=list)


@dataclasses.dataclass
class Verdict:
    asset: Asset
    bake: str = ""
    check: str = "-"
    simulate: str = "-"
    draw: str = "-"
    seconds: float = 0.0
    warnings: list[str] = dataclasses.field(default_factory=list)
    # Why something is not as it should be.
    faults: list[str] = dataclasses.field(default_factory=list)
    refusal: str = ""
    pictures: list[pathlib.Path] = dataclasses.field(default_factory=list)


class Tools:
    """The programs, and where they leave what they say."""

    def __init__(self, bin_folder: pathlib.Path, out: pathlib.Path):
        self.bin = bin_folder
        self.out = out

    def run(self, log: pathlib.Path, *command: object) -> tuple[int, str]:
        """The exit code, negative for a signal, and the last line of the errors."""
        words = [str(self.bin / str(command[0])), *map(str, command[1:])]
        limited = ["prlimit", f"--cpu={PROCESSOR_SECONDS}", *words]
        log.parent.mkdir(parents=True, exist_ok=True)
        try:
            done = subprocess.run(limited, capture_output=True, text=True, errors="replace", timeout=WAITING_SECONDS)
            code, out, err = done.returncode, done.stdout, done.stderr
            if code in (-signal.SIGXCPU, -signal.SIGKILL):
                err += f"\nstopped by {signal.Signals(-code).name}, after {PROCESSOR_SECONDS} s of processor time\n"
        except subprocess.TimeoutExpired:
            code, out, err = -1, "", f"did not end within {WAITING_SECONDS} s"
        with log.open("a") as file:
            file.write("$ " + " ".join(words) + f"\n{out}{err}[{code}]\n")
        lines = err.strip().splitlines()
        return code, lines[-1] if lines else ""


def below(path: pathlib.Path, folders: list[pathlib.Path]) -> bool:
    return any(folder in path.parents for folder in folders)


def name_of(path: pathlib.Path, assets: pathlib.Path) -> str:
    """Short, and different for all: the path without what is the same for its kind."""
    parts = list(path.relative_to(assets).parts)
    for suffix in (DATASET_SUFFIX, EPISODE_SUFFIX, path.suffix):
        if parts[-1].endswith(suffix):
            parts[-1] = parts[-1][: -len(suffix)]
            break
    generic = {"textured", "model", "mesh", "meshes", "models", "urdf", "robots"}
    kept = [part for part in parts if part not in generic]
    return re.sub(r"[^A-Za-z0-9_.+-]", "_", ".".join(kept or parts)) + (
        f"_{path.suffix[1:].lower()}" if path.suffix.lower() in MESH_SUFFIXES else ""
    )


def package_of(robot: pathlib.Path) -> pathlib.Path:
    return robot.parent.parent if robot.parent.name in ("urdf", "robots") else robot.parent


def is_robot(path: pathlib.Path) -> bool:
    """A URDF, or an MJCF among other XML."""
    if path.suffix in (".xml", ".mjcf"):
        return re.search(r"<mujoco[\s>]", path.read_text(errors="replace")) is not None
    return path.suffix == ".urdf"


def recipe_of(robot: pathlib.Path) -> pathlib.Path | None:
    """The recipe of the project whose robot has the name of this one."""
    found = re.search(r"<(?:robot|mujoco)[^>]*\b(?:name|model)\s*=\s*[\"']([^\"']*)", robot.read_text(errors="replace"))
    for recipe in sorted((ROOT / "packs/robots").glob("*.toml")):
        if found and tomllib.loads(recipe.read_text()).get("name") == found.group(1):
            return recipe
    return None


def find_assets(assets: pathlib.Path, out: pathlib.Path) -> Iterator[Asset]:
    files = sorted(path for path in assets.rglob("*") if path.is_file())

    def asset(kind: str, path: pathlib.Path, options: list[str]) -> Asset:
        name = name_of(path, assets)
        return Asset(kind, path, name, out / f"{kind}s" / f"{name}.pack", options)

    datasets = [path for path in files if path.name.endswith(DATASET_SUFFIX)]
    yield from (asset("dataset", path, []) for path in datasets)
    folders = [path.parent for path in datasets]
    robots = [path for path in files if is_robot(path) and not below(path, folders)]
    for path in robots:
        recipe = recipe_of(path)
        yield asset("robot", path, ["--allow-missing", *(["--recipe", str(recipe)] if recipe else [])])
    folders += [package_of(path) for path in robots]
    for path in files:
        if path.name.endswith(EPISODE_SUFFIX):
            yield asset("episode", path, [])
        if path.suffix.lower() not in MESH_SUFFIXES or below(path, folders):
            continue
        relative = str(path.relative_to(assets))
        kind = "scene" if any(word in relative.lower() for word in SCENE_WORDS) else "object"
        known = [option for pattern, more in KNOWN.items() if fnmatch.fnmatch(relative, pattern) for option in more]
        yield asset(kind, path, known)


class Trial:
    """What is done with assets, one by one."""

    def __init__(self, tools: Tools, out: pathlib.Path):
        self.tools = tools
        self.out = out
        self.sample = {kind: out / "sample" / f"{kind}.pack" for kind in ("scene", "objects", "robot")}

    def log(self, asset: Asset) -> pathlib.Path:
        return self.out / "logs" / f"{asset.kind}.{asset.name}.log"

    def bake_sample(self) -> None:
        log = self.out / "logs" / "sample.log"
        self.sample["scene"].parent.mkdir(parents=True, exist_ok=True)
        inputs = {
            "scene": [SAMPLE / "apartment.glb", "--check-columns", 0],
            "objects": [SAMPLE / "objects", "--as", "object", "--eps", 0.02, "--tau", 0.03],
            "robot": [SAMPLE / "robot/porter.urdf", "--recipe", SAMPLE / "robot/robot.toml"],
        }
        for kind, words in inputs.items():
            code, error = self.tools.run(log, "galactic-bake", *words, "-q", "-o", self.sample[kind])
            if code != 0:
                sys.exit(f"try_assets.py: the sample world cannot be baked: {error}")

    def run(self, asset: Asset) -> list[Verdict]:
        """The asset's verdict, and those of what it is made of."""
        verdicts = self.bake(asset)
        for verdict in verdicts:
            self.go_on(verdict)
        return verdicts

    def bake(self, asset: Asset) -> list[Verdict]:
        verdict = Verdict(asset)
        assert asset.source is not None
        asset.pack.parent.mkdir(parents=True, exist_ok=True)
        report = asset.pack.with_suffix(".json")
        kind = "episodes" if asset.kind == "episode" else asset.kind
        started = time.monotonic()
        code, error = self.tools.run(
            self.log(asset),
            "galactic-bake",
            asset.source,
            "--as",
            kind,
            "-o",
            asset.pack,
            "--report",
            report,
            "--threads",
            1,
            *asset.options,
        )
        verdict.seconds = time.monotonic() - started
        if code == 0:
            verdict.bake = "ok"
        elif code in REFUSED:
            verdict.bake, verdict.refusal = "refused", error
        else:
            verdict.bake = f"ended with {code}"
            verdict.faults.append(f"galactic-bake: {error}")
        if report.exists():
            told = json.loads(report.read_text())
            verdict.warnings += [text for one in [told, *told.get("baked", [])] for text in one.get("warnings", [])]
        if code != 0 or asset.kind != "dataset":
            return [verdict]
        verdict.bake, verdict.check = "ok", self.check(verdict)
        return [verdict, *(Verdict(part, bake="ok") for part in self.parts_of(asset))]

    @staticmethod
    def parts_of(dataset: Asset) -> Iterator[Asset]:
        folder = dataset.pack.with_suffix("")
        for kind in ("scene", "object"):
            for pack in sorted((folder / f"{kind}s").glob("*.pack")):
                textures = sorted((folder / "textures").glob("*.pack"))
                yield Asset(kind, None, f"{dataset.name}.{pack.stem}", pack, textures=textures)

    def go_on(self, verdict: Verdict) -> None:
        """With what is baked."""
        if verdict.bake != "ok":
            return
        if verdict.check == "-":
            verdict.check = self.check(verdict)
        if verdict.check != "ok" or verdict.asset.kind in ("episode", "dataset"):
            return
        verdict.draw = self.draw(verdict)
        if verdict.asset.kind == "robot" and "--recipe" not in verdict.asset.options:
            verdict.simulate = "no recipe"
        else:
            verdict.simulate = self.simulate(verdict)

    def step(self, verdict: Verdict, what: str, *command: object) -> bool:
        code, error = self.tools.run(self.log(verdict.asset), *command)
        if code != 0:
            verdict.faults.append(f"{what} ended with {code}: {error}")
        return code == 0

    def check(self, verdict: Verdict) -> str:
        return "ok" if self.step(verdict, "check", "galactic-pack", "check", verdict.asset.pack) else "FAILED"

    def draw(self, verdict: Verdict) -> str:
        picture = self.out / "pictures" / f"{verdict.asset.kind}.{verdict.asset.name}.png"
        picture.parent.mkdir(parents=True, exist_ok=True)
        if not self.step(verdict, "picture", "galactic-pack", "picture", verdict.asset.pack, "-o", picture):
            return "FAILED"
        verdict.pictures.append(picture)
        return "ok"

    def simulate(self, verdict: Verdict) -> str:
        asset = verdict.asset
        folder = self.out / "worlds" / f"{asset.kind}.{asset.name}"
        folder.mkdir(parents=True, exist_ok=True)

        # A world's packs lie beside it.
        def beside(pack: pathlib.Path, name: str) -> pathlib.Path:
            link = folder / name
            link.unlink(missing_ok=True)
            os.link(pack, link)
            return link

        packs = [
            beside(asset.pack if kind.removesuffix("s") == asset.kind else pack, f"{kind}.pack")
            for kind, pack in self.sample.items()
        ]
        textures = [beside(pack, pack.name) for pack in asset.textures]
        episodes = folder / "episodes.pack"
        objects = 1 if asset.kind == "object" else 3
        code, error = self.tools.run(
            self.log(asset),
            "galactic-bake",
            *packs,
            "--as",
            "episodes",
            "--count",
            4,
            "--objects",
            objects,
            "--flatness",
            0.01,
            "--goal-distance",
            0.3,
            "--solve",
            0,
            "-q",
            "--threads",
            1,
            "-o",
            episodes,
        )
        if code in REFUSED:
            verdict.refusal = error
            return "no episodes"
        if code != 0:
            verdict.faults.append(f"episodes ended with {code}: {error}")
            return "FAILED"
        world, sheet = folder / "world.pack", self.out / "pictures" / f"{asset.kind}.{asset.name}.run.png"
        report = folder / "run.json"
        ran = self.step(
            verdict, "world", "galactic-bake", *packs, *textures, episodes, "--as", "world", "-q", "-o", world
        )
        ran = ran and self.step(
            verdict,
            "run",
            "galactic-run",
            world,
            "--envs",
            4,
            "--steps",
            200,
            "--threads",
            1,
            "--render",
            "rgbd",
            "--frame-every",
            60,
            "--contact-sheet",
            sheet,
            "--report",
            report,
        )
        if not ran:
            return "FAILED"
        verdict.pictures.append(sheet)
        if re.search(r"\b(nan|inf(inity)?)\b", report.read_text(), re.IGNORECASE):
            verdict.faults.append("run: its report has a number that is none")
            return "FAILED"
        return "ok"


def kind_of_warning(text: str) -> str:
    """The same text for warnings that differ in names and numbers only."""
    text = re.sub(r"'[^']*'|\"[^\"]*\"", "'...'", text)
    text = re.sub(r"(?<![A-Za-z_])[-+]?\d[\d.,]*(e[-+]?\d+)?", "#", text)
    return re.sub(r"^[^ :]+: ", "", text)


def table_row(cells: Sequence[object]) -> str:
    name, kind, bake, check, simulate, draw, warnings, seconds = cells
    return f"{name:72} {kind:8} {bake:10} {check:6} {simulate:11} {draw:6} {warnings:>8} {seconds:>8}"


def row_of(one: Verdict) -> str:
    cells = (one.asset.name, one.asset.kind, one.bake, one.check, one.simulate, one.draw, len(one.warnings))
    return table_row((*cells, f"{one.seconds:.1f}"))


def print_reasons(verdicts: list[Verdict]) -> None:
    groups: dict[str, list[tuple[str, str]]] = {}
    for one in verdicts:
        for text in one.warnings:
            groups.setdefault(kind_of_warning(text), []).append((one.asset.name, text))
    print("\nWhat warned, and why:")
    for found in sorted(groups.values(), key=lambda found: -len(found)):
        names = {name for name, _ in found}
        print(f"  {len(found)} times in {len(names)} assets, first in {found[0][0]}:\n    {found[0][1]}")
    for title, reasons in (
        ("Refused", [(one, [one.refusal]) for one in verdicts if one.refusal]),
        ("Wrong", [(one, one.faults) for one in verdicts if one.faults]),
    ):
        print(f"\n{title}:" + ("" if reasons else " nothing"))
        for one, texts in reasons:
            print("\n".join(f"  {one.asset.kind} {one.asset.name}: {text}" for text in texts))


def write_page(verdicts: list[Verdict], out: pathlib.Path) -> None:
    rows, pictures = [], []
    for one in verdicts:
        cells = [
            one.asset.name,
            one.asset.kind,
            one.bake,
            one.check,
            one.simulate,
            one.draw,
            "; ".join([*one.faults, one.refusal, *one.warnings]).strip("; "),
        ]
        bad = ' class="bad"' if one.faults else ""
        rows.append(f"<tr{bad}>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in cells) + "</tr>")
        for picture in one.pictures:
            place = html.escape(str(picture.relative_to(out)))
            pictures.append(
                f'<figure><img src="{place}" loading="lazy"><figcaption>{html.escape(one.asset.name)}'
                "</figcaption></figure>"
            )
    head = "".join(f"<th>{name}</th>" for name in ("asset", "kind", "bake", "check", "simulate", "draw", "why"))
    (out / "index.html").write_text(
        "<!doctype html><meta charset=utf-8><title>Assets</title><style>body{font:14px sans-serif}"
        "td{vertical-align:top;padding:2px 8px}.bad{background:#fdd}figure{display:inline-block;margin:6px}"
        "img{max-width:420px;max-height:420px}"
        f"</style><table><tr>{head}</tr>{''.join(rows)}</table>{''.join(pictures)}\n"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("assets", type=pathlib.Path, help="folder that is searched")
    parser.add_argument("-o", "--out", type=pathlib.Path, default=ROOT / "build/assets", help="folder of what is made")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/release/bin", help="folder of the tools")
    parser.add_argument("--jobs", type=int, default=1, help="assets at a time")
    parser.add_argument("--only", default="", help="only assets whose path has this text")
    arguments = parser.parse_args()
    if not arguments.assets.is_dir():
        parser.error(f"{arguments.assets} is no folder")
    out = arguments.out.resolve()
    found = [one for one in find_assets(arguments.assets.resolve(), out) if arguments.only in str(one.source)]
    if not found:
        parser.error(f"{arguments.assets} has no asset{' like this' if arguments.only else ''}")
    shutil.rmtree(out / "logs", ignore_errors=True)
    trial = Trial(Tools(arguments.bin.resolve(), out), out)
    trial.bake_sample()
    verdicts: list[Verdict] = []
    print(table_row(("asset", "kind", "bake", "check", "simulate", "draw", "warnings", "seconds")), flush=True)
    with concurrent.futures.ThreadPoolExecutor(max(1, arguments.jobs)) as pool:
        for tried in pool.map(trial.run, found):
            verdicts += tried
            print("\n".join(map(row_of, tried)), flush=True)
    print_reasons(verdicts)
    write_page(verdicts, out)
    print(f"\nPictures: {out / 'index.html'}")
    return 1 if any(one.faults for one in verdicts) else 0


if __name__ == "__main__":
    sys.exit(main())
