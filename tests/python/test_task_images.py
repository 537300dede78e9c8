"""Cameras of tasks of one's own: galactic.Task.images."""

import numpy as np
import pytest

from galactic import Error, Outcome, Renderer, Simulator, Task, VectorEnv
from tasks import ACTIONS, drawing

ENVS = 12
EYE = {"width": 16, "height": 12, "camera": "follow", "backend": "soft", "semantics": True}
SIMULATION = {"threads": 1, "seed": 11}


class Sees(Task):
    """Pays a number that follows from its images, and keeps what it saw at which moment."""

    images = EYE
    options = {"episode_steps": 9}
    parts = {"nearest": 1, "first": 1}
    measures = ("last",)

    def prepare(self, envs):
        self.memory = {"first": np.zeros(envs.num_envs)}

    def begin(self, envs, which):
        self.memory["first"][which] = brightness(envs.images)[which]

    def step(self, envs):
        return Outcome(brightness(envs.images), failures=envs.uniform("end")[:, 0] < 0.1)

    def measure(self, envs, which):
        return {"last": brightness(envs.images)[which]}

    def observe(self, envs):
        nearest = envs.images["depth"].reshape(envs.num_envs, -1).min(axis=1, keepdims=True)
        return {"nearest": nearest, "first": self.memory["first"][:, np.newaxis]}


def brightness(images):
    """One number of each env's color image."""
    return images["rgb"].mean(axis=(1, 2, 3), dtype=np.float64)


def test_images_are_those_of_the_moment(world):
    """In step() and measure() what an episode ends with, in begin() and observe() what the next begins with: as
    a renderer draws them in a simulator that is stepped alike."""
    env = VectorEnv(world, ENVS, task=Sees, observation="dict", **SIMULATION)
    plain = Simulator(
        world,
        envs=ENVS,
        task="none",
        episode_steps=9,
        body_transforms=True,
        auto_reset=False,
        **SIMULATION,
    )
    eye = Renderer(plain, **EYE)
    seen, draw = env.reset()[0], drawing()
    first = brightness(eye.render())
    np.testing.assert_allclose(seen["first"][:, 0], first, rtol=1e-6)
    ends = 0
    for _ in range(40):
        actions = draw(ENVS, ACTIONS)
        seen, rewards, terminations, truncations, infos = env.step(actions)
        plain.step(actions)
        ended = terminations | truncations
        last = eye.render()
        np.testing.assert_allclose(rewards, brightness(last), rtol=1e-6)
        for row in np.flatnonzero(ended):
            final = infos["final_obs"][row]
            assert final["nearest"][0] == last["depth"][row].min()
            np.testing.assert_allclose(final["first"][0], first[row], rtol=1e-6)
            measured = infos["final_info"]["last"][row]
            np.testing.assert_allclose(measured, brightness(last)[row], rtol=1e-6)
        plain.reset(np.where(ended, Simulator.NEXT_EPISODE, Simulator.STAYS))
        now = eye.render()
        first[ended] = brightness(now)[ended]
        np.testing.assert_array_equal(seen["nearest"][:, 0], now["depth"].min(axis=(1, 2)))
        np.testing.assert_allclose(seen["first"][:, 0], first, rtol=1e-6)
        ends += int(ended.sum())
    assert ends > ENVS * 3
    assert len(np.unique(first)) > 1


def test_halves_see_the_same(world):
    def played(halves):
        env = VectorEnv(world, ENVS, task=Sees, halves=halves, **SIMULATION)
        observations, draw = [env.reset()[0]], drawing()
        for _ in range(20):
            observations.append(env.step(draw(ENVS, ACTIONS))[0])
        return np.stack(observations)

    np.testing.assert_array_equal(played(1), played(2))


def test_a_state_is_seen_anew(world):
    """Restored and chosen states, and resets of some, are drawn before somebody looks."""
    env = VectorEnv(world, ENVS, task=Sees, **SIMULATION)
    env.reset()
    draw = drawing()
    env.step(draw(ENVS, ACTIONS))
    state, rewards = env.save_state(), env.step(np.ones((ENVS, ACTIONS)))[1]
    before = env.observe()
    for _ in range(3):
        env.step(draw(ENVS, ACTIONS))
    env.restore_state(state)
    np.testing.assert_array_equal(env.step(np.ones((ENVS, ACTIONS)))[1], rewards)
    np.testing.assert_array_equal(env.observe(), before)
    states = env.env_states()
    env.step(draw(ENVS, ACTIONS))
    env.set_states(states)
    nearest = env.observation_parts["nearest"]
    np.testing.assert_array_equal(env.observe()[:, nearest], before[:, nearest])


def test_they_are_no_part_of_observations(world):
    """Neither does what the caller draws change what the task sees."""
    blind = VectorEnv(world, ENVS, task=Sees, **SIMULATION)
    other = {"width": 8, "height": 8, "backend": "soft"}
    seeing = VectorEnv(world, ENVS, task=Sees, images=other, **SIMULATION)
    assert blind.renderers == ()
    assert seeing.single_observation_space["rgb"].shape == (8, 8, 3)
    alike, draw = seeing.reset()[0]["state"], drawing()
    np.testing.assert_array_equal(blind.reset()[0], alike)
    actions = draw(ENVS, ACTIONS)
    one, two = blind.step(actions), seeing.step(actions)
    np.testing.assert_array_equal(one[0], two[0]["state"])
    np.testing.assert_array_equal(one[1], two[1])


def test_several_cameras(world):
    class Two(Sees):
        images = {"head": {"width": 8, "height": 8}, "over": {**EYE, "camera": "follow"}}
        parts = {}
        measures = ()

        def begin(self, envs, which):
            names.append(sorted(envs.images))
            assert set(envs.renderers) == {"head", "over"}

        def step(self, envs):
            depth = envs.images["over_depth"]
            with pytest.raises(ValueError, match="read-only"):
                depth[:] = 0
            return Outcome(depth.max(axis=(1, 2)))

    names = []
    env = VectorEnv(world, ENVS, task=Two, **SIMULATION)
    env.reset()
    assert (env.step(np.zeros((ENVS, ACTIONS)))[1] > 0.1).all()
    assert names[0] == ["head_depth", "head_rgb", "over_depth", "over_rgb", "over_semantics"]


@pytest.mark.parametrize(
    "images, message",
    [
        (7, "Wrong.images is 7, expected options of galactic.Renderer"),
        ({"hand": {}, "width": 3}, r"Wrong.images\['width'\] is 3, expected options, as the other"),
        ({"a b": {}}, "a camera of Wrong.images is 'a b', expected a name, such as hand"),
        ({"width": 0}, "width"),
        ({"camera": "nose"}, "nose"),
        ({"colour": "rgb"}, "colour"),
    ],
)
def test_wrong_cameras(world, images, message):
    class Wrong(Sees):
        pass

    Wrong.images = images
    with pytest.raises((ValueError, TypeError, Error), match=message):
        VectorEnv(world, 2, task=Wrong)
