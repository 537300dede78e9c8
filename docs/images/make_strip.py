#!/usr/bin/env python3
"""Makes strip.jpg, the picture of the README, of the sample world: run it after scripts/quickstart.sh.

The upper row follows four robots at work; the lower row shows what one of them sees (color, depth), the
same moment as the simulation knows it (spheres, boxes), and the home with all starts, targets and goals.
Needs Pillow (Debian: python3-pil).
"""

import pathlib
import subprocess
import tempfile

from PIL import Image

HERE = pathlib.Path(__file__).parent
BUILD = HERE.parents[1] / "build/release"
WORLD = BUILD / "sample/world.pack"
RUN = [
    str(BUILD / "bin/galactic-run"),
    str(WORLD),
    "--envs",
    "4",
    "--policy",
    "scripted",
    "--backend",
    "soft",
    "-q",
]

WIDTH = 1600
GAP = 8
# Moments of the four robots, and of the one whose eyes we look through.
FOLLOWED = [(0, 144), (1, 192), (2, 96), (3, 96)]
EYES = (3, 180)


def frames(folder: pathlib.Path, steps: int, every: int, *options: str) -> None:
    subprocess.run(
        [
            *RUN,
            "--steps",
            str(steps),
            "--frames",
            str(folder),
            "--frame-every",
            str(every),
            "--frame-envs",
            "4",
            *options,
        ],
        check=True,
    )


def row(images: list[Image.Image]) -> Image.Image:
    """The images beside each other, all of the height with which they fill the strip's width."""
    shapes = [image.width / image.height for image in images]
    height = int((WIDTH - GAP * (len(images) - 1)) / sum(shapes))
    canvas = Image.new("RGB", (WIDTH, height), "white")
    x = 0
    for image, shape in zip(images, shapes):
        canvas.paste(image.resize((round(height * shape), height), Image.LANCZOS), (x, 0))
        x += round(height * shape) + GAP
    return canvas


def gray(depth: Image.Image) -> Image.Image:
    """Millimeters as gray, black where they are 0 and white from 4 m on."""
    return depth.point(lambda millimeters: millimeters / 16).convert("L").convert("RGB")


def main() -> None:
    with tempfile.TemporaryDirectory() as temporary:
        made = pathlib.Path(temporary)
        view = ["--render", "rgb", "--size", "784x584", "--camera", "follow", "--fov", "80"]
        frames(made / "follow", 192, 48, *view)
        frames(made / "eyes", 180, 60, "--render", "rgbd", "--size", "584", "--debug-view")
        plan = made / "plan.png"
        subprocess.run(
            [str(BUILD / "bin/galactic-pack"), "picture", str(WORLD), "-o", str(plan)], check=True
        )

        def frame(folder: str, kind: str, env: int, step: int) -> Image.Image:
            return Image.open(made / folder / f"env_{env:04}_step_{step:06}_{kind}.png")

        # Without the plan's title and legend.
        home = Image.open(plan).convert("RGB").crop((92, 92, 1092, 838))
        upper = row([frame("follow", "rgb", *moment) for moment in FOLLOWED])
        lower = row(
            [
                frame("eyes", "rgb", *EYES),
                gray(frame("eyes", "depth", *EYES)),
                frame("eyes", "debug", *EYES),
                home,
            ]
        )
        strip = Image.new("RGB", (WIDTH, upper.height + GAP + lower.height), "white")
        strip.paste(upper, (0, 0))
        strip.paste(lower, (0, upper.height + GAP))
        strip.save(HERE / "strip.jpg", quality=88, optimize=True)


if __name__ == "__main__":
    main()
