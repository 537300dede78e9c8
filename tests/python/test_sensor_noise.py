"""Noise of images and jitter of cameras: what they do, and what they depend on."""

import numpy as np
import pytest

from galactic import Error, Renderer, Simulator, VectorEnv

ENVS = 6
CAMERA = {"camera": "follow", "backend": "soft", "threads": 1, "width": 32, "height": 24}
NOISE = {"depth_noise": 0.02, "depth_dropout": 0.1, "color_noise": 6, "light_jitter": 0.4}
JITTER = {"camera_jitter": 0.03, "camera_jitter_degrees": 2}
ALL = {**CAMERA, **NOISE, **JITTER}


@pytest.fixture
def simulator(world):
    return Simulator(world, envs=ENVS, threads=1, body_transforms=True)


def drawn(env, images):
    """The noisy images among observations, and where they were drawn from."""
    cameras = np.concatenate([one.world_from_camera for one in env.renderers])
    return {name: images[name].copy() for name in ("rgb", "depth")} | {"cameras": cameras.copy()}


def assert_same(one, other):
    for name in one:
        np.testing.assert_array_equal(one[name], other[name], name)


def played(env, actions):
    """What the envs see at each step."""
    seen = [drawn(env, env.reset()[0])]
    return seen + [drawn(env, env.step(action)[0]) for action in actions]


def test_the_options_of_noise_are_listed():
    assert Renderer.NOISE_OPTIONS == (*NOISE, *JITTER, "camera_jitter_fov")
    assert set(Renderer.NOISE_OPTIONS) < set(Renderer.OPTIONS)


def test_without_noise_images_are_as_they_were(simulator):
    plain = Renderer(simulator, **CAMERA)
    off = Renderer(simulator, **CAMERA, **{name: 0 for name in {**NOISE, **JITTER}})
    assert_same(plain.render(), off.render())
    np.testing.assert_array_equal(plain.world_from_camera, off.world_from_camera)


def test_an_image_that_is_drawn_twice_is_the_same(simulator, draw_actions):
    renderer = Renderer(simulator, **ALL, semantics=True)
    first = renderer.render()
    assert_same(first, renderer.render())
    renderer.begin_render()
    assert_same(first, renderer.end_render())
    assert_same({name: all[[4, 1]] for name, all in first.items()}, renderer.render(envs=[4, 1]))
    # Of all the envs, that is; steps, episodes and seeds have noise of their own.
    assert len({one.tobytes() for one in first["depth"]}) == ENVS
    still = np.zeros((ENVS, simulator.action_count), np.float32)
    simulator.step(still)
    stepped = renderer.render()
    np.testing.assert_array_equal(stepped["semantics"], first["semantics"])
    assert (stepped["depth"] != first["depth"]).any(axis=(1, 2)).all()
    assert (stepped["rgb"] != first["rgb"]).any(axis=(1, 2, 3)).all()
    simulator.restart(1)
    assert_same(first, renderer.render())
    simulator.restart(2)
    assert (renderer.render()["depth"] != first["depth"]).any(axis=(1, 2)).all()


def test_an_episode_that_is_named_has_the_same_noise_in_any_env(simulator):
    renderer = Renderer(simulator, **ALL)

    def images_of(episodes, **options):
        simulator.reset(np.array(episodes, np.int32), **options)
        seen = {**renderer.render(), "cameras": renderer.world_from_camera}
        return {name: {one.tobytes() for one in images} for name, images in seen.items()}

    ones = images_of([1] * ENVS)
    assert all(len(found) == 1 for found in ones.values())
    assert ones == images_of([1] * ENVS)
    mixed = images_of([0, 1, 1, 0, 1, 0])
    assert all(len(found) == 2 and ones[name] < found for name, found in mixed.items())
    drawn = images_of([1] * ENVS, drawn=True)
    assert all(len(found) == ENVS for found in drawn.values())


def test_noise_depends_on_neither_batch_nor_halves_nor_threads(world, draw_actions):
    actions = [draw_actions(ENVS, 8) for _ in range(20)]
    options = {"images": ALL, "episode_steps": 7, "threads": 1}
    whole = played(VectorEnv(world, ENVS, **options), actions)
    threads = {"images": {**ALL, "threads": 3}, "episode_steps": 7, "threads": 2}
    for one, other in zip(whole, played(VectorEnv(world, ENVS, halves=2, **threads), actions)):
        assert_same(one, other)
    for rank in range(2):
        rows = slice(rank * 3, rank * 3 + 3)
        part = VectorEnv(world, 3, rank=rank, ranks=2, **options)
        for one, other in zip(whole, played(part, [action[rows] for action in actions])):
            assert_same({name: rows_of[rows] for name, rows_of in one.items()}, other)


def test_a_restored_state_goes_on_with_the_same_noise(world, draw_actions):
    options = {"images": ALL, "episode_steps": 7, "threads": 1}
    env = VectorEnv(world, ENVS, **options)
    env.reset()
    for _ in range(5):
        env.step(draw_actions(ENVS, 8))
    state = env.save_state()
    actions = [draw_actions(ENVS, 8) for _ in range(10)]
    before = drawn(env, env.observe())
    wanted = [drawn(env, env.step(action)[0]) for action in actions]
    other = VectorEnv(world, ENVS, **options)
    for again in (env, other):
        again.restore_state(state)
        assert_same(before, drawn(again, again.observe()))
        for one, action in zip(wanted, actions):
            assert_same(one, drawn(again, again.step(action)[0]))


def test_depth_noise_grows_with_the_square_of_depth(simulator):
    plain = Renderer(simulator, **CAMERA).render()["depth"]
    noisy = Renderer(simulator, **CAMERA, depth_noise=0.02)
    still = np.zeros((ENVS, simulator.action_count), np.float32)
    shares = []
    for _ in range(20):
        depth = noisy.render()["depth"]
        np.testing.assert_array_equal(depth == 0, plain == 0)
        seen = plain > 0
        assert depth[seen].min() >= 0.05
        shares.append((depth[seen] - plain[seen]) / (0.02 * plain[seen] ** 2))
        simulator.step(still)
    shares = np.concatenate(shares)
    assert len(shares) > 50_000
    assert abs(shares.mean()) < 0.02 and abs(shares.std() - 1) < 0.02
    assert np.abs(shares).max() < 3.6


def test_dropout_takes_the_depth_of_its_share_of_pixels(simulator):
    plain = Renderer(simulator, **CAMERA).render()["depth"]
    depth = Renderer(simulator, **CAMERA, depth_dropout=0.1).render()["depth"]
    seen = plain > 0
    assert abs((depth[seen] == 0).mean() - 0.1) < 0.02
    np.testing.assert_array_equal(depth[depth > 0], plain[depth > 0])


def test_color_noise_and_light_are_of_the_whole_episode(simulator):
    plain = Renderer(simulator, **CAMERA).render()["rgb"].astype(float)
    noisy = Renderer(simulator, **CAMERA, color_noise=6).render()["rgb"]
    inside = (plain > 30) & (plain < 225)
    assert abs((noisy - plain)[inside].std() - 6) < 0.2
    lit, hand = (
        Renderer(simulator, **{**CAMERA, "camera": camera}, light_jitter=0.4)
        for camera in ("follow", "hand")
    )
    first = lit.render()["rgb"]
    gains = np.array([np.median(a[b > 50] / b[b > 50]) for a, b in zip(first, plain)])
    assert ((gains > 0.59) & (gains < 1.41)).all() and np.ptp(gains) > 0.1
    simulator.step(np.zeros((ENVS, simulator.action_count), np.float32))
    np.testing.assert_array_equal(lit.render()["rgb"], first)
    # And for all cameras alike.
    by_hand = Renderer(simulator, **{**CAMERA, "camera": "hand"}).render()["rgb"].astype(float)
    np.testing.assert_allclose(
        hand.render()["rgb"][0],
        np.minimum(np.floor(by_hand[0] * gains[0] + 0.5), 255),
        atol=2,
    )


def test_world_from_camera_is_where_the_camera_is_with_jitter(world, draw_actions):
    env = VectorEnv(
        world, ENVS, images={**CAMERA, "camera": "head", **JITTER}, episode_steps=6, threads=1
    )
    env.reset()
    (simulator,), (renderer,) = env.simulators, env.renderers
    plain = Renderer(simulator, **{**CAMERA, "camera": "head"})

    def offsets():
        plain.render()
        return np.linalg.inv(plain.world_from_camera) @ renderer.world_from_camera

    before = offsets()
    assert np.abs(before[:, :3, 3]).max() <= 0.03 + 1e-5
    assert np.ptp(before[:, :3, 3], axis=0).min() > 0.01
    # Three turns of at most 2 degrees.
    cosines = (np.trace(before[:, :3, :3], axis1=1, axis2=2) - 1) / 2
    assert np.degrees(np.arccos(np.clip(cosines, -1, 1))).max() < 3.6
    all_ended = 0
    for _ in range(20):
        _, _, terminated, truncated, _ = env.step(draw_actions(ENVS, 8))
        after = offsets()
        changed = np.abs(after - before).max(axis=(1, 2)) > 1e-4
        np.testing.assert_array_equal(changed, terminated | truncated)
        all_ended += changed.sum()
        before = after
    assert ENVS <= all_ended < 10 * ENVS
    # A camera that is meant to be there sees the same.
    to_robot = np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])  # ahead, left, up
    position = to_robot @ before[0, :3, 3]
    turn = to_robot @ before[0, :3, :3] @ to_robot.T
    rpy = (
        np.arctan2(turn[2, 1], turn[2, 2]),
        -np.arcsin(turn[2, 0]),
        np.arctan2(turn[1, 0], turn[0, 0]),
    )
    options = {**CAMERA, "camera": "head", "position": position, "rpy_degrees": np.degrees(rpy)}
    placed = Renderer(simulator, **options)
    seen, wanted = renderer.render()["depth"][0], placed.render()["depth"][0]
    assert (np.abs(seen - wanted) < 1e-3).mean() > 0.99
    assert (np.abs(plain.render()["depth"][0] - wanted) < 1e-3).mean() < 0.9


def test_with_jitter_of_its_field_of_view_each_env_has_a_camera_of_its_own(simulator):
    options = {**CAMERA, "fov_degrees": 60, "color": None}
    plain = Renderer(simulator, **options)
    other = Renderer(simulator, **options, camera_jitter_fov=12)
    assert plain.intrinsics.shape == (3, 3)
    depth = other.render()["depth"]
    matrices = other.intrinsics
    assert matrices.shape == (ENVS, 3, 3)
    fovs = np.degrees(2 * np.arctan(CAMERA["height"] / 2 / matrices[:, 1, 1]))
    assert (np.abs(fovs - 60) <= 12 + 1e-3).all() and np.ptp(fovs) > 4
    np.testing.assert_array_equal(other.world_from_camera, plain.world_from_camera)
    plain_depth = plain.render()["depth"]
    for env, fov in enumerate(fovs):
        # A camera that is meant to be so sees the same.
        placed = Renderer(simulator, **{**options, "fov_degrees": fov}).render(envs=[env])["depth"]
        assert (np.abs(placed[0] - depth[env]) < 1e-3).mean() > 0.98
        assert abs(fov - 60) < 1 or (np.abs(plain_depth[env] - depth[env]) < 1e-3).mean() < 0.9
    simulator.step(np.zeros((ENVS, simulator.action_count), np.float32))
    other.render()
    np.testing.assert_array_equal(other.intrinsics, matrices)
    simulator.reset()
    other.render()
    assert (other.intrinsics[:, 1, 1] != matrices[:, 1, 1]).all()
    with pytest.raises(
        Error, match="camera_jitter_fov: found 60 degrees about a field of view of 60"
    ):
        Renderer(simulator, **options, camera_jitter_fov=(0, 60))


RANGES = {
    "depth_noise": (0.001, 0.05),
    "depth_dropout": "0.05-0.4",
    "color_noise": [1, 20],
    "light_jitter": np.array([0.1, 0.5]),
    "camera_jitter": (0.01, 0.05),
    "camera_jitter_degrees": "1-4",
}


def test_episodes_draw_their_noise_from_ranges(world, draw_actions):
    actions = [draw_actions(ENVS, 8) for _ in range(20)]
    images = {**CAMERA, **RANGES}
    options = {"images": images, "episode_steps": 7, "threads": 1}
    env = VectorEnv(world, ENVS, **options)
    env.reset()
    first = env.renderers[0].episode_noise()
    assert list(first) == list(NOISE)
    for name, (least, most) in {"depth_noise": (0.001, 0.05), "depth_dropout": (0.05, 0.4)}.items():
        assert len(set(first[name])) == ENVS
        assert (first[name] >= np.float32(least)).all() and (first[name] <= np.float32(most)).all()
    # What one env sees is what it would see with the numbers that its episode has drawn.
    (simulator,), jitter = env.simulators, {name: RANGES[name] for name in JITTER}
    seen = env.renderers[0].render()
    for number in range(ENVS):
        own = {name: drawn[number] for name, drawn in first.items()}
        alone = Renderer(simulator, **CAMERA, **own, **jitter).render(envs=[number])
        assert_same({name: rows[[number]] for name, rows in seen.items()}, alone)
    env.step(actions[0])
    np.testing.assert_array_equal(
        env.renderers[0].episode_noise()["color_noise"], first["color_noise"]
    )
    # Nothing else plays a part: threads, halves, other envs.
    env = VectorEnv(world, ENVS, **options)
    whole = played(env, actions)
    assert (env.renderers[0].episode_noise()["depth_noise"] != first["depth_noise"]).all()
    threads = {"images": {**images, "threads": 3}, "episode_steps": 7, "threads": 2}
    for one, other in zip(whole, played(VectorEnv(world, ENVS, halves=2, **threads), actions)):
        assert_same(one, other)
    part = VectorEnv(world, 3, rank=1, ranks=2, **options)
    for one, other in zip(whole, played(part, [action[3:] for action in actions])):
        assert_same({name: rows[3:] for name, rows in one.items()}, other)


def test_a_range_of_noise_has_to_be_one(simulator):
    wanted = "expected 0 to 1, or a range from 0 to 1 such as 0.1-0.3"
    for value in ((0.3, 0.1), (-0.1, 0.1), (0.1, 1.5), (np.nan, 0.1), "0.3-0.1", "0.1-", "", "a-b"):
        with pytest.raises(Error, match=f"depth_noise: is .*{wanted}"):
            Renderer(simulator, **CAMERA, depth_noise=value)
    for value in ((0.1, 0.2, 0.3), (0.1,), [], ("a", 0.1), None, {}):
        with pytest.raises(Error, match="depth_noise: is .*, expected a number"):
            Renderer(simulator, **CAMERA, depth_noise=value)


def test_cameras_in_different_places_have_noise_of_their_own(world):
    eyes = {
        "left": {**CAMERA, "camera": "hand", **NOISE, **JITTER},
        "again": {**CAMERA, "camera": "hand", **NOISE, **JITTER},
        "right": {**CAMERA, "camera": "hand", "position": (0, 1e-4, 0), **NOISE, **JITTER},
    }
    env = VectorEnv(world, 2, images=eyes, threads=1)
    seen = env.reset()[0]
    np.testing.assert_array_equal(seen["left_depth"], seen["again_depth"])
    np.testing.assert_array_equal(seen["left_rgb"], seen["again_rgb"])
    left, right = (env.renderers[0][name].world_from_camera for name in ("left", "right"))
    assert np.abs(left - right).max() > 1e-3
    assert (seen["left_depth"] != seen["right_depth"]).mean() > 0.1


@pytest.mark.parametrize(
    "options, message",
    [
        ({"depth_noise": -1}, "depth_noise: is -1, expected 0 to 1"),
        ({"depth_noise": np.nan}, "depth_noise: is nan, expected 0 to 1"),
        ({"depth_dropout": 1.5}, "depth_dropout: is 1.5, expected 0 to 1"),
        ({"color_noise": 256}, "color_noise: is 256, expected 0 to 255"),
        ({"light_jitter": "much"}, "light_jitter: is 'much', expected 0 to 1, or a range"),
        ({"camera_jitter": 2}, "camera_jitter: is 2, expected 0 to 1"),
        ({"camera_jitter_fov": 91}, "camera_jitter_fov: is 91, expected 0 to 90"),
        ({"camera_jitter_degrees": 200}, "camera_jitter_degrees: is 200, expected 0 to 180"),
        ({"depth": False, "depth_noise": 0.1}, "found noise or dropout of depth, and no depth"),
        ({"color": None, "light_jitter": 0.1}, "found noise or jitter of colors, and no color"),
    ],
)
def test_noise_that_cannot_be_is_refused(world, simulator, options, message):
    with pytest.raises(Error, match=message):
        Renderer(simulator, **CAMERA, **options)
    with pytest.raises(Error, match=message):
        VectorEnv(world, 2, images={**CAMERA, **options})


def test_noise_is_no_option_of_a_simulator_nor_of_images_on_a_device(world, simulator):
    with pytest.raises(TypeError, match="images={'depth_noise': 0.1}"):
        VectorEnv(world, 2, depth_noise=0.1)
    with pytest.raises(TypeError, match="no option depth_nose; did you mean depth_noise"):
        Renderer(simulator, **CAMERA, depth_nose=0.1)
    renderer = Renderer(simulator, **CAMERA, depth_noise=0.1)
    with pytest.raises(Error, match="found noise of images, which is added in memory of the"):
        renderer.render_to_device()
