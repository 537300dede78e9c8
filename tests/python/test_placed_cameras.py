"""Cameras that stand in the world, images without the robot, and the boxes of objects in them."""

import json

import numpy as np
import pytest

from galactic import (
    DemonstrationWriter,
    Error,
    ErrorCode,
    Renderer,
    Simulator,
    VectorEnv,
    look_at,
)
from galactic.demonstrations import INDEX

ENVS = 6
IMAGES = {"backend": "soft", "threads": 1, "width": 64, "height": 48, "semantics": "objects"}
# Above a corner of the small home, of 3 x 2.5 x 3 m, and through it to the opposite one, where the floor is.
IN_CORNER = np.array([0.3, 2.2, 0.3])


def looking(eye, at):
    """world_from_camera of a camera at `eye` that looks to `at`, with what is up up in the image."""
    ahead = (at - eye) / np.linalg.norm(at - eye)
    right = np.cross(ahead, [0, 1, 0])
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.stack([right, np.cross(ahead, right), ahead, eye], axis=1)
    return matrix


ROOM = looking(IN_CORNER, np.array([2.0, 0.3, 2.0]))


def different_places(count):
    """(count, 4, 4), from one end of a wall to the other."""
    eyes = np.linspace([0.3, 1.8, 0.3], [2.7, 2.2, 0.3], count)
    return np.stack([looking(eye, np.array([1.5, 0.5, 1.6])) for eye in eyes])


def require_same(images, others):
    assert images.keys() == others.keys()
    for name, image in images.items():
        np.testing.assert_array_equal(image, others[name], err_msg=name)


@pytest.fixture
def simulator(world):
    return Simulator(world, envs=ENVS, threads=1, seed=3, body_transforms=True)


@pytest.mark.parametrize("camera", ["head", "follow", "top", "hand"])
def test_a_camera_where_one_on_the_robot_is_draws_the_same_bytes(simulator, draw_actions, camera):
    mounted = Renderer(simulator, **IMAGES, camera=camera, fov_degrees=70, near=0.05)
    placed = Renderer(simulator, **IMAGES, world_from_camera=ROOM, fov_degrees=70)
    for _ in range(5):
        simulator.step(draw_actions(ENVS, 8))
        wanted = mounted.render()
        placed.place_camera(mounted.world_from_camera)
        require_same(placed.render(), wanted)
        # The way there and back changes no bit.
        assert placed.world_from_camera.tobytes() == mounted.world_from_camera.tobytes()
    made_there = Renderer(
        simulator, **IMAGES, world_from_camera=mounted.world_from_camera, fov_degrees=70
    )
    np.testing.assert_array_equal(made_there.world_from_camera, mounted.world_from_camera)
    require_same(made_there.render(), wanted)
    require_same(made_there.render(envs=[4, 1]), {n: one[[4, 1]] for n, one in wanted.items()})
    assert wanted["depth"].any()


def test_a_camera_looks_at_a_point(simulator):
    room = look_at(IN_CORNER, (2.0, 0.3, 2.0))
    assert room.shape == (4, 4) and room.dtype == np.float32
    np.testing.assert_allclose(room, ROOM, atol=1e-6)
    renderer = Renderer(simulator, **IMAGES, world_from_camera=room)
    np.testing.assert_array_equal(renderer.world_from_camera[0], room)
    # The point that it looks at is in the middle of its image.
    in_camera = np.linalg.inv(room) @ [2.0, 0.3, 2.0, 1]
    pixel = renderer.intrinsics @ (in_camera[:3] / in_camera[2])
    np.testing.assert_allclose(pixel[:2], [32, 24], atol=1e-3)


def test_several_cameras_look_at_points():
    eyes = np.linspace([0.3, 1.8, 0.3], [2.7, 2.2, 0.3], 3)
    at = np.array([1.5, 0.5, 1.6])
    wanted = np.stack([looking(eye, at) for eye in eyes])
    np.testing.assert_allclose(look_at(eyes, at), wanted, atol=1e-6)
    np.testing.assert_allclose(look_at(eyes, [at] * 3), wanted, atol=1e-6)
    back = np.stack([looking(at, eye) for eye in eyes])
    np.testing.assert_allclose(look_at(at, eyes), back, atol=1e-6)
    assert look_at(eyes[:1], at).shape == (1, 4, 4)
    assert look_at(np.empty((0, 3)), at).shape == (0, 4, 4)


def test_a_camera_that_looks_down_has_x_up_in_its_image():
    down = look_at((1, 2, 3), (1, 0, 3))
    np.testing.assert_array_equal(down[:3, 2], [0, -1, 0])
    np.testing.assert_array_equal(down[:3, 1], [-1, 0, 0])
    up = look_at((1, 2, 3), (1, 4, 3))
    np.testing.assert_array_equal(up[:3, 2], [0, 1, 0])
    assert np.linalg.det(up[:3, :3]) == 1


@pytest.mark.parametrize(
    ("eye", "target", "error", "message"),
    [
        (
            (1, 2, 3),
            (1, 2, 3),
            Error,
            r"look_at: found the eye \(1, 2, 3\) and the target \(1, 2, 3\)",
        ),
        ((1, 2, np.nan), (1, 2, 3), ValueError, "eye"),
        ((1, 2), (1, 2, 3), ValueError, r"eye has the shape \(2,\), expected \(n, 3\)"),
        (np.ones((2, 3)), np.zeros((3, 3)), ValueError, "found 2 points as eye and 3 as target"),
        ("here", (1, 2, 3), TypeError, "eye"),
    ],
)
def test_what_cannot_be_looked_at_is_refused(eye, target, error, message):
    with pytest.raises(error, match=message):
        look_at(eye, target)


def test_cameras_of_all_envs_stand_in_one_place_or_each_in_its_own(simulator):
    renderer = Renderer(simulator, **IMAGES, world_from_camera=ROOM)
    np.testing.assert_array_equal(
        renderer.world_from_camera, np.tile(ROOM.astype(np.float32), (ENVS, 1, 1))
    )
    of_room = renderer.render()
    places = different_places(ENVS).astype(np.float32)
    renderer.place_camera(places.tolist())
    # What was drawn was drawn from where it was.
    np.testing.assert_array_equal(renderer.world_from_camera[2], ROOM.astype(np.float32))
    of_places = renderer.render()
    np.testing.assert_array_equal(renderer.world_from_camera, places)
    for env in range(ENVS):
        renderer.place_camera(places[env])
        require_same(renderer.render(envs=[env]), {n: o[[env]] for n, o in of_places.items()})
    renderer.place_camera(ROOM)
    require_same(renderer.render(), of_room)
    assert not np.array_equal(of_room["depth"], of_places["depth"])


def test_the_camera_may_move_while_it_draws(simulator):
    renderer = Renderer(simulator, **IMAGES, world_from_camera=ROOM)
    wanted = renderer.render()
    for _ in range(5):
        renderer.begin_render()
        renderer.place_camera(different_places(ENVS))
        require_same(renderer.end_render(), wanted)
        renderer.place_camera(ROOM)


def test_boxes_of_objects_are_where_they_are_drawn(world, simulator, draw_actions):
    boxes = world.object_boxes
    np.testing.assert_array_equal(boxes.object_from_box.translation, world.object_centers)
    assert boxes.half_extents.shape == (2, 3) and boxes.corners.shape == (2, 8, 3)
    np.testing.assert_allclose(np.ptp(boxes.corners, axis=1), 2 * boxes.half_extents, atol=1e-6)
    large = {**IMAGES, "width": 320, "height": 240}
    eye = Renderer(simulator, **large, world_from_camera=ROOM, robot=False)
    whole = cut_off = 0
    for _ in range(10):
        simulator.step(draw_actions(ENVS, 8))
        seen, states = eye.render(), simulator.env_states()
        camera_from_world = np.linalg.inv(eye.world_from_camera[0].astype(float))
        for env, number in np.argwhere(states.object_kinds >= 0):
            world_from_object = states.objects.matrix[env, number].astype(float)
            corners = boxes.corners[states.object_kinds[env, number]]
            homogeneous = np.concatenate([corners, np.ones((8, 1))], axis=1)
            in_camera = (homogeneous @ (camera_from_world @ world_from_object).T)[:, :3]
            pixels = in_camera @ eye.intrinsics.T.astype(float)
            pixels = pixels[:, :2] / pixels[:, 2:]
            mask = seen["semantics"][env] == len(eye.semantic_names) + number
            if not mask.any():
                continue
            rows, columns = np.nonzero(mask)
            # The models of this home fill their boxes: a pixel is drawn where its middle is inside.
            found = np.array([columns.min(), rows.min(), columns.max() + 1, rows.max() + 1])
            wanted = np.concatenate([pixels.min(axis=0), pixels.max(axis=0)])
            inward = (found - wanted) * [1, 1, -1, -1]
            assert inward.min() > -0.51, (env, number, inward)
            depths = seen["depth"][env][mask]
            assert in_camera[:, 2].min() - 1e-3 < depths.min()
            assert depths.max() < in_camera[:, 2].max() + 1e-3
            is_whole = inward.max() < 2
            whole, cut_off = whole + is_whole, cut_off + (not is_whole)
    assert whole > 30 and cut_off < 0.3 * whole


def test_without_the_robot_all_images_see_through_it(simulator, draw_actions):
    for _ in range(5):
        simulator.step(draw_actions(ENVS, 8))
    options = {**IMAGES, "camera": "follow"}
    eye = Renderer(simulator, **options)
    seen, without = eye.render(), Renderer(simulator, **options, robot=False).render()
    of_scene = np.flatnonzero(eye.semantic_scenes == 0)
    is_robot = (seen["semantics"] > 0) & (seen["semantics"] < len(eye.semantic_names))
    is_robot &= ~np.isin(seen["semantics"], of_scene)
    assert 0.003 < is_robot.mean() < 0.9
    for name, image in seen.items():
        np.testing.assert_array_equal(image[~is_robot], without[name][~is_robot])
    assert np.all(without["depth"][is_robot] > seen["depth"][is_robot])
    is_object = without["semantics"] >= len(eye.semantic_names)
    assert np.all(is_object | np.isin(without["semantics"], of_scene))
    assert not np.array_equal(seen["rgb"][is_robot], without["rgb"][is_robot])


def test_ids_tell_the_scene_that_they_are_of(world, simulator):
    eye = Renderer(simulator, **IMAGES, world_from_camera=ROOM, robot=False)
    scenes = eye.semantic_scenes
    assert scenes.dtype == np.int32 and scenes.shape == (len(eye.semantic_names),)
    assert scenes[0] == -1 and set(scenes) == {-1, *range(len(world.scenes))}
    ids = eye.render()["semantics"]
    assert set(scenes[ids[ids < len(scenes)]]) == {0}


def test_a_camera_on_an_optical_frame_looks_along_its_z_when_it_is_turned(simulator):
    plain = Renderer(simulator, **IMAGES, camera="hand").world_from_camera
    turned = Renderer(simulator, **IMAGES, camera="hand", rpy_degrees=(90, -90, 0))
    # Of the link, in the order of a URDF: x where the plain camera looks, y to its left, and z up.
    x, y, z = plain[..., 2], -plain[..., 0], -plain[..., 1]
    wanted = np.stack([x, y, z, plain[..., 3]], axis=-1)
    np.testing.assert_allclose(turned.world_from_camera, wanted, atol=1e-6)


@pytest.mark.parametrize("halves", [1, 2])
@pytest.mark.parametrize("each", [False, True])
def test_cameras_of_a_vector_env_may_stand_in_the_world(world, draw_actions, halves, each):
    place = different_places(ENVS) if each else ROOM
    cameras = {
        "room": {**IMAGES, "world_from_camera": place, "robot": False},
        "head": IMAGES,
        "back": {**IMAGES, "camera": "follow"},
    }
    options = {"threads": 1, "seed": 11, "episode_steps": 9}
    env = VectorEnv(world, ENVS, images=cameras, halves=halves, **options)
    plain = Simulator(world, envs=ENVS, body_transforms=True, auto_reset=False, **options)
    eyes = {
        name: Renderer(plain, **({} if name == "room" else {"camera": name}) | camera)
        for name, camera in cameras.items()
    }
    ends = 0
    observations = env.reset()[0]
    for _ in range(30):
        for name, eye in eyes.items():
            for image, wanted in eye.render().items():
                np.testing.assert_array_equal(observations[f"{name}_{image}"], wanted)
        actions = draw_actions(ENVS, 8)
        observations, _, _, _, infos = env.step(actions)
        plain.step(actions)
        done = plain.dones
        for number in np.flatnonzero(done):
            found = infos["final_info"]["room_world_from_camera"][number]
            np.testing.assert_array_equal(found, eyes["room"].world_from_camera[number])
            ends += 1
        plain.reset(np.where(done, Simulator.NEXT_EPISODE, Simulator.STAYS).astype(np.int32))
    assert ends > 10


def test_a_single_camera_of_a_vector_env_may_stand_in_the_world(world):
    env = VectorEnv(world, 4, images={**IMAGES, "world_from_camera": ROOM}, threads=1)
    seen = env.reset()[0]
    wanted = Renderer(env.simulators[0], **IMAGES, world_from_camera=ROOM).render()
    require_same({name: seen[name] for name in wanted}, wanted)
    for halves in (1, 2):
        with pytest.raises(ValueError, match=r"of images has the shape \(2, 4, 4\), expected"):
            images = {**IMAGES, "world_from_camera": different_places(2)}
            VectorEnv(world, 4, images=images, halves=halves)


def test_placed_cameras_jitter_and_have_noise_of_their_places(world):
    simulator = Simulator(world, envs=64, threads=1, seed=3, body_transforms=True)
    off = {"camera_jitter": 0.02, "camera_jitter_degrees": 3, "camera_jitter_fov": 4}
    eye = Renderer(simulator, **IMAGES, **off, depth_noise=0.01, world_from_camera=ROOM)
    seen, places = eye.render(), eye.world_from_camera
    moved = np.linalg.inv(ROOM) @ places
    assert 0.015 < np.abs(moved[:, :3, 3]).max() < 0.02001
    assert len(np.unique(moved[:, 0, 3])) == 64 == len(np.unique(eye.intrinsics[:, 1, 1]))
    require_same(eye.render(), seen)
    elsewhere = looking(IN_CORNER + [0.5, 0, 0], np.array([2.0, 0.3, 2.0]))
    eye.place_camera(elsewhere)
    eye.render()
    others = np.linalg.inv(elsewhere) @ eye.world_from_camera
    assert not np.allclose(others, moved, atol=1e-3)
    eye.place_camera(np.tile(ROOM, (64, 1, 1)))
    require_same(eye.render(), seen)
    np.testing.assert_array_equal(eye.world_from_camera, places)


def with_part(row, column, value):
    matrix = ROOM.copy()
    matrix[row, column] = value
    return matrix


def with_number(env, matrix):
    matrices = different_places(ENVS)
    matrices[env] = matrix
    return matrices


SAID = "world_from_camera: "
NOT_PLACES = [
    (ROOM[:3], ValueError, "world_from_camera has the shape (3, 4), expected (4, 4) or (num_envs"),
    (np.zeros((0, 4, 4)), ValueError, "world_from_camera has the shape (0, 4, 4), expected (4, 4)"),
    (np.zeros(16), ValueError, "world_from_camera has the shape (16,), expected (4, 4)"),
    ("room", TypeError, "world_from_camera has the type <U4, expected numbers"),
    (ROOM.astype(complex), TypeError, "world_from_camera has the type complex128, expected"),
    (different_places(2), Error, SAID + "has 2 matrices, expected one for all envs, or one for"),
    (
        with_part(1, 3, np.nan),
        Error,
        SAID + "stands at (0.3, nan, 0.3) m, expected -10000 to 10000",
    ),
    (with_part(0, 3, 1e5), Error, SAID + "stands at (100000, 2.2, 0.3) m, expected -10000 to"),
    (with_part(0, 0, np.inf), Error, SAID + "has an axis of the length inf, expected 1"),
    (with_part(2, 2, np.nan), Error, SAID + "has an axis of the length nan, expected 1"),
    (ROOM @ np.diag([1.01, 1.01, 1.01, 1]), Error, SAID + "has an axis of the length 1.01"),
    (ROOM @ np.diag([-1, 1, 1, 1]), Error, SAID + "is mirrored, expected a rotation"),
    (np.linalg.inv(ROOM).T, Error, SAID + "has the last row ("),
    (np.zeros((4, 4)), Error, SAID + "has the last row (0, 0, 0, 0), expected (0, 0, 0, 1)"),
    (with_number(3, ROOM @ np.diag([1, 1, -1, 1])), Error, SAID + "number 3 is mirrored"),
]


@pytest.mark.parametrize("place, error, message", NOT_PLACES)
def test_places_that_are_none_are_refused(simulator, place, error, message):
    with pytest.raises(error) as caught:
        Renderer(simulator, **IMAGES, world_from_camera=place)
    assert message in str(caught.value)
    renderer = Renderer(simulator, **IMAGES, world_from_camera=ROOM)
    with pytest.raises(error) as caught:
        renderer.place_camera(place)
    assert message in str(caught.value)
    renderer.render()
    np.testing.assert_array_equal(renderer.world_from_camera[5], ROOM.astype(np.float32))


def test_axes_that_are_not_quite_at_right_angles_pass_as_they_are(simulator):
    sheared = np.eye(4)
    sheared[0, 1] = 0.002
    with pytest.raises(Error, match="axes whose dot product is 0.002, expected 0"):
        Renderer(simulator, **IMAGES, world_from_camera=sheared)
    rounded = ROOM.round(4).astype(np.float32)
    renderer = Renderer(simulator, **IMAGES, world_from_camera=rounded)
    renderer.render()
    np.testing.assert_array_equal(renderer.world_from_camera[0], rounded)


@pytest.mark.parametrize(
    "options, message",
    [
        ({"camera": "head"}, "camera: found head, expected none: world_from_camera says where"),
        ({"position": (0, 0, 1)}, "position: found a position, expected none: world_from_camera"),
        ({"rpy_degrees": (0, 9, 0)}, "rpy_degrees: found a turn, expected none: world_from_camera"),
    ],
)
def test_a_camera_is_either_on_the_robot_or_in_the_world(simulator, options, message):
    with pytest.raises(Error) as caught:
        Renderer(simulator, **IMAGES, **options, world_from_camera=ROOM)
    assert message in str(caught.value)
    assert caught.value.code is ErrorCode.INVALID_INPUT
    Renderer(simulator, **IMAGES, **options, world_from_camera=None)
    with pytest.raises(Error, match="place_camera: found the camera follow, which moves with"):
        Renderer(simulator, **IMAGES, camera="follow").place_camera(ROOM)


def test_demonstrations_say_where_their_camera_stands(world, tmp_path):
    images = {"width": 16, "height": 12, "world_from_camera": ROOM, "robot": False}
    env = VectorEnv(world, 2, images=images, threads=1)
    with DemonstrationWriter(tmp_path / "one", env, expert="mine"):
        camera = json.loads((tmp_path / "one" / INDEX).read_text())["camera"]
    assert camera["robot"] is False
    assert not {"camera", "position", "rpy_degrees"} & set(camera)
    again = VectorEnv(world, 2, images=camera, threads=1)
    require_same(again.reset()[0], env.reset()[0])
    images["world_from_camera"] = different_places(2)
    with pytest.raises(ValueError, match="a world_from_camera for each env, expected one for all"):
        DemonstrationWriter(tmp_path / "two", VectorEnv(world, 2, images=images), expert="mine")
