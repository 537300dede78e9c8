"""PlanningScene: what it answers is what the simulator then does."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest

from galactic import CastEnd, Error, PlanningScene, ScriptedPolicy, Simulator

LIFT, FORWARD, ACTIONS = 0, 4, 8


@pytest.fixture
def simulator(world):
    return Simulator(world, envs=2, threads=1, order="linear", slide="off", episode_steps=0)


def test_hand_and_root_are_where_the_simulator_has_them(simulator, draw_actions):
    scene = PlanningScene(simulator)
    for _ in range(20):
        simulator.step(draw_actions(2, ACTIONS))
        for env in range(2):
            scene.update(env)
            state = simulator.env_state(env)
            for found, wanted in (
                (scene.world_from_grip(scene.base), state.world_from_grip),
                (scene.world_from_root(scene.base), state.world_from_root),
            ):
                assert found.translation == pytest.approx(wanted.translation, abs=1e-5)
            assert scene.is_free(scene.base)


def test_a_drive_is_refused_where_the_pose_is_not_free(simulator):
    scene = PlanningScene(simulator)
    actions = np.zeros((2, ACTIONS), np.float32)
    free = blocked = 0
    # Back to the wall, then ahead to the table.
    for way in [-1] * 15 + [1] * 15:
        actions[0, FORWARD] = way
        scene.update(0)
        x, y, z, yaw = scene.base
        before = scene.base
        simulator.step(actions)
        scene.update(0)
        if np.array_equal(scene.base, before):
            ahead = 0.1 * way * np.array([np.cos(yaw), 0, -np.sin(yaw), 0])
            assert not scene.is_free(before + ahead)
            blocked += 1
        else:
            assert scene.is_free(scene.base)
            assert scene.floor_at(x, z, y) == pytest.approx(y, abs=1e-3)
            free += 1
    assert free > 2 and blocked > 2


def test_joints_move_links_and_change_what_is_free(simulator):
    scene = PlanningScene(simulator)
    joints = simulator.env_state(0).joint_positions
    links = scene.root_from_links
    joints[LIFT] += 0.1
    scene.set_joints(joints)
    for before, after in list(zip(links, scene.root_from_links))[1:]:
        assert after.translation[1] - before.translation[1] == pytest.approx(0.1, abs=1e-5)
    assert scene.reach > 0


def test_matrices_of_poses_lead_from_link_to_world(simulator, draw_actions):
    for _ in range(10):
        simulator.step(draw_actions(2, ACTIONS))
    scene = PlanningScene(simulator)
    hand = scene.world_from_grip(scene.base)
    w, x, y, z = hand.rotation.astype(float)
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    assert hand.matrix.dtype == np.float32
    assert hand.matrix[:3, :3] == pytest.approx(np.array(rotation), abs=1e-6)
    assert hand.matrix[:3, 3] == pytest.approx(hand.translation)
    assert hand.matrix[3].tolist() == [0, 0, 0, 1]
    # The hand has the axes of its link.
    world_from_root = scene.world_from_root(scene.base).matrix
    links = [world_from_root @ link.matrix for link in scene.root_from_links]
    assert any(np.allclose(link[:3, :3], hand.matrix[:3, :3], atol=1e-5) for link in links[1:])


def test_objects_are_held_put_back_and_land(simulator):
    scene = PlanningScene(simulator)
    state = simulator.env_state(0)
    assert scene.grasped_at(scene.base) is None
    # The hand is over the target, wherever the base of such a hand would have to stand.
    grip = scene.world_from_grip([0, 0, 0, 0]).translation
    over = state.objects[state.target].translation - grip + [0, 0.05, 0]
    base = [*over, 0]
    assert scene.grasped_at(base) == state.target
    scene.hold(state.target, base)
    assert scene.is_holding
    assert scene.grasped_at(base) is None
    rest = scene.landing(base)
    assert rest.translation == pytest.approx(state.objects[state.target].translation, abs=5e-3)
    with pytest.raises(Error, match="hold: found object .* in the hand already"):
        scene.hold(0, base)
    scene.put_back()
    assert scene.grasped_at(base) == state.target
    with pytest.raises(Error, match="found no object in the hand that hold"):
        scene.put_back()


def test_what_was_just_grasped_is_free_until_it_was_free(world):
    simulator = Simulator(world, envs=8, threads=1, task="rearrange", order="linear")
    expert = ScriptedPolicy(simulator)
    scene = PlanningScene(simulator)
    grasps = 0
    for _ in range(80):
        held = simulator.env_states().held
        simulator.step(expert.act())
        for env in np.flatnonzero((held < 0) & (simulator.env_states().held >= 0)):
            scene.update(env)
            assert scene.is_holding and scene.is_free(scene.base)
            joints = simulator.env_state(env).joint_positions
            grasps += 1
    assert grasps >= 3
    # Sunk into the table, and as deep again after it was free.
    table = next(depth for depth in np.arange(0, 0.2, 0.01) if not free_below(scene, joints, depth))
    below = joints - [table, 0, 0, 0]
    scene.set_joints(below)
    scene.ignore_penetrating(scene.base)
    assert scene.is_free(scene.base)
    scene.set_joints(joints + [0.1, 0, 0, 0])
    scene.count_free(scene.base)
    scene.set_joints(below)
    assert not scene.is_free(scene.base)


def free_below(scene, joints, depth):
    scene.set_joints(joints - [depth, 0, 0, 0])
    return scene.is_free(scene.base)


def test_a_scene_takes_over_states_that_are_no_longer(simulator, draw_actions):
    before = simulator.env_state(1)
    for _ in range(5):
        simulator.step(draw_actions(2, ACTIONS))
    scene = PlanningScene(simulator, pickle.loads(pickle.dumps(before)))
    root = scene.world_from_root(scene.base)
    assert root.translation == pytest.approx(before.world_from_root.translation, abs=1e-5)
    scene.update(1)
    root = scene.world_from_root(scene.base)
    assert root.translation != pytest.approx(before.world_from_root.translation, abs=1e-5)
    scene.update(before)
    root = scene.world_from_root(scene.base)
    assert root.translation == pytest.approx(before.world_from_root.translation, abs=1e-5)
    for none in ("0", None, simulator.env_states()):
        with pytest.raises(TypeError):
            scene.update(none)


@pytest.fixture
def poses(world):
    """A function that draws so many poses of the robot of the small home: bases and joint positions."""
    generator = np.random.default_rng(20240612)

    def draw(count):
        bases = generator.uniform([0.2, 0, 0.2, -3], [2.8, 0, 2.8, 3], (count, 4))
        lower, upper = np.clip(world.limits, -3, 3).T
        return bases, generator.uniform(lower, upper, (count, len(world.positions)))

    return draw


def test_limits_are_those_of_the_positions(world):
    assert world.limits.dtype == np.float32
    assert world.limits == pytest.approx(
        np.array([[0, 0.8], [-np.inf, np.inf], [0, 0.6], [-1, 1]], np.float32)
    )
    for action in world.actions[:4]:
        for limit, found in zip((action.lower, action.upper), world.limits[action.position]):
            assert limit is None if np.isinf(found) else limit == pytest.approx(found)


def test_many_poses_are_answered_for_as_one(simulator, poses):
    scene = PlanningScene(simulator)
    bases, joints = poses(500)
    before = scene.world_from_grip(scene.base).translation
    free = scene.are_free(bases, joints)
    assert free.shape == (500,) and free.dtype == bool and 50 < free.sum() < 450
    links, grips = scene.world_from_links(bases, joints), scene.world_from_grips(bases, joints)
    touching = scene.touch_themselves(joints, margin=0.15)
    floors = scene.floors_at(bases + [0, 0.02, 0, 0])
    assert (scene.world_from_grip(scene.base).translation == before).all()
    assert (scene.are_free(bases, joints, threads=3) == free).all()
    assert links.translation.shape == (500, len(simulator.env_state(0).joint_positions) + 1, 3)
    for n in range(500):
        scene.set_joints(joints[n])
        assert scene.is_free(bases[n]) == free[n]
        assert scene.touches_itself(0.15) == touching[n]
        one = scene.world_from_grip(bases[n])
        assert grips.translation[n] == pytest.approx(one.translation, abs=1e-5)
        root = scene.world_from_root(bases[n]).matrix
        if n % 50 == 0:
            assert links.matrix[n] == pytest.approx(
                np.array([root @ link.matrix for link in scene.root_from_links]), abs=1e-5
            )
        x, _, z, _ = bases[n]
        floor = scene.floor_at(x, z, 0.02)
        assert np.isnan(floors[n]) if floor is None else floor == floors[n]
    assert 50 < np.isnan(floors).sum() < 450
    # One base, or one row of joints, for all.
    assert (scene.are_free(bases[0], joints) == scene.are_free([bases[0]] * 500, joints)).all()
    assert (scene.are_free(bases, joints[0]) == scene.are_free(bases, [joints[0]] * 500)).all()
    assert scene.are_free(bases[7], joints[7]).tolist() == [free[7]]
    assert scene.are_free(np.zeros((0, 4)), joints[0]).shape == (0,)


def test_the_links_of_a_whole_batch(played):
    states = played.env_states()
    scene = PlanningScene(played)
    bases = scene.bases_of(states)
    grips = scene.world_from_grips(bases, states.joint_positions)
    assert grips.translation == pytest.approx(states.world_from_grip.translation, abs=1e-5)
    links = scene.world_from_links(bases, states.joint_positions)
    assert links.translation[:, 0] == pytest.approx(states.world_from_root.translation, abs=1e-5)
    for env in range(played.num_envs):
        scene.update(env)
        assert scene.base == pytest.approx(bases[env], abs=1e-5)
    with pytest.raises(TypeError, match="states is a EnvState, expected galactic.EnvStates"):
        scene.bases_of(played.env_state(0))


def test_clearances_are_below_zero_where_a_pose_is_not_free(simulator, poses):
    scene = PlanningScene(simulator)
    bases, joints = poses(400)
    free = scene.are_free(bases, joints)
    found = scene.clearances(bases, joints, 0.3)
    spheres = len(found.link)
    assert spheres == 3 and found.link.tolist() == [0, 3, 4]
    assert found.distance.shape == found.nearest.shape == found.index.shape == (400, spheres)
    assert found.direction.shape == (400, spheres, 3)
    assert found.base_gradient.shape == (400, spheres, 4)
    assert found.joint_gradient.shape == (400, spheres, joints.shape[1])
    least = found.distance.min(axis=1)
    sure = np.abs(least) > 1e-4
    assert ((least > 0) == free)[sure].all() and sure.sum() > 390 and 50 < free.sum() < 350
    assert ((found.nearest == CastEnd.OBJECT) == (found.index >= 0)).all()
    assert (found.distance[found.nearest == CastEnd.NOTHING] == np.float32(0.3)).all()
    some = (np.abs(found.distance) < 0.299) & (np.abs(found.distance) > 1e-4)
    assert np.linalg.norm(found.direction[some], axis=1) == pytest.approx(1, abs=1e-4)
    again = scene.clearances(bases, joints, 0.3, threads=3)
    for field in dataclasses.fields(found):
        assert (getattr(again, field.name) == getattr(found, field.name)).all()
    assert (scene.clearances(bases[7], joints[7], 0.3).distance == found.distance[7:8]).all()
    assert scene.clearances(np.zeros((0, 4)), joints[0], 1).distance.shape == (0, spheres)


def test_clearances_change_as_their_gradients_say(simulator, poses):
    scene = PlanningScene(simulator)
    bases, joints = poses(300)
    found = scene.clearances(bases, joints, 0.3)
    step = 1e-3
    for number in (0, 2, 3, 4, 5, 6, 7):
        shift = step * np.eye(8)[number]
        after, before = (
            scene.clearances(bases + way * shift[:4], joints + way * shift[4:], 0.3).distance
            for way in (1, -1)
        )
        gradient = np.concatenate([found.base_gradient, found.joint_gradient], axis=2)[..., number]
        same = np.abs((after - before) / (2 * step) - gradient) < 0.02
        # Elsewhere, another thing is nearest.
        assert same.mean() > 0.95


def test_motions_are_free_where_all_of_their_places_are(simulator, poses):
    scene = PlanningScene(simulator)
    bases, joints = poses(6000)
    free = np.flatnonzero(scene.are_free(bases, joints))[:400]
    bases, joints = bases[free], joints[free]
    begin, end = slice(0, 400, 2), slice(1, 400, 2)
    motions = scene.motions_free(bases[begin], joints[begin], bases[end], joints[end])
    assert 5 < motions.sum() < 195
    turn = (bases[end, 3] - bases[begin, 3] + np.pi) % (2 * np.pi) - np.pi
    way = joints[end] - joints[begin]
    way[:, 1] = (way[:, 1] + np.pi) % (2 * np.pi) - np.pi  # a continuous joint
    all_free = np.ones(200, bool)
    for share in np.linspace(0, 1, 400):
        between = bases[begin] + share * (bases[end] - bases[begin])
        between[:, 3] = bases[begin, 3] + share * turn
        all_free &= scene.are_free(between, joints[begin] + share * way)
    # Corners are cut by less than a radius.
    assert (motions != all_free).sum() <= 4
    again = scene.motions_free(bases[begin], joints[begin], bases[end], joints[end], threads=2)
    assert (again == motions).all()
    # From one place in all directions.
    here = simulator.env_state(0).joint_positions
    ahead = scene.motions_free(scene.base, here, bases[end], here)
    assert ahead.shape == (200,) and 0 < ahead.sum() < 200


def test_arrays_that_make_no_sense_are_refused(simulator):
    scene = PlanningScene(simulator)
    bases, joints = np.zeros((3, 4)), np.zeros((3, 4))
    wrong = [
        ((bases[:, :3], joints), ValueError, "bases has the shape"),
        ((bases[:2], joints), ValueError, "bases has 2 rows, and joint_positions has 3"),
        ((bases, joints + np.array([[0], [np.nan], [0]])), ValueError, r"joint_positions\[1\]"),
        ((bases * 1j, joints), TypeError, "bases has the type complex128, expected numbers"),
        ((bases, "joints"), TypeError, "joint_positions"),
        ((bases, None), TypeError, "joint_positions"),
        ((bases[0, 0], joints), ValueError, "bases"),
    ]
    for arguments, error, message in wrong:
        for call in (scene.are_free, scene.world_from_links, scene.world_from_grips):
            with pytest.raises(error, match=message):
                call(*arguments)
    with pytest.raises(ValueError, match="bases has 3 rows, and to_bases has 2"):
        scene.motions_free(bases, joints, bases[:2], joints)
    with pytest.raises(TypeError, match="complex128"):
        scene.set_joints(joints[0] + 1j)
    with pytest.raises(ValueError, match="margin"):
        scene.touches_itself(float("nan"))
    for most in (0, -1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="most is .*, expected meters above 0"):
            scene.clearances(bases, joints, most)
    with pytest.raises(ValueError, match="bases has 2 rows, and joint_positions has 3"):
        scene.clearances(bases[:2], joints, 1)
    with pytest.raises(ValueError, match=r"bases\[0\] holds a number that is not finite"):
        scene.clearances(bases * np.nan, joints, 1)


def test_what_makes_no_sense_is_refused(simulator):
    scene = PlanningScene(simulator, env=1)
    for base in ([0, 0, 0], [0, 0, float("nan"), 0], "here", [0, 0, 0, float("inf")]):
        with pytest.raises((ValueError, TypeError)):
            scene.is_free(base)
    with pytest.raises(ValueError):
        scene.set_joints([0])
    with pytest.raises(ValueError):
        scene.floor_at(float("nan"), 0, 0)
    with pytest.raises(ValueError, match="joint_positions holds a number that is not finite"):
        scene.set_joints([float("nan")] * len(simulator.env_state(1).joint_positions))
    with pytest.raises(Error, match="found an empty hand"):
        scene.landing(scene.base)
    with pytest.raises(Error, match="found no object in the hand that hold"):
        scene.put_back()
    for wrong in (100, -1, np.int32(-1)):
        with pytest.raises(IndexError, match=f"there is no object {wrong}, the last is"):
            scene.hold(wrong, scene.base)
    with pytest.raises(IndexError):
        scene.update(2)
    with pytest.raises(TypeError):
        copy.copy(scene)


def test_the_scene_keeps_its_simulator(world):
    scene = PlanningScene(Simulator(world, envs=1, threads=1))
    assert scene.is_free(scene.base)
    scene.update(0)
