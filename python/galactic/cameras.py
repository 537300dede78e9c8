"""Cameras of a batch of envs, by name: their images in arrays for all envs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic._core import Renderer, Simulator

Array = NDArray[Any]


def options_of_cameras(where: str, images: Any) -> dict[str, Mapping[str, Any]]:
    """The options in the argument `images`, by the cameras' names: "" for a single camera, none for
    None. Raises ValueError, which calls the argument `where`, if it is invalid."""
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
    """Whether a camera with these options of a Renderer stands in the world, and not on the
    robot."""
    return options.get("world_from_camera") is not None


def options_of_half(
    where: str, cameras: Mapping[str, Mapping[str, Any]], half: int, halves: int, num_envs: int
) -> dict[str, Mapping[str, Any]]:
    """The camera options of one half of `num_envs` envs, with that half's rows of places if each
    env has its own. Raises ValueError, which calls the cameras `where`, if there are places for
    another number of envs."""
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
    """The name of a camera's image among the images of all cameras."""
    return f"{camera}_{image}" if camera else image


class Cameras:
    """Cameras that look at the envs of a simulator, which was made with body_transforms=True.

    Args:
        simulator: the simulator that they look at.
        options: options of a Renderer for each camera, by the camera's name, which prefixes the
            names of its images; the images of a camera named "" have no prefix.
        threads: number of threads with which each camera draws, unless its options say otherwise.
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
        """Shape (without the env's axis) and type of each image."""

    def blank_images(self) -> dict[str, Array]:
        """Arrays of zeros for the images of all envs."""
        return {
            name: np.zeros((self.num_envs, *shape), dtype)
            for name, (shape, dtype) in self.shapes.items()
        }

    def draw(self, places: Mapping[str, Array]) -> dict[str, Array]:
        """Draws the images of all envs: into the arrays in `places` where given, otherwise into new
        arrays."""
        images = {}
        for camera, renderer in self.renderers.items():
            names = {image: image_name(camera, image) for image in renderer.shapes}
            given = {image: places[name] for image, name in names.items() if name in places}
            for image, drawn in renderer.render(given).items():
                images[names[image]] = drawn
        return images

    def draw_again(self, images: Mapping[str, Array], which: NDArray[np.int64]) -> None:
        """Draws the images of the envs `which` into `images`, the arrays of all envs."""
        for camera, renderer in self.renderers.items():
            for image, drawn in renderer.render(envs=which).items():
                images[image_name(camera, image)][which] = drawn

    def places_of(self, which: NDArray[np.int64]) -> dict[str, Array]:
        """The camera poses from which the images of the envs `which` were last drawn, as in
        Renderer.world_from_camera; zeros for the other envs."""
        places = {}
        for camera, renderer in self.renderers.items():
            place = np.zeros((self.num_envs, 4, 4), np.float32)
            place[which] = renderer.world_from_camera[which]
            places[image_name(camera, "world_from_camera")] = place
        return places


class LazyImages:
    """Images that are drawn only on demand, and once for each state of an env."""

    def __init__(self, cameras: Cameras) -> None:
        self._cameras = cameras
        self._images = cameras.blank_images()
        self._shown = {name: image.view() for name, image in self._images.items()}
        for view in self._shown.values():
            view.flags.writeable = False
        self._is_stale = np.ones(cameras.num_envs, np.bool_)

    def forget(self, which: NDArray[np.int64] | slice) -> None:
        """Marks the images of the envs `which` as out of date."""
        self._is_stale[which] = True

    def look(self) -> dict[str, Array]:
        """The images of all envs as they are now: read-only views, which later calls overwrite."""
        stale = np.flatnonzero(self._is_stale)
        if len(stale) == len(self._is_stale):
            self._cameras.draw(self._images)
        elif len(stale):
            self._cameras.draw_again(self._images, stale)
        self._is_stale[:] = False
        return dict(self._shown)
