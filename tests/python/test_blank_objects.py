"""Objects of the compiled classes whose __init__() was not called: a TypeError wherever they are used."""

import pickle

import pytest

import galactic
from galactic import _core

BLANK = "an object of galactic is blank, as its __init__\\(\\) was not called"
CLASSES = [member for member in vars(_core).values() if type(member).__name__ == "pybind11_type"]
MOST_PARAMETERS = 5


def members(bound: type, kind: str) -> list[str]:
    """Of one's own, by the name of their type."""
    return [name for name, member in vars(bound).items() if type(member).__name__ == kind]


def test_there_are_classes():
    public = {one for one in vars(galactic).values() if type(one).__name__ == "pybind11_type"}
    assert galactic.World in public and public < set(CLASSES)


@pytest.mark.parametrize("bound", CLASSES, ids=lambda bound: bound.__name__)
def test_no_member_of_a_blank_object_can_be_used(bound):
    blank = bound.__new__(bound)
    for name in members(bound, "property"):
        with pytest.raises(TypeError, match=BLANK):
            getattr(blank, name)
    called = 0
    for name in members(bound, "instancemethod"):
        if name in ("__init__", "__setstate__", "__reduce_ex__"):
            continue
        refusals = []
        for count in range(MOST_PARAMETERS):
            with pytest.raises(TypeError) as refused:
                getattr(blank, name)(*[None] * count)
            refusals.append(str(refused.value))
        assert any(text.startswith("an object of galactic is blank") for text in refusals), name
        called += 1
    assert called > 0
    with pytest.raises(TypeError):
        pickle.dumps(blank)
    del blank


@pytest.mark.parametrize(
    "use",
    [
        lambda world, simulator: galactic.Simulator(world),
        lambda world, simulator: galactic.VectorEnv(world, 2),
        lambda world, simulator: galactic.PathFinder(world, 0, (0, 0, 0)),
        lambda world, simulator: galactic.Renderer(simulator),
        lambda world, simulator: galactic.PlanningScene(simulator),
        lambda world, simulator: galactic.RayCaster(world, 0),
        lambda world, simulator: galactic.RayCaster.of_env(simulator),
        lambda world, simulator: galactic.ScriptedPolicy(simulator),
        lambda world, simulator: _core.EpisodeTally(simulator),
    ],
)
def test_nothing_is_made_of_a_blank_object(use):
    world, simulator = (one.__new__(one) for one in (galactic.World, galactic.Simulator))
    with pytest.raises(TypeError, match=BLANK):
        use(world, simulator)


def test_a_subclass_calls_init_first(world_path):
    class Early(galactic.World):
        def __init__(self, path):
            self.robot_before = self.robot
            super().__init__(path)

    class Late(galactic.World):
        def __new__(cls, path):
            return super().__new__(cls)

        def __init__(self, path):
            super().__init__(path)
            self.robot_after = self.robot

    with pytest.raises(TypeError, match=BLANK):
        Early(world_path)
    assert Late(world_path).robot_after == galactic.World(world_path).robot


def test_a_blank_object_can_still_be_made_whole(world_path):
    world = galactic.World.__new__(galactic.World)
    with pytest.raises(TypeError, match=BLANK):
        repr(world)
    world.__init__(world_path)
    assert repr(world) == repr(galactic.World(world_path))
