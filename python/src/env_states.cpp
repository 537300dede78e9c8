#include "env_states.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "arrays.h"
#include "bindings.h"
#include "filled.h"
#include "galactic/error.h"

namespace galactic::python {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
/// Fills the places of objects that an env does not have.
constexpr Pose kNoPose{{kNan, kNan, kNan}, {kNan, kNan, kNan, kNan}};
constexpr std::int32_t kNoObject = -1;

void bindPose(py::module_& module) {
  py::class_<Pose> type(module, "Pose");
  type.def_property_readonly(
          "translation", [](const Pose& pose) { return arrayOf(numbersOf(pose.translation)); },
          "float32 (3,), meters.")
      .def_property_readonly(
          "rotation", [](const Pose& pose) { return arrayOf(numbersOf(pose.rotation)); },
          "float32 (4,), a unit quaternion: w, x, y, z.")
      .def_property_readonly(
          "matrix",
          [](const Pose& pose) {
            py::array_t<float> matrix({4, 4});
            writeMatrix(rigidTransform(pose), matrix.mutable_data());
            return matrix;
          },
          "float32 (4, 4); a_from_b.matrix @ b_from_c.matrix is that of a_from_c.");
  type.def("__repr__", [](const Pose& pose) {
    const auto& [t, q] = pose;
    return fmt::format(
        "Pose(translation=({:.4g}, {:.4g}, {:.4g}), rotation=({:.4g}, {:.4g}, {:.4g}, "
        "{:.4g}))",
        t.x, t.y, t.z, q.w, q.x, q.y, q.z);
  });
  type.def(py::pickle(
      [](const Pose& pose) {
        return py::make_tuple(numbersOf(pose.translation), numbersOf(pose.rotation));
      },
      [](const py::tuple& state) {
        const auto t = state[0].cast<std::array<float, 3>>();
        const auto q = state[1].cast<std::array<float, 4>>();
        return Pose{{t[0], t[1], t[2]}, {.x = q[1], .y = q[2], .z = q[3], .w = q[0]}};
      }));
  type.attr("__module__") = "galactic";
  type.doc() = "A rigid transform a_from_b: rotate, then translate.";
}

std::string textOf(const NamedEnvState& state) {
  const std::string held =
      state.held < 0 ? "nothing" : state.object_names[static_cast<std::size_t>(state.held)];
  return fmt::format("<galactic.EnvState of episode {} after {} steps, {} in the hand>",
                     state.episode, state.step, held);
}

py::tuple pickled(const NamedEnvState& state) {
  return py::make_tuple(state.scene, state.episode, state.step, state.world_from_root,
                        state.joint_positions, state.world_from_grip, state.objects, state.held,
                        state.target, state.goal, state.object_names);
}

NamedEnvState stateIn(const py::tuple& state) {
  return {{.scene = state[0].cast<std::uint32_t>(),
           .episode = state[1].cast<std::uint32_t>(),
           .step = state[2].cast<std::uint32_t>(),
           .world_from_root = state[3].cast<Pose>(),
           .joint_positions = state[4].cast<std::vector<float>>(),
           .world_from_grip = state[5].cast<Pose>(),
           .objects = state[6].cast<std::vector<Pose>>(),
           .held = state[7].cast<std::int32_t>(),
           .target = state[8].cast<std::uint32_t>(),
           .goal = state[9].cast<Pose>()},
          state[10].cast<std::vector<std::string>>()};
}

/// The tuple may come from anywhere: check that its indices exist.
NamedEnvState unpickled(const py::tuple& tuple) {
  NamedEnvState state = stateIn(tuple);
  const std::size_t count = state.objects.size();
  const bool holds_one = state.held < 0 || static_cast<std::size_t>(state.held) < count;
  if (!holds_one || state.target >= count || state.object_names.size() != count) {
    throw py::value_error("this is no EnvState: it lacks objects that it speaks of");
  }
  return state;
}

}  // namespace

void requireStates(const py::object& states) {
  const py::object type = py::module_::import("galactic.env_states").attr("EnvStates");
  if (py::isinstance(states, type)) return;
  throw py::type_error(
      fmt::format("states is a {}, expected galactic.EnvStates, such as env_states() returns",
                  typeName(states)));
}

NamedEnvState envState(Simulator& simulator, const py::object& env) {
  const Confinement::Use use = simulator.readState();
  const std::uint32_t number = simulator.envNumber(env);
  NamedEnvState state{simulator.batch().envState(number), {}};
  const std::vector<std::string_view>& names = simulator.world().episodes().objectNames();
  for (const Placement& placement : simulator.batch().envObjects(number).present.placements) {
    state.object_names.push_back(fileText(names[placement.object]));
  }
  return state;
}

py::object envStates(Simulator& simulator, const py::object& envs) {
  const Confinement::Use use = simulator.readState();
  const std::vector<std::uint32_t> chosen = simulator.allOrThose(envs);
  const auto count = static_cast<py::ssize_t>(chosen.size());
  const auto joints = static_cast<py::ssize_t>(simulator.world().robot().startPositions().size());
  const std::size_t most = simulator.mostObjects();
  const Shape each_object{count, static_cast<py::ssize_t>(most)};
  Filled<std::int32_t> scene({count}), episode({count}), step({count}), held({count}),
      target({count}), object_kinds(each_object);
  Filled<float> joint_positions({count, joints});
  FilledPoses roots({count}), grips({count}), goals({count}), objects(each_object);
  for (const std::uint32_t env : chosen) {
    const EnvState state = simulator.batch().envState(env);
    scene.put(static_cast<std::int32_t>(state.scene));
    episode.put(static_cast<std::int32_t>(state.episode));
    step.put(static_cast<std::int32_t>(state.step));
    roots.put(state.world_from_root);
    joint_positions.put(state.joint_positions);
    grips.put(state.world_from_grip);
    const std::span<const Placement> placements =
        simulator.batch().envObjects(env).present.placements;
    for (std::size_t n = 0; n < most; ++n) {
      const bool is_there = n < placements.size();
      objects.put(is_there ? state.objects[n] : kNoPose);
      object_kinds.put(is_there ? static_cast<std::int32_t>(placements[n].object) : kNoObject);
    }
    held.put(state.held);
    target.put(static_cast<std::int32_t>(state.target));
    goals.put(state.goal);
  }
  const auto types = py::module_::import("galactic.env_states");
  using namespace py::literals;
  return types.attr("EnvStates")(
      "scene"_a = scene.array(), "episode"_a = episode.array(), "step"_a = step.array(),
      "world_from_root"_a = roots.poses(types), "joint_positions"_a = joint_positions.array(),
      "world_from_grip"_a = grips.poses(types), "objects"_a = objects.poses(types),
      "object_kinds"_a = object_kinds.array(), "held"_a = held.array(), "target"_a = target.array(),
      "goal"_a = goals.poses(types));
}

namespace {

/// The arrays of a galactic.EnvStates, which requireStates() has checked.
class GivenStates {
 public:
  GivenStates(const py::object& states, const Simulator& simulator, py::ssize_t count)
      : states_(states),
        most_(static_cast<py::ssize_t>(simulator.mostObjects())),
        positions_(static_cast<py::ssize_t>(simulator.world().robot().positionCount())),
        episode_(whole("episode", count)),
        step_(whole("step", count)),
        held_(whole("held", count)),
        target_(whole("target", count)),
        joint_positions_(numbers("joint_positions", {count, positions_})),
        roots_(*this, "world_from_root", {count}),
        grips_(*this, "world_from_grip", {count}),
        objects_(*this, "objects", {count, most_}),
        goals_(*this, "goal", {count}) {}

  /// State `n`. Throws unless its episode can start.
  [[nodiscard]] EnvState at(const Simulator& simulator, py::ssize_t n) const {
    simulator.requireEpisode(episode_.data()[n]);
    EnvState state;
    state.episode = static_cast<std::uint32_t>(episode_.data()[n]);
    state.step = narrow<std::uint32_t>("step", step_.data()[n]);
    state.held = narrow<std::int32_t>("held", held_.data()[n]);
    state.target = narrow<std::uint32_t>("target", target_.data()[n]);
    state.world_from_root = roots_.at(n);
    state.world_from_grip = grips_.at(n);
    state.goal = goals_.at(n);
    const float* positions = joint_positions_.data() + n * positions_;
    state.joint_positions.assign(positions, positions + positions_);
    const EpisodeSet& episodes = simulator.world().episodes();
    const std::size_t objects =
        std::min<std::size_t>(episodes.placements(episodes.episodes()[state.episode]).size(),
                              static_cast<std::size_t>(most_));
    for (std::size_t object = 0; object < objects; ++object) {
      state.objects.push_back(objects_.at(n * most_ + static_cast<py::ssize_t>(object)));
    }
    return state;
  }

 private:
  class Poses {
   public:
    Poses(const GivenStates& given, const char* name, Shape shape)
        : translations_(part(given, name, "translation", shape, 3)),
          rotations_(part(given, name, "rotation", shape, 4)) {}

    [[nodiscard]] Pose at(py::ssize_t n) const {
      const float* t = translations_.data() + 3 * n;
      const float* q = rotations_.data() + 4 * n;
      return {{t[0], t[1], t[2]}, {.x = q[1], .y = q[2], .z = q[3], .w = q[0]}};
    }

   private:
    static InputArray<float> part(const GivenStates& given, const char* name, const char* half,
                                  Shape shape, py::ssize_t numbers) {
      shape.push_back(numbers);
      const std::string full = fmt::format("states.{}.{}", name, half);
      return inputOf<float>(py::getattr(given.states_.attr(name), half), full.c_str(), shape);
    }

    InputArray<float> translations_;
    InputArray<float> rotations_;
  };

  [[nodiscard]] InputArray<std::int64_t> whole(const char* name, py::ssize_t count) const {
    const std::string full = fmt::format("states.{}", name);
    return wholeNumbersOf(states_.attr(name), full.c_str(), {count});
  }
  [[nodiscard]] InputArray<float> numbers(const char* name, const Shape& shape) const {
    const std::string full = fmt::format("states.{}", name);
    return inputOf<float>(states_.attr(name), full.c_str(), shape);
  }
  template <class T>
  static T narrow(const char* name, std::int64_t value) {
    constexpr std::int64_t kLeast = std::numeric_limits<T>::min();
    constexpr std::int64_t kMost = std::numeric_limits<T>::max();
    if (value >= kLeast && value <= kMost) return static_cast<T>(value);
    throw py::value_error(
        fmt::format("states.{} is {}, expected {} to {}", name, value, kLeast, kMost));
  }

  py::object states_;
  py::ssize_t most_;
  py::ssize_t positions_;
  InputArray<std::int64_t> episode_;
  InputArray<std::int64_t> step_;
  InputArray<std::int64_t> held_;
  InputArray<std::int64_t> target_;
  InputArray<float> joint_positions_;
  Poses roots_;
  Poses grips_;
  Poses objects_;
  Poses goals_;
};

std::vector<EnvState> listOf(const Simulator& simulator, const py::object& states,
                             std::size_t count) {
  requireStates(states);
  const GivenStates given(states, simulator, static_cast<py::ssize_t>(count));
  std::vector<EnvState> list;
  for (std::size_t n = 0; n < count; ++n) {
    list.push_back(given.at(simulator, static_cast<py::ssize_t>(n)));
  }
  return list;
}

}  // namespace

void checkStates(Simulator& simulator, const py::object& states) {
  const Confinement::Use use = simulator.readState();
  requireStates(states);
  const std::size_t count = py::len(states.attr("episode"));
  orThrow(simulator.batch().checkStates(listOf(simulator, states, count)));
}

py::array_t<bool> setStates(Simulator& simulator, const py::object& states, const py::object& envs,
                            bool are_drawn) {
  const Confinement::Use use = simulator.readState();
  const std::vector<std::uint32_t> chosen = simulator.allOrThose(envs);
  const std::vector<EnvState> list = listOf(simulator, states, chosen.size());
  std::vector<std::uint8_t> were_set;
  {
    const py::gil_scoped_release unlocked;
    were_set = orThrow(simulator.batch().setStates(
        chosen, list, are_drawn ? EpisodeChoice::kDrawn : EpisodeChoice::kNamed));
  }
  return truthsOf(were_set);
}

void bindEnvState(py::module_& module) {
  bindPose(module);
  py::class_<NamedEnvState> type(module, "EnvState");
  type.def_readonly("scene", &EnvState::scene, "Index into World.scenes.")
      .def_readonly("episode", &EnvState::episode, "Index of the episode in the world.")
      .def_readonly("step", &EnvState::step, "How many steps of the episode are done.")
      .def_readonly("world_from_root", &EnvState::world_from_root, "Pose of the robot's root.")
      .def_property_readonly(
          "joint_positions",
          [](const NamedEnvState& state) { return arrayOf(state.joint_positions); },
          "float32 (joints,) of the whole robot, radians or meters; World.actions has the\n"
          "indices of the joints that actions move.")
      .def_readonly("world_from_grip", &EnvState::world_from_grip,
                    "Pose of the hand: origin at the grasp point, axes of the end effector's link.")
      .def_readonly(
          "objects", &EnvState::objects,
          "A Pose in the world for each of the episode's objects, including the held one.")
      .def_property_readonly(
          "object_names",
          [](const NamedEnvState& state) { return py::tuple(py::cast(state.object_names)); },
          "Names of the objects, in their order.")
      .def_property_readonly(
          "held",
          [](const NamedEnvState& state) -> py::object {
            if (state.held < 0) return py::none();
            return py::int_(state.held);
          },
          "Index into objects of the object in the hand; None if the hand is empty.")
      .def_readonly("target", &EnvState::target, "Index into objects of the object to be moved.")
      .def_readonly("goal", &EnvState::goal,
                    "Pose in the world to which the target is to be moved.");
  type.def("__repr__", &textOf);
  type.def(py::pickle(&pickled, &unpickled));
  type.attr("__module__") = "galactic";
  type.doc() = "The state of one env: a copy. PlanningScene has the poses of the links.";
}

}  // namespace galactic::python
