#include "galactic/world.h"

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "episode_table.h"
#include "filled.h"
#include "galactic/error.h"
#include "galactic/position_names.h"
#include "options.h"

namespace galactic::python {
namespace {

using Path = std::filesystem::path;

std::shared_ptr<World> openWorld(const py::object& given, bool is_trusted) {
  py::detail::make_caster<std::vector<Path>> list;
  py::detail::make_caster<Path> one;
  const bool is_path = one.load(given, true);
  if (!is_path && !list.load(given, true)) {
    throw py::type_error(
        fmt::format("path is a {}, expected the path of a world pack, or a list of paths of packs",
                    typeName(given)));
  }
  const std::vector<Path> paths = is_path ? std::vector{py::detail::cast_op<Path>(one)}
                                          : py::detail::cast_op<std::vector<Path>>(std::move(list));
  const py::gil_scoped_release unlocked;
  return std::make_shared<World>(
      orThrow(World::open(paths, is_trusted ? Trust::kTrusted : Trust::kVerify)));
}

py::tuple sceneNames(const World& world) {
  py::list names;
  for (const Scene& scene : world.scenes()) names.append(fileText(scene.name()));
  return py::tuple(names);
}

py::tuple objectNames(const World& world) {
  py::list names;
  for (const std::string_view name : world.episodes().objectNames()) names.append(fileText(name));
  return py::tuple(names);
}

/// float32 (k, 3).
py::array_t<float> objectCenters(const World& world) {
  const std::size_t count = world.episodes().objectNames().size();
  Filled<float> centers({static_cast<py::ssize_t>(count), 3});
  for (std::uint32_t object = 0; object < count; ++object) {
    centers.put(numbersOf(world.object(object).box.pose.translation));
  }
  return centers.array();
}

/// galactic.ObjectBoxes.
py::object objectBoxes(const World& world) {
  const std::size_t count = world.episodes().objectNames().size();
  const auto rows = static_cast<py::ssize_t>(count);
  FilledPoses poses({rows});
  Filled<float> half_extents({rows, 3});
  for (std::uint32_t object = 0; object < count; ++object) {
    const OrientedBox& box = world.object(object).box;
    poses.put(box.pose);
    half_extents.put(numbersOf(box.half_extents));
  }
  return py::module_::import("galactic.object_boxes")
      .attr("ObjectBoxes")(poses.poses(py::module_::import("galactic.env_states")),
                           half_extents.array());
}

py::tuple linkNames(const World& world) {
  const Robot& robot = world.robot();
  py::list names;
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    names.append(fileText(robot.linkName(link)));
  }
  return py::tuple(names);
}

/// What a column of the actions does: galactic.Action.
struct Action {
  std::string name{};
  std::optional<float> step = std::nullopt;
  std::optional<std::string> unit = std::nullopt;
  std::optional<float> lower = std::nullopt;
  std::optional<float> upper = std::nullopt;
  std::optional<std::uint32_t> position = std::nullopt;
};

/// The largest floats stand for no limit.
std::optional<float> limitOf(float limit) {
  if (std::abs(limit) >= std::numeric_limits<float>::max()) return std::nullopt;
  return limit;
}

/// What one position of a planar or floating joint is has no unit here: simulators refuse it.
std::optional<std::string> unitOf(JointType type) {
  if (positionCount(type) != 1) return std::nullopt;
  return type == JointType::kPrismatic ? "m" : "rad";
}

Action actionOf(const Robot& robot, const ControlledJoint& joint) {
  Action action{.step = joint.step,
                .lower = limitOf(joint.lower),
                .upper = limitOf(joint.upper),
                .position = joint.position};
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    const LinkFrame& frame = robot.links()[link];
    const std::int64_t place = static_cast<std::int64_t>(joint.position) - frame.position;
    if (frame.position < 0 || place < 0 || place >= positionCount(frame.type)) continue;
    action.name = robot.jointName(link);
    action.unit = unitOf(frame.type);
    break;
  }
  return action;
}

std::vector<Action> actionsOf(const World& world) {
  const Robot& robot = world.robot();
  std::vector<Action> actions;
  for (const ControlledJoint& joint : robot.controlledJoints()) {
    actions.push_back(actionOf(robot, joint));
  }
  const RobotBase base = robot.base().value_or(RobotBase());
  actions.push_back({.name = "forward", .step = base.forward_step, .unit = "m"});
  actions.push_back({.name = "turn", .step = base.turn_step, .unit = "rad"});
  if (base.sideways_step > 0) {
    actions.push_back({.name = "sideways", .step = base.sideways_step, .unit = "m"});
  }
  actions.push_back({.name = "hand"});
  actions.push_back({.name = "terminate"});
  return actions;
}

py::tuple jointNames(const World& world) {
  py::list names;
  for (const Action& action : actionsOf(world)) {
    if (action.position) names.append(fileText(action.name));
  }
  return py::tuple(names);
}

py::tuple namesOfPositions(const World& world) {
  py::list names;
  for (const std::string& name : positionNames(world.robot())) names.append(fileText(name));
  return py::tuple(names);
}

/// float32 (positions, 2).
py::array_t<float> limitsOfPositions(const World& world) {
  const std::span<const PositionLimits> limits = world.robot().limits();
  Filled<float> rows({static_cast<py::ssize_t>(limits.size()), 2});
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const PositionLimits& one : limits) {
    rows.put(limitOf(one.lower).value_or(-kInfinity));
    rows.put(limitOf(one.upper).value_or(kInfinity));
  }
  return rows.array();
}

py::str actionText(const Action& action) {
  std::string text = fmt::format("<galactic.Action {}", action.name);
  if (action.step && action.unit) {
    text += fmt::format(", {:.4g} {} a step", *action.step, *action.unit);
  }
  if (action.lower || action.upper) {
    const auto limit = [](const std::optional<float>& one) {
      return one ? fmt::format("{:.4g}", *one) : std::string("no limit");
    };
    text += fmt::format(", from {} to {}", limit(action.lower), limit(action.upper));
  }
  return fileText(text + ">");
}

void bindAction(py::module_& module) {
  py::class_<Action> type(module, "Action");
  type.def_property_readonly(
          "name", [](const Action& action) { return fileText(action.name); },
          "The joint's, or 'forward', 'turn', 'hand' or 'terminate'.")
      .def_readonly("step", &Action::step,
                    "How far an action of 1 moves in a step, in `unit`; None where nothing moves.")
      .def_readonly("unit", &Action::unit, "'rad' or 'm'; None for what has none.")
      .def_readonly(
          "lower", &Action::lower,
          "The joint's lower limit, in `unit`; None for no limit, as of continuous joints.")
      .def_readonly(
          "upper", &Action::upper,
          "The joint's upper limit, in `unit`; None for no limit, as of continuous joints.")
      .def_readonly("position", &Action::position,
                    "The joint's index in EnvState.joint_positions; None for what is no joint.");
  type.def("__repr__", &actionText);
  type.attr("__module__") = "galactic";
  type.doc() = "What one column of the actions does: World.actions has one for each, in order.";
}

}  // namespace

void bindWorld(py::module_& module) {
  bindAction(module);
  py::class_<World, std::shared_ptr<World>> type(module, "World");
  type.doc() =
      "Scenes, objects, one robot and episodes: all that simulators read. It never changes, and\n"
      "any number of simulators may share it.";
  type.def(
          py::init(&openWorld), py::arg("path"), py::arg("trusted") = false,
          "Opens packs, which are mapped into memory.\n\n"
          "path: of a world pack, or a list of packs that make a world together. trusted: whether\n"
          "to leave out the checks of what is in them, for packs that were checked before. Error\n"
          "for packs that cannot be read, and for those that make no world.")
      .def_property_readonly("scenes", &sceneNames, "Names; EnvState.scene is an index.")
      .def_property_readonly("objects", &objectNames,
                             "Names of all objects that episodes place, each once.")
      .def_property_readonly(
          "object_centers", &objectCenters,
          "Where in the frame of each of them the middle of its box is: float32\n"
          "(len(objects), 3), meters, a copy.")
      .def_property_readonly(
          "object_boxes", &objectBoxes,
          "The oriented box around each of them, in its frame: a galactic.ObjectBoxes, copies.")
      .def_property_readonly(
          "robot", [](const World& world) { return fileText(world.robot().name()); },
          "Name of the robot.")
      .def_property_readonly("links", &linkNames,
                             "Names of the robot's links, the root's first: in the order of\n"
                             "PlanningScene.root_from_links.")
      .def_property_readonly("joints", &jointNames,
                             "Names of the joints that actions move, in their order.")
      .def_property_readonly(
          "positions", &namesOfPositions,
          "What the columns of joint_positions are: the names of the whole robot's joints, "
          "without\n"
          "those that follow others; with .x, .y and .angle or .x to .qw where one has several.")
      .def_property_readonly(
          "limits", &limitsOfPositions,
          "Of the columns of joint_positions, lower and upper: float32 (positions, 2), radians or\n"
          "meters, -inf and inf where there is none. Actions may keep to narrower ones: `actions`.")
      .def_property_readonly(
          "actions", [](const World& world) { return py::tuple(py::cast(actionsOf(world))); },
          "What the columns of the actions do: an Action for each, joints first, then forward,\n"
          "turn, hand and terminate.")
      .def_property_readonly(
          "episodes", [](const World& world) { return world.episodes().episodes().size(); },
          "How many there are; their indices begin at 0.")
      .def("episode_table", &episodeTableOf,
           "Scene, start, target and goal of each episode, in arrays: a galactic.EpisodeTable.")
      .def_property_readonly(
          "radii",
          [](const World& world) {
            const std::span<const float> radii = world.radii();
            return py::tuple(py::cast(std::vector<float>(radii.begin(), radii.end())));
          },
          "Of the spheres that scenes answer for, meters, ascending.")
      .def_property_readonly(
          "options", [](const World& world) { return keywordsOf(world.withTask()); },
          "Keywords of Simulator with the values that they have here unless you give others.");
  type.def("__repr__", [](const World& world) {
    return fileText(fmt::format("<galactic.World of {} scenes, {} episodes, robot {}>",
                                world.scenes().size(), world.episodes().episodes().size(),
                                world.robot().name()));
  });
  type.attr("__module__") = "galactic";
  refusePickling(type, "open it by its path in each process; packs are mapped, and shared by all");
}

}  // namespace galactic::python
