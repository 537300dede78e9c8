"""galactic.RayCaster: rays and swept spheres through the small home."""

import copy
import pickle

import numpy as np
import pytest

import galactic
from galactic import CastEnd

DOWN = [0, -1, 0]


@pytest.fixture
def simulator(world):
    return galactic.Simulator(world, envs=2, threads=1, order="linear", task="none")


@pytest.fixture
def caster(world):
    return galactic.RayCaster(world, 0)


def test_rays_meet_floor_table_and_the_end_of_the_grid(world, caster):
    """A room of 3 x 3 m with a table of 1 x 1 x 0.7 m in its middle."""
    origins = [[0.5, 1, 0.5], [1.5, 1, 1.5], [0.5, 0.3, 1.5], [0.5, 1, 0.5], [1.5, 0.3, 1.5]]
    directions = [DOWN, [0, -7, 0], [1, 0, 0], [1, 0, 0], DOWN]
    hits = caster.cast_rays(origins, directions)
    radius = world.radii[0]
    assert hits.end.tolist() == [CastEnd.SCENE] * 3 + [CastEnd.OUTSIDE, CastEnd.SCENE]
    assert (hits.distance.dtype, hits.end.dtype, hits.index.dtype) == (
        np.float32,
        np.uint8,
        np.int32,
    )
    # A cell is 3 cm wide, and judged by its column.
    wanted = [1 - radius, 0.3 - radius, 0.5 - radius, 2.5, 0]
    np.testing.assert_allclose(hits.distance, wanted, atol=0.016)
    assert (hits.index == -1).all()
    level = caster.sweep_spheres(0.12, [[0.5, 0.3, 1.5]], [[1, 0, 0]])
    assert level.distance[0] == pytest.approx(0.5 - 0.12, abs=0.016)


def test_directions_are_for_all_or_for_each(caster):
    origins = np.full((4, 3), 1, np.float32) - [0.5, 0, 0.5]
    each = caster.cast_rays(origins, [DOWN] * 4)
    for one in (DOWN, np.array(DOWN), np.array(DOWN, np.float64) * 3):
        np.testing.assert_array_equal(caster.cast_rays(origins, one).distance, each.distance)
    assert caster.cast_rays(np.zeros((0, 3)), DOWN).distance.shape == (0,)
    for wrong in ([0, -1], [0, 0, 0], [0, np.nan, 0], 1.0):
        with pytest.raises((ValueError, galactic.Error)):
            caster.cast_rays(origins, wrong)


def test_spheres_are_free_where_they_touch_nothing(world, simulator):
    generator = np.random.default_rng(4)
    centers = generator.uniform([-0.2, 0, -0.2], [3.2, 1.2, 3.2], (1000, 3))
    caster = galactic.RayCaster.of_env(simulator, robot=True)
    for radius in world.radii:
        free = caster.spheres_free(radius, centers)
        swept = caster.sweep_spheres(radius, centers, DOWN, lengths=0)
        assert free.dtype == bool and (free == (swept.end == CastEnd.NOTHING)).all()
        assert 100 < free.sum() < 900
        assert (caster.spheres_free(radius, centers, threads=2) == free).all()
    with pytest.raises(galactic.Error, match="found the radius 0.3 m"):
        caster.spheres_free(0.3, centers)
    with pytest.raises(ValueError, match="centers"):
        caster.spheres_free(radius, [[0, np.nan, 0]])


def test_lengths_are_for_all_or_for_each(caster):
    origins, directions = np.full((4, 3), 1, np.float32) - [0.5, 0, 0.5], np.tile(DOWN, (4, 1))
    for lengths in (0.25, [0.25] * 4, np.float64(0.25), np.full(4, 0.25), np.array(0.25)):
        hits = caster.cast_rays(origins, directions, lengths)
        assert hits.distance.tolist() == [0.25] * 4 and not hits.end.any()
    hits = caster.cast_rays(origins, directions, [0, 0.5, 2, np.inf])
    assert hits.end.tolist() == [CastEnd.NOTHING] * 2 + [CastEnd.SCENE] * 2
    assert hits.distance[:2].tolist() == [0, 0.5] and hits.distance[2] == hits.distance[3]


def test_objects_are_hit_where_they_are_now(world, simulator):
    for env in range(2):
        state = simulator.env_state(env)
        caster = galactic.RayCaster.of_env(simulator, env)
        middles = np.array([pose.translation for pose in state.objects]) + [0, 0.05, 0]
        above = middles + [0, 0.4, 0]
        hits = caster.cast_rays(above, np.tile(DOWN, (len(above), 1)))
        assert hits.index.tolist() == list(range(len(above)))
        assert (hits.end == CastEnd.OBJECT).all()
        np.testing.assert_allclose(hits.distance, 0.35, atol=1e-4)
        swept = caster.sweep_spheres(0.05, above, np.tile(DOWN, (len(above), 1)), threads=2)
        np.testing.assert_allclose(swept.distance, 0.3, atol=1e-4)
        # The scene alone has none of them.
        alone = galactic.RayCaster(world, state.scene)
        assert (alone.cast_rays(above, np.tile(DOWN, (len(above), 1))).end == CastEnd.SCENE).all()


def test_the_robot_is_seen_where_it_is_asked_for(world, simulator):
    base = simulator.env_state(0).world_from_root.translation
    above = [base + [0, 2, 0]]
    assert galactic.RayCaster.of_env(simulator).cast_rays(above, [DOWN]).end == CastEnd.SCENE
    hits = galactic.RayCaster.of_env(simulator, robot=True).cast_rays(above, [DOWN])
    assert hits.end == CastEnd.ROBOT and world.links[hits.index[0]] in world.links
    # It drives away, and the next caster knows.
    actions = np.zeros((2, len(world.actions)), np.float32)
    actions[:, [action.name for action in world.actions].index("forward")] = -1
    for _ in range(4):
        simulator.step(actions)
    moved = np.linalg.norm(simulator.env_state(0).world_from_root.translation - base)
    assert moved > 0.2
    later = galactic.RayCaster.of_env(simulator, robot=True).cast_rays(above, [DOWN])
    assert later.distance[0] != hits.distance[0]


def test_a_sweep_is_free_as_far_as_it_goes(world, caster):
    """Steps along each sweep: a sphere that begins anywhere on it is free there."""
    random = np.random.default_rng(6)
    origins = random.uniform([0.2, 0.2, 0.2], [2.8, 1.5, 2.8], (200, 3))
    directions = random.normal(size=(200, 3))
    hits = caster.sweep_spheres(0.05, origins, directions, 2)
    units = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    assert 20 < (hits.end == CastEnd.SCENE).sum() < 180
    for share in np.linspace(0, 0.999, 12):
        on_the_way = origins + share * hits.distance[:, np.newaxis] * units
        there = caster.sweep_spheres(0.05, on_the_way, directions, 0)
        assert (there.end == CastEnd.NOTHING)[hits.distance > 0].all()


@pytest.mark.parametrize("none", [[], np.zeros((0, 3)), np.zeros((0, 3), np.float32)], ids=repr)
def test_nothing_is_cast_of_nothing(caster, none):
    for hits in (caster.cast_rays(none, none), caster.sweep_spheres(0.05, none, none, [])):
        assert [one.shape for one in (hits.distance, hits.end, hits.index)] == [(0,)] * 3


def test_it_outlives_what_it_was_made_of(world_path):
    world = galactic.World(world_path)
    simulator = galactic.Simulator(world, envs=1)
    casters = galactic.RayCaster(world, 0), galactic.RayCaster.of_env(simulator)
    del world, simulator
    for caster in casters:
        assert caster.cast_rays([[0.5, 1, 0.5]], [DOWN]).end == CastEnd.SCENE


@pytest.mark.parametrize(
    "call, error, message",
    [
        (lambda w, c, s: galactic.RayCaster(w, 1), galactic.Error, "scene"),
        (lambda w, c, s: galactic.RayCaster.of_env(s, 2), IndexError, "2"),
        (lambda w, c, s: galactic.RayCaster.of_env(s, robot=2), TypeError, "robot"),
        (lambda w, c, s: c.cast_rays([[1, 1, np.nan]], [DOWN]), ValueError, r"origins\[0\] holds a number that is not"),
        (lambda w, c, s: c.cast_rays([[1, 1, 1]], [[np.inf, 0, 0]]), ValueError, r"directions\[0\] holds a number"),
        (lambda w, c, s: c.cast_rays([1, 1, 1], [DOWN]), ValueError, r"origins has the shape \(3,\), expected \(n, 3\)"),
        (lambda w, c, s: c.cast_rays([["1", "2", "3"]], [DOWN]), TypeError, "origins has the type <U1, expected numbers"),
        (lambda w, c, s: c.cast_rays([[1, 1, 1]], [[0, 0, 0]]), galactic.Error, r"directions\[0\] is zero"),
        (lambda w, c, s: c.cast_rays([[1, 1, 1]], [DOWN, DOWN]), galactic.Error, '"directions" has the length 2, expected 1'),
        (lambda w, c, s: c.cast_rays([[1, 1, 1]], [DOWN], [1, 2]), ValueError, r"lengths has the shape \(2,\), expected \(1,\)"),
        (lambda w, c, s: c.cast_rays([[1, 1, 1]], [DOWN], "far"), TypeError, "lengths"),
        (lambda w, c, s: c.cast_rays([[1, 1, 1]], [DOWN], None), TypeError, "lengths has the type object"),
        (lambda w, c, s: c.cast_rays([[1, 1, 1]], [DOWN], -1), galactic.Error, r"lengths\[0\] is -1, expected 0 or more"),
        (lambda w, c, s: c.cast_rays([[1, 1, 1]], [DOWN], np.nan), galactic.Error, r"lengths\[0\] is nan"),
        (lambda w, c, s: c.cast_rays([[1, 1, 1]], [DOWN], threads=-1), galactic.Error, "threads"),
        (lambda w, c, s: c.sweep_spheres(0.03, [[1, 1, 1]], [DOWN]), galactic.Error, "found the radius 0.03 m, .* 0.016, 0.05, 0.12"),
    ],
)  # fmt: skip
def test_refusals(world, caster, simulator, call, error, message):
    with pytest.raises(error, match=message):
        call(world, caster, simulator)


def test_a_step_under_way_is_awaited(world, simulator):
    actions = np.zeros((2, len(world.actions)), np.float32)
    simulator.begin_step(actions)
    with pytest.raises(RuntimeError):
        galactic.RayCaster.of_env(simulator)
    simulator.end_step()
    galactic.RayCaster.of_env(simulator)


def test_no_copies(caster):
    for copied in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(TypeError):
            copied(caster)


def test_casts_in_all_envs_are_those_in_each(world):
    """More threads than envs, and fewer."""
    simulator = galactic.Simulator(world, envs=5, threads=1, order="linear", task="none")
    random = np.random.default_rng(3)
    origins = random.uniform([0.1, 0.1, 0.1], [2.9, 1.5, 2.9], (5, 300, 3))
    directions = random.normal(size=(5, 300, 3))
    lengths = random.uniform(0, 3, (5, 300))
    for robot in (False, True):
        casters = [galactic.RayCaster.of_env(simulator, env, robot=robot) for env in range(5)]
        for threads in (1, 2, 0):
            options = {"robot": robot, "threads": threads}
            rays = galactic.RayCaster.cast_rays_in_envs(
                simulator, origins, directions, lengths, **options
            )
            sweeps = galactic.RayCaster.sweep_spheres_in_envs(
                simulator, 0.05, origins, directions, 2, **options
            )
            assert rays.distance.shape == rays.end.shape == sweeps.index.shape == (5, 300)
            for env, caster in enumerate(casters):
                lines = origins[env], directions[env]
                for found, wanted in (
                    (rays, caster.cast_rays(*lines, lengths[env])),
                    (sweeps, caster.sweep_spheres(0.05, *lines, 2)),
                ):
                    assert (found.distance[env] == wanted.distance).all()
                    assert (found.end[env] == wanted.end).all()
                    assert (found.index[env] == wanted.index).all()
        assert (rays.end == CastEnd.OBJECT).any()
        assert (rays.end == CastEnd.ROBOT).any() == robot


def test_lines_that_do_not_fit_the_envs_are_refused(simulator):
    def refusal(origins, directions, lengths=1):
        with pytest.raises(ValueError) as failure:
            galactic.RayCaster.cast_rays_in_envs(simulator, origins, directions, lengths)
        return str(failure.value)

    some = np.ones((2, 4, 3))
    assert refusal(some[0], some) == "origins has the shape (4, 3), expected (2, n, 3)"
    assert (
        refusal(np.ones((3, 4, 3)), some) == "origins has the shape (3, 4, 3), expected (2, n, 3)"
    )
    assert refusal(some, np.ones((2, 4, 2))) == (
        "directions has the shape (2, 4, 2), expected (2, n, 3)"
    )
    assert refusal(some, some, np.ones(4)) == "lengths has the shape (4,), expected (2, 4)"
    with pytest.raises(galactic.Error, match='"directions" has the length 6, expected 8'):
        galactic.RayCaster.cast_rays_in_envs(simulator, some, some[:, :3])
    wrong = some.copy()
    wrong[1, 3, 0] = np.nan
    assert refusal(wrong, some) == "origins[1, 3] holds a number that is not finite"
    empty = galactic.RayCaster.cast_rays_in_envs(simulator, some[:, :0], some[:, :0])
    assert empty.distance.shape == (2, 0)
