#include "galactic/world.h"

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "bindings.h"
#include "errors.h"
#include "options.h"

namespace galactic::python {
namespace {

using Path = std::filesystem::path;

std::shared_ptr<World> openWorld(const std::variant<Path, std::vector<Path>>& given,
                                 bool is_trusted) {
  const std::vector<Path> paths = std::holds_alternative<Path>(given)
                                      ? std::vector{std::get<Path>(given)}
                                      : std::get<std::vector<Path>>(given);
  const py::gil_scoped_release unlocked;
  return std::make_shared<World>(
      valueOf(World::open(paths, is_trusted ? Trust::kTrusted : Trust::kVerify)));
}

py::tuple sceneNames(const World& world) {
  py::list names;
  for (const Scene& scene : world.scenes()) names.append(py::str(scene.name()));
  return py::tuple(names);
}

py::tuple objectNames(const World& world) {
  py::list names;
  for (const std::string_view name : world.episodes().objectNames()) names.append(py::str(name));
  return py::tuple(names);
}

/// Of the joints that actions move, in their order.
py::tuple jointNames(const World& world) {
  const Robot& robot = world.robot();
  py::list names;
  for (const ControlledJoint& joint : robot.controlledJoints()) {
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      if (robot.links()[link].position != static_cast<std::int32_t>(joint.position)) continue;
      names.append(py::str(robot.jointName(link)));
      break;
    }
  }
  return py::tuple(names);
}

}  // namespace

void bindWorld(py::module_& module) {
  py::class_<World, std::shared_ptr<World>> type(module, "World");
  type.def(py::init(&openWorld), py::arg("path"), py::arg("trusted") = false)
      .def_property_readonly("scenes", &sceneNames)
      .def_property_readonly("objects", &objectNames)
      .def_property_readonly("robot",
                             [](const World& world) { return py::str(world.robot().name()); })
      .def_property_readonly("joints", &jointNames)
      .def_property_readonly("episodes",
                             [](const World& world) { return world.episodes().episodes().size(); })
      .def_property_readonly(
          "radii",
          [](const World& world) {
            const std::span<const float> radii = world.radii();
            return py::tuple(py::cast(std::vector<float>(radii.begin(), radii.end())));
          })
      .def_property_readonly("options",
                             [](const World& world) { return keywordsOf(world.withTask()); });
  type.def("__repr__", [](const World& world) {
    return fmt::format("<galactic.World of {} scenes, {} episodes, robot {}>",
                       world.scenes().size(), world.episodes().episodes().size(),
                       world.robot().name());
  });
  type.attr("__module__") = "galactic";
  refusePickling(type, "open it by its path in each process; packs are mapped, and shared by all");
}

}  // namespace galactic::python
