"""Renderer: its images, where they are drawn to, and what is refused."""

import ast
import gc
import os
import pathlib
import pickle

import numpy as np
import pytest

from galactic import Error, ErrorCode, Renderer, Simulator, VectorEnv

ENVS = 6
CAMERA = {"camera": "follow", "backend": "soft", "threads": 1, "width": 32, "height": 20}


@pytest.fixture
def simulator(world):
    return Simulator(world, envs=ENVS, threads=1, body_transforms=True)


def test_images_have_the_shapes_and_types_that_they_promise(simulator):
    for options, wanted in (
        ({}, {"rgb": ((ENVS, 20, 32, 3), np.uint8), "depth": ((ENVS, 20, 32), np.float32)}),
        ({"color": "rgba", "depth": False}, {"rgba": ((ENVS, 20, 32, 4), np.uint8)}),
        ({"color": None, "semantics": True, "depth": False},
         {"semantics": ((ENVS, 20, 32), np.int32)}),
    ):  # fmt: skip
        renderer = Renderer(simulator, **CAMERA, **options)
        images = renderer.render()
        assert {name: (one.shape, one.dtype) for name, one in images.items()} == wanted
        assert {n: ((ENVS, *s), t) for n, (s, t) in renderer.shapes.items()} == wanted
    assert renderer.backend == "soft"
    assert "soft" in repr(renderer)
    assert len(renderer.semantic_names) > images["semantics"].max() > 0


def test_images_are_drawn_where_the_caller_wants_them(simulator, draw_actions):
    renderer = Renderer(simulator, **CAMERA)
    wanted = renderer.render()
    memory = np.zeros((4, ENVS, 20, 32, 3), np.uint8)
    images = renderer.render(out={"rgb": memory[2]})
    assert np.shares_memory(images["rgb"], memory)
    np.testing.assert_array_equal(memory[2], wanted["rgb"])
    np.testing.assert_array_equal(images["depth"], wanted["depth"])
    assert not memory[[0, 1, 3]].any()
    some = renderer.render(envs=[4, 1])
    np.testing.assert_array_equal(some["rgb"], wanted["rgb"][[4, 1]])
    assert not np.shares_memory(renderer.render()["rgb"], renderer.render()["rgb"])


@pytest.mark.parametrize("camera", [{"camera": "head"}, {"camera": "follow", "fov_degrees": 40}])
def test_cameras_project_objects_to_where_they_are_drawn(world, draw_actions, camera):
    images = {**CAMERA, "width": 64, "height": 40, **camera}
    env = VectorEnv(world, ENVS, images=images, threads=1, episode_steps=7)
    env.reset()
    (renderer,) = env.renderers
    inside = drawn = 0
    for _ in range(20):  # which end episodes: some images are drawn in renderings of their own
        seen = env.step(draw_actions(ENVS, 8))[0]
        for number, world_from_camera in enumerate(renderer.world_from_camera):
            camera_from_world = np.linalg.inv(world_from_camera)
            for pose in env.simulators[0].env_state(number).objects:
                place = camera_from_world[:3] @ [*pose.translation, 1]
                column, row, _ = renderer.intrinsics @ (place / place[2])
                if place[2] < 0.1 or not (0 <= column < 64 and 0 <= row < 40):
                    continue
                depth = seen["depth"][number, int(row), int(column)]
                # The object, or what hides it.
                assert 0 < depth < place[2] + 0.02
                inside += 1
                drawn += depth > place[2] - 0.1
    assert drawn > 20 and drawn > inside / 4
    assert VectorEnv(world, 2, threads=1).renderers == ()


def test_cameras_stand_where_their_position_and_turn_say(simulator):
    place = {"position": (0.1, 0.2, 0.3), "rpy_degrees": np.array([0, 30, 90])}
    for camera in ("head", "hand", "top"):
        plain = Renderer(simulator, **{**CAMERA, "camera": camera})
        moved = Renderer(simulator, **{**CAMERA, "camera": camera}, **place)
        moved.render()
        # Of an image: to the right, down, ahead. The place: ahead, to the left, up.
        half, root = 0.5, np.sqrt(0.75)
        wanted = np.eye(4)
        wanted[:3, 3] = -0.2, -0.3, 0.1
        wanted[:3, 0] = 0, 0, 1  # its right is what was ahead
        wanted[:3, 1] = half, root, 0
        wanted[:3, 2] = -root, half, 0
        np.testing.assert_allclose(
            moved.world_from_camera, plain.world_from_camera @ wanted, atol=1e-5
        )


def test_objects_may_have_ids_of_their_own(world, draw_actions):
    simulator = Simulator(world, envs=ENVS, threads=1, body_transforms=True)
    options = {**CAMERA, "width": 64, "height": 64, "camera": "head"}
    plain = Renderer(simulator, **options, semantics=True)
    renderer = Renderer(simulator, **options, semantics="objects")
    names = renderer.semantic_names
    rays = np.linalg.inv(renderer.intrinsics)
    pixels_of_objects = 0
    for _ in range(30):
        simulator.step(draw_actions(ENVS, 8))
        by_name, seen = plain.render(), renderer.render()
        for image in ("rgb", "depth"):
            np.testing.assert_array_equal(seen[image], by_name[image])
        is_object = seen["semantics"] >= len(names)
        np.testing.assert_array_equal(
            seen["semantics"][~is_object], by_name["semantics"][~is_object]
        )
        for env, row, column in np.argwhere(is_object):
            state = simulator.env_state(env)
            number = seen["semantics"][env, row, column] - len(names)
            ray = rays @ [column + 0.5, row + 0.5, 1] * seen["depth"][env, row, column]
            point = renderer.world_from_camera[env] @ [*ray, 1]
            # Of objects of one name, the one that is there.
            distances = [np.linalg.norm(point[:3] - one.translation) for one in state.objects]
            assert distances[number] < 0.15
            pixels_of_objects += 1
        # All objects, and nothing else.
        np.testing.assert_array_equal(is_object, by_name["semantics"] == names.index("thing"))
    assert pixels_of_objects > 100


def test_what_is_too_near_is_not_drawn(simulator):
    depth = Renderer(simulator, **CAMERA).render()["depth"]
    middle = np.float32(np.median(depth[depth > 0]))
    behind = Renderer(simulator, **CAMERA, near=middle).render()["depth"]
    assert behind[behind > 0].min() >= middle * (1 - 1e-5)
    is_far = depth > middle + 0.01
    # Cut triangles have edges of their own, along which pixels may show the neighbor.
    assert np.mean(np.abs(behind[is_far] - depth[is_far]) < 0.01) > 0.99


def test_the_simulator_may_step_while_it_draws(simulator, draw_actions):
    renderer = Renderer(simulator, **CAMERA)
    for _ in range(5):
        wanted = renderer.render()
        renderer.begin_render()
        simulator.step(draw_actions(ENVS, 8))
        drawn = renderer.end_render()
        np.testing.assert_array_equal(drawn["rgb"], wanted["rgb"])
        np.testing.assert_array_equal(drawn["depth"], wanted["depth"])
    assert not np.array_equal(renderer.render()["depth"], wanted["depth"])


def test_calls_out_of_turn_are_refused(simulator, draw_actions):
    renderer = Renderer(simulator, **CAMERA)
    with pytest.raises(RuntimeError, match="no rendering is under way"):
        renderer.end_render()
    renderer.begin_render()
    for call in (renderer.render, renderer.begin_render, renderer.render_to_device):
        with pytest.raises(RuntimeError, match="a rendering is under way"):
            call()
    renderer.end_render()
    simulator.begin_step(draw_actions(ENVS, 8))
    with pytest.raises(RuntimeError, match="a step is under way"):
        renderer.render()
    simulator.end_step()
    renderer.render()


def test_what_is_drawn_to_stays_until_it_is_done(world):
    for _ in range(10):
        simulator = Simulator(world, envs=64, threads=1, body_transforms=True)
        renderer = Renderer(simulator, **CAMERA)
        renderer.begin_render(out={"rgb": np.zeros((64, 20, 32, 3), np.uint8)})
        del simulator
        gc.collect()
        del renderer
        gc.collect()


def test_two_threads_cannot_use_one_renderer_at_once(world, refused_at_once):
    simulator = Simulator(world, envs=256, threads=1, body_transforms=True)
    renderer = Renderer(simulator, **CAMERA)
    refusals = refused_at_once(*2 * [renderer.render], times=20)
    assert refusals
    assert all("another thread is using this galactic." in text for text in refusals)
    renderer.render()


@pytest.mark.parametrize(
    "options, error, message",
    [
        ({"widht": 3}, TypeError, "there is no option widht; did you mean width?"),
        ({"xyzzy": 3}, TypeError, "there is no option xyzzy; the options are width, height"),
        ({"width": 0}, Error, "width: is 0, expected a whole number from 1 to 4096"),
        ({"width": 128.0}, Error, "width: is 128.0, expected a whole number from 1 to 4096"),
        ({"height": -3}, Error, "height: is -3, expected a whole number from 1 to 4096"),
        ({"height": 2**70}, Error, f"height: is {2**70}, expected"),
        ({"color": 2}, Error, "color: is 2, expected rgb, rgba or None"),
        ({"backend": None}, Error, "backend: is None, expected auto, cuda, gl or soft"),
        ({"camera": 1}, Error, "camera: is 1, expected head, follow, top or a link"),
        ({"depth": "no"}, Error, "depth: is 'no', expected True or False"),
        ({"threads": -1}, Error, "threads: is -1, expected 0 to 4096; 0 takes one per processor"),
        ({"backend": "cuda", "device": -1}, Error, "device: is -1, expected a whole number"),
        ({"backend": "cuda", "device": 1.5}, Error, "device: is 1.5, expected an index or a name"),
        ({"device": 0}, Error, "device: is 0, but the soft backend draws on the processor"),
        ({"fov_degrees": "wide"}, Error, "fov_degrees: is 'wide', expected a number"),
        ({"semantics": "names"}, Error, "semantics: is 'names', expected True, False or objects"),
        ({"near": -1}, Error, "near: found -1 m, expected 0.01 to 100, or 0 for what belongs"),
        ({"position": (0, 0, 101)}, Error, "position: found 101 m, expected -100 to 100"),
        ({"position": (0, 0, np.inf)}, ValueError, "position holds a number that is not finite"),
        ({"position": ("1", "2", "3")}, TypeError, "position has the type <U1, expected numbers"),
        ({"position": (0, 1)}, ValueError, "position has the shape (2,), expected (3,)"),
        ({"rpy_degrees": (0, 0, 400)}, Error, "rpy_degrees: found 400 degrees, expected -360"),
        ({"rpy_degrees": "up"}, TypeError, "rpy_degrees has the type <U2, expected numbers"),
        ({"color": "bgr"}, Error, "color: is bgr, expected rgb, rgba or None"),
        ({"backend": "vulkan"}, Error, "backend: is vulkan, expected auto, cuda, gl or soft"),
        ({"color": None, "depth": False}, Error, "found no image to make"),
        ({"camera": "tail"}, Error, 'camera: found no link "tail" in helper'),
    ],
)
def test_wrong_options_are_refused(simulator, options, error, message):
    with pytest.raises(error) as caught:
        Renderer(simulator, **{**CAMERA, **options})
    assert message in str(caught.value)


@pytest.mark.parametrize("fov", [-5, 0.5, 175.5, 180, 200, 360, 500, np.nan, np.inf])
def test_fields_of_view_that_show_nothing_are_refused(world, simulator, fov):
    message = "fov_degrees: found a vertical field of view of .* degrees, expected 1 to 175, or 0"
    with pytest.raises(Error, match=message):
        Renderer(simulator, **CAMERA, fov_degrees=fov)
    with pytest.raises(Error, match=message):
        VectorEnv(world, 2, images={**CAMERA, "fov_degrees": fov})


def test_what_is_left_out_is_what_the_defaults_say(simulator):
    assert tuple(Renderer.DEFAULTS) == Renderer.OPTIONS
    plain, said = Renderer(simulator), Renderer(simulator, **Renderer.DEFAULTS)
    assert plain.shapes == said.shapes and plain.description == said.description
    for name, image in plain.render().items():
        np.testing.assert_array_equal(image, said.render()[name])
    with pytest.raises(TypeError):
        Renderer.DEFAULTS["width"] = 64


def test_type_checkers_are_told_the_same_defaults():
    types = pathlib.Path(os.environ["GALACTIC_SOURCE_DIR"], "python/galactic/_core.pyi")
    classes = {c.name: c for c in ast.parse(types.read_text()).body if isinstance(c, ast.ClassDef)}
    (made,) = (f for f in classes["Renderer"].body if getattr(f, "name", "") == "__init__")
    told = {
        name.arg: ast.literal_eval(value)
        for name, value in zip(made.args.kwonlyargs, made.args.kw_defaults)
    }
    assert told == dict(Renderer.DEFAULTS)


def test_noise_above_its_limits_is_refused(simulator):
    assert tuple(Renderer.NOISE_LIMITS) == Renderer.NOISE_OPTIONS
    for name, most in Renderer.NOISE_LIMITS.items():
        with pytest.raises(Error, match=f"{name}: is .*expected .* to {most:g}"):
            Renderer(simulator, **CAMERA, **{name: 1.001 * most})


def test_the_widest_field_of_view_and_that_of_the_camera_show_something(simulator):
    for fov in (0, 175, np.float32(90)):
        assert Renderer(simulator, **CAMERA, fov_degrees=fov).render()["rgb"].any()


def test_devices_may_be_numbers(simulator):
    def outcome(device):
        try:
            return Renderer(simulator, **{**CAMERA, "backend": "cuda"}, device=device).description
        except Error as error:  # here, or where there is no device
            return str(error)

    assert outcome(0) == outcome(np.int32(0)) == outcome("0")


def test_wrong_simulators_and_uses_are_refused(world, simulator):
    with pytest.raises(Error, match="without body_transforms"):
        Renderer(Simulator(world, envs=2, threads=1), **CAMERA)
    with pytest.raises(TypeError, match="is a World, expected a galactic.Simulator"):
        Renderer(world)
    renderer = Renderer(simulator, **CAMERA)
    with pytest.raises(Error) as caught:
        renderer.render_to_device()
    assert caught.value.code is ErrorCode.UNSUPPORTED
    with pytest.raises(IndexError, match="there is no env 6"):
        renderer.render(envs=[ENVS])
    with pytest.raises(ValueError, match="out has 'semantics', which this renderer does not draw"):
        renderer.render(out={"semantics": np.zeros((ENVS, 20, 32), np.int32)})
    with pytest.raises(TypeError, match="depth is a list, expected a numpy array"):
        renderer.render(out={"depth": [0]})
    frozen = np.zeros((ENVS, 20, 32), np.float32)
    frozen.flags.writeable = False
    with pytest.raises(ValueError, match="depth is read-only"):
        renderer.render(out={"depth": frozen})
    with pytest.raises(TypeError, match="cannot be pickled or copied"):
        pickle.dumps(renderer)
