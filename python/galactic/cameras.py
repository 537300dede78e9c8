"""Cameras of a batch of envs, by name: their images in arrays of all envs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic._core import Renderer, Simulator

Array = NDArray[Any]


def options_of_cameras(where: str, images: Any) -> dict[str, Mapping[str, Any]]:
    """Those of the argument `images` by the cameras' names: "" for a single one, none for None. ValueError,
    which calls it `where`, for what it cannot be."""
    if images is None:
        return {}
    wanted = "options of galactic.Renderer, those of each camera by its name, or None for no images"
    if not isinstance(images, Mapping):
        raise ValueError(f"{where} is {images!r}, expected {wanted}")
    named = {name for name, value in images.items() if isinstance(value, Mapping)}
    if not named:
        return {"": images}
    for name, value in images.items():
        if name not in named:
            raise ValueError(
                f"{where}[{name!r}] is {value!r}, expected options, as the other cameras have"
            )
        if not isinstance(name, str) or not name.isidentifier():
            raise ValueError(f"a camera of {where} is {name!r}, expected a name, such as hand")
    return {
        name: dict(value) if stands_in_world(value) else {"camera": name, **value}
        for name, value in images.items()
    }


def stands_in_world(options: Mapping[str, Any]) -> bool:
    """Whether a camera with these options of a Renderer is none on the robot."""
    return options.get("world_from_camera") is not None


def options_of_half(
    where: str, cameras: Mapping[str, Mapping[str, Any]], half: int, halves: int, num_envs: int
) -> dict[str, Mapping[str, Any]]:
    """Those of the cameras of one half of `num_envs` envs, which has its rows of places of each env. ValueError,
    which calls the cameras `where`, for places of another number of envs."""
    found = {}
    for name, options in cameras.items():
        if stands_in_world(options) and np.ndim(options["world_from_camera"]) == 3:
            places = np.asarray(options["world_from_camera"])
            if len(places) != num_envs:
                raise ValueError(
                    f"world_from_camera of {where} has the shape {places.shape}, expected (4, 4) or ({num_envs}, 4, 4)"
                )
            options = {**options, "world_from_camera": np.split(places, halves)[half]}
        found[name] = options
    return found


def image_name(camera: str, image: str) -> str:
    """What an image of a camera is called among those of all."""
    return f"{camera}_{image}" if camera else image


class Cameras:
    """Cameras that look at the envs of a simulator, which was made with body_transforms=True.

    Args:
        simulator: what they look at.
        options: of a Renderer for each camera, by its name, which begins those of its images; one called ""
            has images by their own names.
        threads: that each draws with, unless its options say so.
    """

    def __init__(
        self, simulator: Simulator, options: Mapping[str, Mapping[str, Any]], threads: int
    ) -> None:
        self.num_envs = simulator.num_envs
        self.renderers: dict[str, Renderer] = {}
        for name, camera in options.items():
            with_threads: dict[str, Any] = {"threads": threads, **camera}
            self.renderers[name] = Renderer(simulator, **with_threads)
        self.shapes = {
            image_name(camera, image): shape
            for camera, renderer in self.renderers.items()
            for image, shape in renderer.shapes.items()
        }
        """Shape, without the env's axis, and type of each image."""

    def blank_images(self) -> dict[str, Array]:
        """Arrays for the images of all envs, zeros."""
        return {
            name: np.zeros((self.num_envs, *shape), dtype)
            for name, (shape, dtype) in self.shapes.items()
        }

    def draw(self, places: Mapping[str, Array]) -> dict[str, Array]:
        """The images of all envs: in `places`, where these have one, else in new arrays."""
        images = {}
        for camera, renderer in self.renderers.items():
            names = {image: image_name(camera, image) for image in renderer.shapes}
            given = {image: places[name] for image, name in names.items() if name in places}
            for image, drawn in renderer.render(given).items():
                images[names[image]] = drawn
        return images

    def draw_again(self, images: Mapping[str, Array], which: NDArray[np.int64]) -> None:
        """Draws the images of the envs `which` into `images`, those of all."""
        for camera, renderer in self.renderers.items():
            for image, drawn in renderer.render(envs=which).items():
                images[image_name(camera, image)][which] = drawn

    def places_of(self, which: NDArray[np.int64]) -> dict[str, Array]:
        """Where the images of the envs `which` were drawn from last, as Renderer.world_from_camera has it;
        zeros for the others."""
        places = {}
        for camera, renderer in self.renderers.items():
            place = np.zeros((self.num_envs, 4, 4), np.float32)
            place[which] = renderer.world_from_camera[which]
            places[image_name(camera, "world_from_camera")] = place
        return places


class LazyImages:
    """What cameras see, drawn when somebody looks, and once for each state of an env."""

    def __init__(self, cameras: Cameras) -> None:
        self._cameras = cameras
        self._images = cameras.blank_images()
        self._shown = {name: image.view() for name, image in self._images.items()}
        for view in self._shown.values():
            view.flags.writeable = False
        self._is_stale = np.ones(cameras.num_envs, np.bool_)

    def forget(self, which: NDArray[np.int64] | slice) -> None:
        """What was seen of the envs `which` is of before."""
        self._is_stale[which] = True

    def look(self) -> dict[str, Array]:
        """The images of all envs as they are now: views that cannot be written, overwritten by later looks."""
        stale = np.flatnonzero(self._is_stale)
        if len(stale) == len(self._is_stale):
            self._cameras.draw(self._images)
        elif len(stale):
            self._cameras.draw_again(self._images, stale)
        self._is_stale[:] = False
        return dict(self._shown)
