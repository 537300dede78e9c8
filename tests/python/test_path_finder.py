"""galactic.PathFinder and World.episode_table()."""

import copy
import pickle

import numpy as np
import pytest

import galactic


@pytest.fixture
def episodes(world):
    return world.episode_table()


@pytest.fixture
def finder(world, episodes):
    return galactic.PathFinder(world, 0, episodes.base[0, :3])


def test_episode_table(world, episodes):
    """What simulators begin with."""
    count = world.episodes
    assert episodes.scene.shape == episodes.target_kind.shape == (count,)
    assert (episodes.base.shape, episodes.goal.rotation.shape) == ((count, 4), (count, 4))
    simulator = galactic.Simulator(world, envs=1, task="none")
    for episode in set(range(count)) - set(simulator.skipped_episodes):
        simulator.reset([episode])
        state = simulator.env_state(0)
        assert state.scene == episodes.scene[episode]
        kind = world.objects[episodes.target_kind[episode]]
        assert state.object_names[state.target] == kind
        for found, wanted in (
            (state.objects[state.target], episodes.target),
            (state.goal, episodes.goal),
        ):
            np.testing.assert_allclose(found.translation, wanted.translation[episode], atol=1e-5)
        base = galactic.PlanningScene(simulator).base
        np.testing.assert_allclose(base[[0, 2]], episodes.base[episode, [0, 2]], atol=1e-5)
        apart = np.remainder(base[3] - episodes.base[episode, 3] + np.pi, 2 * np.pi) - np.pi
        assert abs(apart) < 1e-4


def test_the_map(finder, episodes):
    assert finder.navigable.shape == finder.heights.shape
    np.testing.assert_array_equal(finder.navigable, ~np.isnan(finder.heights))
    places = finder.places
    assert places.shape == (finder.navigable.sum(), 3) and places.dtype == np.float32
    assert finder.is_navigable(places).all()
    # Cells lie where origin and size say.
    rows, columns = np.nonzero(finder.navigable)
    x, z = finder.origin
    np.testing.assert_allclose(places[:, 0], x + (columns + 0.5) * finder.cell_size, atol=1e-4)
    np.testing.assert_allclose(places[:, 2], z + (rows + 0.5) * finder.cell_size, atol=1e-4)
    assert finder.is_navigable(episodes.base[:1, :3]).tolist() == [True]
    assert not finder.is_navigable(places + [0, 3, 0]).any()
    np.testing.assert_array_equal(finder.snap(places[::7] + [0.02, 0.1, -0.02]), places[::7])
    assert galactic.PathFinder.cell_size == pytest.approx(0.1)


def test_bases_may_have_a_yaw(world, finder, episodes):
    """As the table of episodes has them; of the yaw, nothing depends."""
    bases = np.hstack([finder.places, np.full((len(finder.places), 1), np.nan, np.float32)])
    points = finder.places
    fields = finder.fields(points[:2])
    which = np.arange(len(points)) % 2
    for ask in (fields.distances, fields.directions):
        np.testing.assert_array_equal(ask(bases, which), ask(points, which))
    np.testing.assert_array_equal(fields.path(bases[5], 1), fields.path(points[5], 1))
    np.testing.assert_array_equal(fields.path(list(bases[5])), fields.path(points[5]))
    assert finder.is_navigable(bases).all()
    fields.distances(episodes.base)
    assert len(galactic.PathFinder(world, 0, episodes.base[0]).places) == len(points)
    for wrong in (np.zeros((2, 5)), np.zeros((2, 2)), np.zeros(4)):
        with pytest.raises(ValueError, match="^bases has the shape .*, expected"):
            fields.distances(wrong)


def test_ways(finder):
    """Of a metric: nothing is shorter than the straight line, nor than a detour."""
    places = finder.places
    random = np.random.default_rng(4)
    goals = places[random.integers(len(places), size=20)]
    fields = finder.fields(goals, threads=2)
    assert len(fields) == 20
    np.testing.assert_array_equal(fields.goals, goals)
    for number in range(20):
        lengths = fields.distances(places, np.full(len(places), number))
        assert np.isfinite(lengths).all()
        straight = np.linalg.norm((places - goals[number])[:, [0, 2]], axis=1)
        assert (lengths > straight - 0.1).all()
        directions = fields.directions(places, np.full(len(places), number))
        far = lengths > 0.3
        np.testing.assert_allclose(np.linalg.norm(directions[far], axis=1), 1, atol=1e-3)
        assert (directions[:, 1] == 0).all()
        # A step that way is a step nearer.
        ahead = places + 0.05 * directions
        after = fields.distances(ahead, np.full(len(places), number))
        assert (after[far] < lengths[far]).mean() > 0.98
    # At their ends, they lead nowhere.
    assert not fields.distances(goals, np.arange(20)).any()
    assert not fields.directions(goals, np.arange(20)).any()
    between = np.array([fields.distances(goals, np.full(20, number)) for number in range(20)])
    np.testing.assert_allclose(between, between.T, atol=0.25)
    # All to the first, unless it is said to which.
    np.testing.assert_array_equal(
        fields.distances(places), fields.distances(places, [0] * len(places))
    )


def test_paths(finder):
    places = finder.places
    random = np.random.default_rng(5)
    for _ in range(30):
        start, goal = places[random.integers(len(places), size=2)]
        fields = finder.fields([goal])
        path = fields.path(start)
        np.testing.assert_array_equal(path[[0, -1]], [start, goal])
        lengths = np.linalg.norm(np.diff(path, axis=0)[:, [0, 2]], axis=1)
        assert lengths.sum() == pytest.approx(fields.distances([start])[0], rel=0.12, abs=0.2)
        shares = np.linspace(0, 1, 30)[:, np.newaxis]
        for one, other in zip(path, path[1:]):
            assert finder.is_navigable(one + shares * (other - one)).all()


def test_hands(world):
    """Ways to what hands reach are those of the sensor."""
    simulator = galactic.Simulator(world, envs=3, order="linear", task="none", geodesic=True)
    part = simulator.observation_parts["geodesic"]
    states = simulator.env_states()
    for env in range(3):
        base = states.world_from_root.translation[env]
        finder = galactic.PathFinder(world, states.scene[env], base)
        target = states.objects.translation[env, states.target[env]]
        way = finder.fields([target, states.goal.translation[env]], hand=True)
        sensed = simulator.observations[env, part][[0, 3]]
        found = way.distances([base, base], [0, 1])
        np.testing.assert_allclose(np.where(np.isinf(found), -1, found), sensed, atol=0.02)


@pytest.mark.parametrize("none", [[], np.zeros((0, 3)), np.zeros((0, 3), np.float32)], ids=repr)
@pytest.mark.parametrize("hand", [False, True])
def test_nothing_is_asked_of_nothing(finder, none, hand):
    """An empty list is an array of no points, and of no whole numbers."""
    blank, fields = finder.fields(none, hand=hand), finder.fields(finder.places[:2])
    assert len(blank) == 0
    results = [blank.goals, finder.snap(none)]
    for one in (blank, fields):
        for goals in (None, [], np.zeros(0, np.int32)):
            lengths = one.distances(none, goals)
            assert lengths.shape == (0,) and lengths.dtype == np.float32
            results.append(one.directions(none, goals))
    for result in results:
        assert result.shape == (0, 3) and result.dtype == np.float32
    assert finder.is_navigable(none).shape == (0,) and finder.is_navigable(none).dtype == np.bool_


def test_it_outlives_what_it_was_made_of(world_path):
    world = galactic.World(world_path)
    finder = galactic.PathFinder(world, 0, world.episode_table().base[0, :3])
    del world
    fields = finder.fields(finder.places[:2])
    del finder
    assert np.isfinite(fields.distances(fields.goals)).all()


@pytest.mark.parametrize(
    "call, error, message",
    [
        (lambda f, w: galactic.PathFinder(w, 9, [0, 0, 0]), galactic.Error, "scene"),
        (lambda f, w: galactic.PathFinder(w, 0, [0, 50, 0]), galactic.Error, "cannot stand at or near"),
        (lambda f, w: galactic.PathFinder(w, 0, [0, np.nan, 0]), ValueError, "start holds a number that is not"),
        (lambda f, w: galactic.PathFinder(w, 0, [0, 0]), ValueError, r"start has the shape \(2,\)"),
        (lambda f, w: galactic.PathFinder(w, 0, f.places[0], floor_rise=-1), galactic.Error, "floor_rise"),
        (lambda f, w: f.snap([0, 0, 0]), ValueError, r"points has the shape \(3,\), expected \(n, 3\)"),
        (lambda f, w: f.snap([["1", "2", "3"]]), TypeError, "points has the type <U1, expected numbers"),
        (lambda f, w: f.snap([[1, 2, 3j]]), TypeError, "points has the type complex128, expected numbers"),
        (lambda f, w: f.snap("here"), ValueError, r"points has the shape \(\), expected \(n, 3\)"),
        (lambda f, w: f.is_navigable([[0, np.inf, 0]]), ValueError, r"bases\[0\] holds a number that is not"),
        (lambda f, w: f.fields([[0, 50, 0]]), galactic.Error, r"goal 0, .* is not navigable; take what snap"),
        (lambda f, w: f.fields(f.places[:1], hand=2), TypeError, "hand"),
        (lambda f, w: f.fields(f.places[:2]).distances(f.places[:3], [0, 1, 2]), IndexError, r"goals\[2\] is 2, and there are 2"),
        (lambda f, w: f.fields(f.places[:2]).distances(f.places[:1], [-1]), IndexError, r"goals\[0\] is -1"),
        (lambda f, w: f.fields(f.places[:2]).distances(f.places[:1], [0.5]), TypeError, "goals"),
        (lambda f, w: f.fields(f.places[:2]).distances(f.places[:1], []), ValueError, r"goals has the shape \(0,\), expected \(1,\)"),
        (lambda f, w: f.snap(np.zeros((0, 2))), ValueError, r"points has the shape \(0, 2\), expected \(n, 3\)"),
        (lambda f, w: f.fields(f.places[:0]).distances(f.places[:1]), IndexError, "there is no goal"),
        (lambda f, w: f.fields(f.places[:2]).path(f.places[0], 2), IndexError, "there is no goal 2, there are 2"),
        (lambda f, w: f.fields(f.places[:1]).path(["1", "2", "3"]), TypeError, "base has the type <U1, expected numbers"),
        (lambda f, w: f.fields(f.places[:1]).path(["1", "2", "3", "4"]), TypeError, "base has the type <U1, expected numbers"),
        (lambda f, w: f.fields(f.places[:1]).path([0, 0, np.nan]), ValueError, "base holds a number that is not finite"),
    ],
)  # fmt: skip
def test_refusals(finder, world, call, error, message):
    with pytest.raises(error, match=message):
        call(finder, world)


def test_ways_from_very_far_are_asked_for_like_others(finder):
    fields = finder.fields(finder.places[:1])
    far = [3e38, 3e38, -3e38]
    assert fields.path(far).shape == (0, 3)
    assert fields.distances([far]) == np.inf


def test_no_copies(finder):
    for one in (finder, finder.fields(finder.places[:1])):
        for copied in (copy.copy, copy.deepcopy, pickle.dumps):
            with pytest.raises(TypeError):
                copied(one)
