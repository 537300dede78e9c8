"""What VectorEnv refuses, before anything happens: second threads, copies, actions that are no numbers,
places that lie on each other. And what is left of it when it is closed."""

import copy
import gc
import pickle
import sys
import warnings
import weakref

import numpy as np
import pytest

from galactic import VectorEnv, World

ENVS = 24
OPTIONS = {"threads": 1, "seed": 11, "episode_steps": 5}
IMAGES = {"width": 16, "height": 16, "backend": "soft"}


@pytest.fixture
def often_interrupted():
    """One thread often comes while another is at work."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    yield
    sys.setswitchinterval(before)


@pytest.mark.parametrize("halves", [1, 2])
@pytest.mark.parametrize("images", [None, IMAGES])
def test_a_second_thread_is_refused_before_any_env_steps(
    world, refused_at_once, often_interrupted, images, halves
):
    env = VectorEnv(world, ENVS, images=images, halves=halves, task="pick", **OPTIONS)
    env.reset()
    actions = np.zeros((ENVS, 8), np.float32)
    lengths: set[int] = set()

    def step():
        infos = env.step(actions)[4]
        if infos:
            lengths.update(infos["episode"]["l"][infos["_episode"]].tolist())

    times = 100
    refusals = refused_at_once(step, step, step, times=times)
    done = 3 * times - len(refusals)
    # Steps without images may be over before another thread comes.
    assert done > 0 and (refusals or not images)
    assert all("another thread is using this" in one or "is under way" in one for one in refusals)
    # Those that were refused have done no part of a step.
    assert sum(one.statistics()["steps"] for one in env.simulators) == ENVS * done
    assert lengths == {5}


def test_a_second_thread_cannot_look_while_another_steps(world, refused_at_once, often_interrupted):
    env = VectorEnv(world, ENVS, images=IMAGES, **OPTIONS)
    env.reset()
    actions = np.zeros((ENVS, 8), np.float32)
    refusals = refused_at_once(lambda: env.step(actions), env.observe, env.save_state, times=100)
    assert (
        refusals
        and {
            one for one in refusals if not one.startswith("another thread is using this galactic.")
        }
        == set()
    )


def test_an_env_cannot_be_copied(world):
    env = VectorEnv(world, 2, threads=1)
    for make in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(TypeError, match="VectorEnv cannot be pickled or copied: make one in"):
            make(env)
    env.reset()


def test_actions_that_are_no_real_numbers_are_refused(world):
    box, paper = (VectorEnv(world, 2, threads=1, actions=kind) for kind in ("box", "paper"))
    right = {"continuous": np.zeros((2, 6)), "discrete": np.zeros((2, 2))}
    for wrong, name in ((1j, "complex128"), ("1", "<U1"), (b"1", r"\|S1")):
        with pytest.raises(TypeError, match=f"^actions has the type {name}, expected numbers"):
            box.step(np.full((2, 8), wrong))
        with pytest.raises(TypeError, match=f"^discrete has the type {name}, expected numbers"):
            paper.step({**right, "discrete": np.full((2, 2), wrong)})
    for wrong, shown in (("1", "'1'"), (None, "None"), (1j, "1j"), ([0], r"\[0\]")):
        mixed = np.zeros((2, 8), object)
        mixed[1, 7] = wrong
        with pytest.raises(TypeError, match=f"^actions has {shown}, expected numbers, such as"):
            box.step(mixed)
        for name, rows in (("continuous", mixed[:, 2:]), ("discrete", mixed[:, 6:])):
            with pytest.raises(TypeError, match=f"^{name} has {shown}, expected numbers, such as"):
                paper.step({**right, name: rows})
    for wrong in (0.7, -0.5, np.nan, np.inf):
        discrete = np.array([[0, 1], [1, wrong]])
        with pytest.raises(TypeError, match=f"^discrete has {wrong}, expected whole numbers: 0 or"):
            paper.step({**right, "discrete": discrete})
    for wrong in (2, 7, -1):
        for kind in (np.int64, np.float32, object):
            discrete = np.array([[0, 1], [1, wrong]], kind)
            with pytest.raises(ValueError, match=f"^discrete has {wrong}, expected 0 or 1"):
                paper.step({**right, "discrete": discrete})
    for env in (box, paper):
        assert env.simulators[0].statistics()["steps"] == 0
    for kind in (np.float32, np.int64, np.bool_, object):
        paper.step({**right, "discrete": np.ones((2, 2), kind)})
    mixed = np.zeros((2, 8), object)
    mixed[0, :4] = (1, 0.5, np.float32(0.25), np.bool_(True))
    box.step(mixed)
    for kind in (np.float64, np.int32, np.bool_, object):
        box.step(np.zeros((2, 8), kind))
    box.step([[0] * 8] * 2)


def test_actions_that_32_bits_do_not_hold_are_as_far_as_actions_go(world):
    far, one = (VectorEnv(world, 2, threads=1, task="none") for _ in range(2))
    actions = np.zeros((2, 8))
    actions[0, 0], actions[1, 1] = 1e300, -1e300
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = far.step(actions)[0]
    np.testing.assert_array_equal(found, one.step(np.clip(actions, -1, 1))[0])


def test_two_results_cannot_land_in_one_place(world):
    images = {"hand": {**IMAGES, "camera": "follow"}, "head": {**IMAGES, "camera": "top"}}
    env = VectorEnv(world, 2, threads=1, images=images)
    env.reset()
    actions = np.zeros((2, 8), np.float32)
    place = np.zeros((2, 16, 16, 3), np.uint8)
    for send in (env.step, env.send):
        with pytest.raises(ValueError, match="hand_rgb and head_rgb share memory; give each"):
            send(actions, out={"hand_rgb": place, "head_rgb": place})
    both = np.zeros((3, 16, 16, 3), np.uint8)
    with pytest.raises(ValueError, match="hand_rgb and head_rgb share memory"):
        env.observe({"head_rgb": both[1:], "hand_rgb": both[:2]})
    env.step(actions, out={"hand_rgb": place, "head_rgb": place.copy()})


def test_episodes_are_reported_with_their_seconds_in_dictionaries_of_their_own(world):
    env = VectorEnv(world, ENVS, task="none", **OPTIONS)
    env.reset()
    actions = np.zeros((ENVS, 8), np.float32)
    for _ in range(5):
        infos = env.step(actions)[4]
    episode, final = infos["episode"], infos["final_info"]["episode"]
    assert set(episode) == {"r", "_r", "l", "_l", "t", "_t"}
    assert set(final) == {"r", "_r", "l", "_l"}
    assert episode["t"].shape == (ENVS,) and (episode["t"] > 0).all() and episode["_t"].all()
    episode["l"][:] = 0
    assert (final["l"] == 5).all()
    # Of one episode, not of all until then.
    mask = np.arange(ENVS) < 4
    env.reset(options={"reset_mask": mask})
    for _ in range(5):
        infos = env.step(actions)[4]
    seconds = infos["episode"]["t"]
    assert (seconds > 0).all() and seconds[mask].max() < seconds[~mask].min()


@pytest.mark.parametrize("copies", [True, False])
@pytest.mark.parametrize("halves", [1, 2])
def test_a_closed_env_holds_nothing_and_what_it_gave_stays(world_path, halves, copies):
    world = World(world_path)
    env = VectorEnv(
        world, ENVS, halves=halves, images=IMAGES, copy=copies, render_mode="rgb_array", **OPTIONS
    )
    seen, _ = env.reset()
    env.render()
    kept = env.simulators[0].observations
    wanted = {name: rows.copy() for name, rows in seen.items()}
    kept_wanted = kept.copy()
    held = [weakref.ref(part) for part in env._parts]
    envs = ENVS // halves
    env.send(np.zeros((envs, 8), np.float32), halves - 1)
    env.close()
    gc.collect()
    assert [one() for one in held] == [None] * halves
    assert env.recv(halves - 1)[1].shape == (envs,)
    if copies:
        for name, rows in wanted.items():
            np.testing.assert_array_equal(seen[name], rows)
    if halves == 2:  # The first did not step.
        np.testing.assert_array_equal(kept, kept_wanted)
    assert np.isfinite(kept).all()
    calls = [
        lambda: env.world,
        lambda: env.simulators,
        lambda: env.renderers,
        lambda: env.buffers(2),
        env.env_states,
        lambda: env.restore_state(b""),
    ]
    for call in calls:
        with pytest.raises(RuntimeError, match="this env is closed; make another one"):
            call()
    assert (env.halves, env.num_envs, env.closed) == (halves, ENVS, True)
    env.close()


def test_closing_frees_the_memory_of_images(world):
    def resident() -> float:
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * 4096 / 1e6

    before = resident()
    env = VectorEnv(world, 256, copy=False, images={**IMAGES, "width": 200, "height": 200})
    env.reset()
    full = resident()
    # 256 images of 200 x 200 with three bytes and a float.
    assert full - before > 50
    env.close()
    gc.collect()
    assert resident() - before < 0.5 * (full - before)
