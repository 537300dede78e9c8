"""What VectorEnv draws: images as observations, and pictures for people."""

import numpy as np
import pytest

from galactic import Renderer, Simulator, VectorEnv

ENVS = 24
OPTIONS = {"threads": 1, "seed": 11, "episode_steps": 35}
IMAGES = {"width": 24, "height": 16, "camera": "follow", "backend": "soft", "semantics": True}


@pytest.mark.parametrize("copy", [True, False])
@pytest.mark.parametrize("halves", [1, 2])
def test_images_show_what_the_state_says(world, draw_actions, halves, copy):
    env = VectorEnv(world, ENVS, images=IMAGES, halves=halves, copy=copy, **OPTIONS)
    plain = Simulator(world, envs=ENVS, body_transforms=True, auto_reset=False, **OPTIONS)
    eye = Renderer(plain, **IMAGES)
    ends = 0
    observations = env.reset()[0]
    for name, image in eye.render().items():
        np.testing.assert_array_equal(observations[name], image)
    for _ in range(80):
        actions = draw_actions(ENVS, 8)
        observations, _, _, _, infos = env.step(actions)
        plain.step(actions)
        last = {"state": plain.observations.copy(), **eye.render()}
        done = plain.dones.copy()
        plain.reset(np.where(done, Simulator.NEXT_EPISODE, Simulator.STAYS).astype(np.int32))
        now = {"state": plain.observations, **eye.render()}
        for name in ("state", "rgb", "depth", "semantics"):
            np.testing.assert_array_equal(observations[name], now[name])
            for number in np.flatnonzero(done):
                np.testing.assert_array_equal(infos["final_obs"][number][name], last[name][number])
        ends += int(done.sum())
    assert ends > 20
    assert len(np.unique(observations["rgb"])) > 5
    assert observations["depth"].max() > 0.5


@pytest.mark.parametrize("halves", [1, 2])
@pytest.mark.parametrize("prefix, images", [("", IMAGES), ("head_", {"head": IMAGES})])
def test_the_last_images_of_an_episode_come_with_their_cameras(
    world, draw_actions, halves, prefix, images
):
    env = VectorEnv(world, ENVS, images=images, halves=halves, **OPTIONS)
    plain = Simulator(world, envs=ENVS, body_transforms=True, auto_reset=False, **OPTIONS)
    eye = Renderer(plain, **IMAGES)
    name = f"{prefix}world_from_camera"
    ends, others = 0, 0
    env.reset()
    for _ in range(80):
        actions = draw_actions(ENVS, 8)
        infos = env.step(actions)[4]
        plain.step(actions)
        eye.render()
        last, done = eye.world_from_camera, plain.dones.copy()
        plain.reset(np.where(done, Simulator.NEXT_EPISODE, Simulator.STAYS).astype(np.int32))
        eye.render()
        drawing = [half["head"] if prefix else half for half in env.renderers]
        now = np.concatenate([one.world_from_camera for one in drawing])
        np.testing.assert_array_equal(now, eye.world_from_camera)
        if not done.any():
            assert infos == {}
            continue
        final = infos["final_info"]
        np.testing.assert_array_equal(final["_" + name], done)
        np.testing.assert_array_equal(final[name], np.where(done[:, None, None], last, 0))
        ends += int(done.sum())
        others += int((now[done] != last[done]).any(axis=(1, 2)).sum())
    assert ends > 20 and others == ends


@pytest.mark.parametrize("copy", [True, False])
@pytest.mark.parametrize("halves", [1, 2])
def test_each_of_several_cameras_sees_what_it_sees_alone(world, draw_actions, halves, copy):
    cameras = {
        "hand": {"width": 16, "height": 12, "backend": "soft", "near": 0.02},
        "behind": {**IMAGES, "camera": "follow"},
    }
    both = VectorEnv(world, ENVS, images=cameras, halves=halves, copy=copy, **OPTIONS)
    alone = {
        name: VectorEnv(world, ENVS, images={"camera": name, **options}, **OPTIONS)
        for name, options in cameras.items()
    }
    assert [set(half) for half in both.renderers] == [set(cameras)] * halves
    names = {"state", "hand_rgb", "hand_depth", "behind_rgb", "behind_depth", "behind_semantics"}
    assert set(both.single_observation_space.spaces) == names
    assert both.single_observation_space["hand_rgb"].shape == (12, 16, 3)
    row = {name: both.buffers(1)[name][0] for name in names}
    ends = 0
    both.reset()
    for env in alone.values():
        env.reset()
    for _ in range(40):
        actions = draw_actions(ENVS, 8)
        seen, _, _, _, infos = both.step(actions, row)
        for camera, env in alone.items():
            wanted, _, _, _, last = env.step(actions)
            for name, image in wanted.items():
                full_name = name if name == "state" else f"{camera}_{name}"
                np.testing.assert_array_equal(seen[full_name], image)
                np.testing.assert_array_equal(row[full_name], image)
                for number in np.flatnonzero(infos.get("_final_obs", [])):
                    mine, theirs = infos["final_obs"][number], last["final_obs"][number]
                    np.testing.assert_array_equal(mine[full_name], theirs[name])
        if infos:
            ends += int(infos["_final_obs"].sum())
    assert ends >= ENVS


def test_pictures_are_drawn_for_those_who_ask(world):
    assert VectorEnv(world, 3, **OPTIONS).render() is None
    env = VectorEnv(world, 3, render_mode="rgb_array", **OPTIONS)
    frames = env.render()
    assert len(frames) == 3
    assert all(frame.shape == (240, 320, 3) and frame.dtype == np.uint8 for frame in frames)
    assert len(np.unique(frames[0])) > 5


def test_pictures_are_drawn_by_as_many_threads_as_asked_for(world, monkeypatch):
    made = []

    def renderer(simulator, **options):
        made.append(options["threads"])
        return Renderer(simulator, **options)

    options = {**OPTIONS, "threads": 2, "render_mode": "rgb_array"}
    envs = [VectorEnv(world, 2, halves=halves, **options) for halves in (1, 2)]
    monkeypatch.setattr("galactic.vector_env.Renderer", renderer)
    for env in envs:
        env.render()
    assert made == [2, 2, 2]
