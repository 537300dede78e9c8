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

/// The largest floats mean no limit.
std::optional<float> limitOf(float limit) {
  if (std::abs(limit) >= std::numeric_limits<float>::max()) return std::nullopt;
  return limit;
}

/// Positions of planar and floating joints have no unit here: simulators reject them.
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
                    "How far an action of 1 moves in a step, in `unit`; None if the action\n"
                    "moves nothing.")
      .def_readonly("unit", &Action::unit, "'rad' or 'm'; None for actions without a unit.")
      .def_readonly(
          "lower", &Action::lower,
          "The joint's lower limit, in `unit`; None for no limit, as of continuous joints.")
      .def_readonly(
          "upper", &Action::upper,
          "The joint's upper limit, in `unit`; None for no limit, as of continuous joints.")
      .def_readonly("position", &Action::position,
                    "The joint's index in EnvState.joint_positions; None if the action does not\n"
                    "move a joint.");
  type.def("__repr__", &actionText);
  type.attr("__module__") = "galactic";
  type.doc() =
      "What one column of the actions does. World.actions has one for each column, in\n"
      "order.";
}

}  // namespace

void bindWorld(py::module_& module) {
  bindAction(module);
  py::class_<World, std::shared_ptr<World>> type(module, "World");
  type.doc() =
      "Scenes, objects, one robot and episodes: everything that simulators read. A world never\n"
      "changes, and any number of simulators may share it.";
  type.def(py::init(&openWorld), py::arg("path"), py::arg("trusted") = false,
           "Opens packs, which are mapped into memory.\n\n"
           "path: the path of a world pack, or a list of paths of packs that make up a world.\n"
           "trusted: skips the checks of their contents, for packs that were checked before.\n"
           "Raises Error if packs cannot be read, or do not make up a world.")
      .def_property_readonly("scenes", &sceneNames,
                             "Names of the scenes; EnvState.scene is an index into\n"
                             "them.")
      .def_property_readonly("objects", &objectNames,
                             "Names of all objects that episodes place, each once.")
      .def_property_readonly(
          "object_centers", &objectCenters,
          "The center of each object's box, in the object's frame: float32 (len(objects), 3),\n"
          "meters, a copy.")
      .def_property_readonly(
          "object_boxes", &objectBoxes,
          "The oriented box around each object, in the object's frame: a galactic.ObjectBoxes,\n"
          "copies.")
      .def_property_readonly(
          "robot", [](const World& world) { return fileText(world.robot().name()); },
          "Name of the robot.")
      .def_property_readonly("links", &linkNames,
                             "Names of the robot's links, the root's first, in the order of\n"
                             "PlanningScene.root_from_links.")
      .def_property_readonly("joints", &jointNames,
                             "Names of the joints that actions move, in the order of the\n"
                             "actions.")
      .def_property_readonly(
          "positions", &namesOfPositions,
          "Names of the columns of joint_positions: the names of all joints of the robot,\n"
          "without those that mimic others. Joints with several columns have .x, .y and .angle,\n"
          "or .x to .qw appended.")
      .def_property_readonly(
          "limits", &limitsOfPositions,
          "Lower and upper limits of the columns of joint_positions: float32 (positions, 2),\n"
          "radians or meters, -inf and inf for no limit. Actions may have narrower limits: see\n"
          "`actions`.")
      .def_property_readonly(
          "actions", [](const World& world) { return py::tuple(py::cast(actionsOf(world))); },
          "What the columns of the actions do: an Action for each, joints first, then forward,\n"
          "turn, hand and terminate.")
      .def_property_readonly(
          "episodes", [](const World& world) { return world.episodes().episodes().size(); },
          "The number of episodes; their indices begin at 0.")
      .def("episode_table", &episodeTableOf,
           "Scene, start, target and goal of each episode, in arrays: a galactic.EpisodeTable.")
      .def_property_readonly(
          "radii",
          [](const World& world) {
            const std::span<const float> radii = world.radii();
            return py::tuple(py::cast(std::vector<float>(radii.begin(), radii.end())));
          },
          "The radii of spheres for which scenes have column grids, meters, ascending.")
      .def_property_readonly(
          "options", [](const World& world) { return keywordsOf(world.withTask()); },
          "Keywords of Simulator, with the values that they have in this world unless you give\n"
          "others.");
  type.def("__repr__", [](const World& world) {
    return fileText(fmt::format("<galactic.World of {} scenes, {} episodes, robot {}>",
                                world.scenes().size(), world.episodes().episodes().size(),
                                world.robot().name()));
  });
  type.attr("__module__") = "galactic";
  refusePickling(type, "open it by its path in each process; packs are mapped, and shared by all");
}

}  // namespace galactic::python
