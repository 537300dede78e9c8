"""Options as keywords: those of the option table, with values of Python."""

import numpy as np
import pytest

from galactic import Error, Simulator
from galactic.sensors import ALWAYS, SENSORS


def test_options_are_those_of_the_option_table(world):
    simulator = Simulator(
        world,
        envs=3,
        threads=1,
        task="pick",
        no_distractors=True,
        safe_drop=np.bool_(True),
        target_up=np.bool_(False),
        slide="published",
        slide_step=0.25,
        episode_steps=np.int64(9),
        success_reward=np.float32(2.5),
        order=None,
        laser_beams=4,
        laser_heights=[0.25, (0.4, np.float32(0.75))],
        auto_reset=False,
    )
    options = simulator.options
    assert (options["auto_reset"], options["body_transforms"]) == (False, False)
    assert options["task"] == "pick"
    assert options["no_distractors"] is True
    assert (options["safe_drop"], options["target_up"]) == (True, False)
    assert (options["slide_direction"], options["slide_attempts"]) == ("towards-base", 5)
    assert (options["slide_step"], options["episode_steps"]) == (0.25, 9)
    assert (options["success_reward"], options["order"]) == (2.5, "shuffled")
    assert options["laser_heights"] == "0.25,0.4-0.75"
    assert (
        simulator.observation_parts["laser"].stop - simulator.observation_parts["laser"].start == 8
    )
    again = Simulator(world, threads=1, **options)
    assert again.options == options


def test_the_parts_of_observations_and_the_options_of_sensors_are_known(world):
    sensors = {name: 2 for name in ("near_objects", "laser_beams", "last_actions")}
    switches = {name: True for name in ("bump", "target_goal", "target_up", "geodesic")}
    simulator = Simulator(world, envs=1, threads=1, **sensors, **switches)
    assert list(simulator.observation_parts) == [*ALWAYS, *SENSORS]
    # They are the table's last ones; of memory alone, no part has a meaning.
    options = list(simulator.options)
    known = {"geodesic_megabytes"}.union(*SENSORS.values())
    assert set(options[options.index("bump") :]) == known


@pytest.mark.parametrize(
    "options, error, message",
    [
        ({"tusk": "pick"}, TypeError, "there is no option tusk; did you mean task?"),
        ({"no_distractor": True}, TypeError, "did you mean no_distractors?"),
        ({"tusk": None}, TypeError, "there is no option tusk; did you mean task?"),
        ({"xyzzy": 1}, TypeError, "there is no option xyzzy; the options are envs"),
        ({"task": "fly"}, Error, "task: is fly, expected rearrange, pick or none"),
        ({"envs": 0}, Error, "envs: is 0, expected 1 to 1048576"),
        ({"envs": -1}, Error, "envs: is -1, expected 1 to 1048576"),
        ({"envs": 2.5}, Error, "envs: is 2.5, expected 1 to 1048576"),
        ({"safe_drop": 1}, Error, "safe_drop: is 1, expected true or false"),
        ({"slide_step": float("nan")}, Error, "slide_step: is nan, expected 0 to 1000"),
        ({"slide_step": float("inf")}, Error, "slide_step: is inf, expected 0 to 1000"),
        ({"slide_step": [1]}, TypeError, "the option slide_step is a list"),
        (
            {"laser_heights": [0.25, (0.8, 0.4)]},
            Error,
            "laser_heights: is 0.25,0.8-0.4, expected robot",
        ),
        ({"laser_heights": []}, Error, "laser_heights: is , expected robot"),
        ({"laser_heights": [None]}, TypeError, "the option laser_heights is a NoneType, expected"),
        (
            {"motion_noise": np.zeros(8)},
            TypeError,
            "the option motion_noise is an array of shape (8,)",
        ),
        (
            {"motion_noise": np.zeros(1)},
            TypeError,
            "the option motion_noise is an array of shape (1,)",
        ),
        (
            {"episode_steps": np.full(2, 9)},
            TypeError,
            "the option episode_steps is an array of shape (2,)",
        ),
        (
            {"bump": np.zeros((2, 1), bool)},
            TypeError,
            "the option bump is an array of shape (2, 1)",
        ),
        (
            {"motion_noise": 1j},
            TypeError,
            "the option motion_noise is a complex, expected a number",
        ),
        ({"motion_noise": np.array(1j)}, TypeError, "the option motion_noise is a complex"),
        ({"motion_noise": np.array(None)}, TypeError, "the option motion_noise is a NoneType"),
        (
            {"laser_heights": np.array([0.8, np.nan])},
            Error,
            "laser_heights: is 0.8,nan, expected robot",
        ),
        ({"laser_heights": np.array(["a", "b"])}, Error, "laser_heights: is a,b, expected robot"),
        ({"threads": -1}, Error, "threads: is -1, expected 0 to 4096"),
        ({"rank": 2, "ranks": 2}, Error, "rank is 2, expected a number below ranks, which is 2"),
        ({"slide": "of"}, Error, "slide: is of, expected glide, published or off"),
    ],
)
def test_wrong_options_are_refused(world, options, error, message):
    with pytest.raises(error) as caught:
        Simulator(world, **options)
    assert message in str(caught.value)


def test_arrays_of_numpy_are_numbers_and_lists(world):
    simulator = Simulator(
        world,
        envs=2,
        threads=np.array(1),
        task=np.array("pick"),
        bump=np.array(True),
        motion_noise=np.array(0.25, np.float32),
        episode_steps=np.array(9),
        laser_beams=4,
        laser_heights=np.array([0.25, 0.5]),
    )
    options = simulator.options
    assert (options["task"], options["bump"], options["episode_steps"]) == ("pick", True, 9)
    assert (options["motion_noise"], options["laser_heights"]) == (0.25, "0.25,0.5")
    ranges = Simulator(
        world, threads=1, laser_beams=4, laser_heights=np.array([[0.25, 0.5], [0.5, 0.75]])
    )
    assert ranges.options["laser_heights"] == "0.25-0.5,0.5-0.75"
