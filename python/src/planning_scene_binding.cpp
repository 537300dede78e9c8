#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "env_states.h"
#include "galactic/planning_scene.h"
#include "simulator.h"

namespace galactic::python {
namespace {

/// `given` as `count` finite numbers; ValueError when it is anything else.
std::vector<float> finiteNumbers(const py::handle& given, const char* name, std::size_t count) {
  const auto array = inputOf<float>(given, name, {static_cast<py::ssize_t>(count)});
  std::vector<float> numbers(array.data(), array.data() + count);
  if (!std::ranges::all_of(numbers, [](float number) { return std::isfinite(number); })) {
    throw py::value_error(fmt::format("{} holds a number that is not finite", name));
  }
  return numbers;
}

/// galactic.PlanningScene: a PlanningScene of one env of a simulator, which it keeps. Nothing here
/// gives the interpreter's lock away, so calls of several threads come one after the other.
class EnvScene {
 public:
  EnvScene(const py::object& simulator, const py::object& env)
      : simulator_(&simulatorOf(simulator)),
        scene_(simulator_->world(), simulator_->batch().options()) {
    update(env);
  }

  void update(const py::object& env) {
    const EnvState state = stateOf(env);
    scene_.update(state);
    scene_.setJoints(state.joint_positions);
    base_ = scene_.baseOf(state);
  }

  void setJoints(const py::object& positions) {
    scene_.setJoints(
        finiteNumbers(positions, "joint_positions", simulator_->world().robot().positionCount()));
  }

  [[nodiscard]] py::array_t<float> base() const {
    const Vec3& p = base_.position;
    return arrayOf(std::array{p.x, p.y, p.z, base_.yaw});
  }
  [[nodiscard]] std::vector<Pose> rootFromLinks() const {
    const std::span<const Pose> links = scene_.rootFromLinks();
    return {links.begin(), links.end()};
  }
  [[nodiscard]] Pose worldFromRoot(const py::object& base) const {
    return scene_.worldFromRoot(placeOf(base));
  }
  [[nodiscard]] Pose worldFromGrip(const py::object& base) const {
    return worldFromRoot(base) * scene_.rootFromGrip();
  }
  [[nodiscard]] float reach() const { return scene_.reach(); }

  [[nodiscard]] bool isFree(const py::object& base) { return scene_.isFree(placeOf(base)); }
  [[nodiscard]] std::optional<float> floorAt(float x, float z, float from) const {
    if (!std::isfinite(x) || !std::isfinite(z) || !std::isfinite(from)) {
      throw py::value_error("floor_at takes finite numbers");
    }
    return scene_.floorAt(x, z, from);
  }

  [[nodiscard]] std::optional<std::uint32_t> graspedAt(const py::object& base) const {
    return scene_.graspedAt(placeOf(base));
  }
  void hold(std::int64_t object, const py::object& base) {
    const auto last = static_cast<std::int64_t>(scene_.objectCount()) - 1;
    if (object < 0 || object > last) {
      throw py::index_error(fmt::format("there is no object {}, the last is {}", object, last));
    }
    scene_.hold(static_cast<std::uint32_t>(object), placeOf(base));
  }
  void putBack() { scene_.putBack(); }
  [[nodiscard]] bool isHolding() const { return scene_.isHolding(); }
  void ignorePenetrating(const py::object& base) { scene_.ignorePenetrating(placeOf(base)); }
  void countFree(const py::object& base) { scene_.countFree(placeOf(base)); }
  [[nodiscard]] std::optional<Pose> landing(const py::object& base) {
    return scene_.landing(placeOf(base));
  }

 private:
  /// Of x, y, z and yaw.
  static BasePlace placeOf(const py::object& base) {
    const std::vector<float> numbers = finiteNumbers(base, "base", 4);
    return {{numbers[0], numbers[1], numbers[2]}, numbers[3]};
  }

  /// A state itself, or that of an env.
  [[nodiscard]] EnvState stateOf(const py::object& env) const {
    if (py::isinstance<NamedEnvState>(env)) return env.cast<const NamedEnvState&>();
    const Confinement::Use use = simulator_->readState();
    return simulator_->batch().envState(simulator_->envNumber(env));
  }

  Simulator* simulator_;
  PlanningScene scene_;
  BasePlace base_;
};

}  // namespace

void bindPlanningScene(py::module_& module) {
  py::class_<EnvScene> type(module, "PlanningScene");
  type.def(py::init<const py::object&, const py::object&>(), py::arg("simulator"),
           py::arg("env") = 0, py::keep_alive<1, 2>(),
           "Of the world and the options of a simulator. Takes over a state, as update() does.");
  type.doc() =
      "What a planner asks about one env: is a pose of the robot free, where is the hand,\n"
      "what would it grasp, where would an object land? By the rules of the simulation,\n"
      "which is neither changed nor stepped.\n\n"
      "Bases are four numbers: x, y, z of the point on the floor under the robot's root,\n"
      "meters, and the yaw, radians. Answers are about the env and the joints that update()\n"
      "and set_joints() took over last.";
  type.def(
          "update", &EnvScene::update, py::arg("env"),
          "Takes over a state: its objects, what the robot holds, its joints.\n\n"
          "env: number of an env, as it is now, or an EnvState of the same world. What penetrates\n"
          "something there does not count, until count_free(): of the held object all, of the\n"
          "robot what is in resting objects. So has the simulation it after a grasp and after a\n"
          "release.")
      .def("set_joints", &EnvScene::setJoints, py::arg("joint_positions"),
           "Joint positions for what is asked next: (positions,), as in EnvState, radians or\n"
           "meters. Limits are not enforced.")
      .def_property_readonly("base", &EnvScene::base,
                             "Where the base of the env was at the last update: float32 (4,).")
      .def_property_readonly("root_from_links", &EnvScene::rootFromLinks,
                             "The poses of all links for these joints (forward kinematics), in\n"
                             "the order of World.links.")
      .def_property_readonly("reach", &EnvScene::reach,
                             "How far the robot reaches from its root's vertical axis, meters.")
      .def("world_from_root", &EnvScene::worldFromRoot, py::arg("base"), "Pose of the root link.")
      .def("world_from_grip", &EnvScene::worldFromGrip, py::arg("base"),
           "Origin at the grasp point, axes of the end effector's link.")
      .def("is_free", &EnvScene::isFree, py::arg("base"),
           "Whether neither the robot nor what it holds penetrates anything.")
      .def("floor_at", &EnvScene::floorAt, py::arg("x"), py::arg("z"), py::arg("from_height"),
           "Height of the floor for a base that comes from a height, meters; None where it\n"
           "cannot stand.")
      .def("grasped_at", &EnvScene::graspedAt, py::arg("base"),
           "Index of the object that a hand grasps that closes here, or None.")
      .def("hold", &EnvScene::hold, py::arg("object"), py::arg("base"),
           "Holds an object as if it were grasped here: spheres of it that penetrate something do\n"
           "not count, see ignore_penetrating(). galactic.Error where the hand is not empty.")
      .def("put_back", &EnvScene::putBack,
           "Puts what hold() took back to where it rested. galactic.Error where it took nothing.")
      .def_property_readonly("is_holding", &EnvScene::isHolding,
                             "Whether something is in the hand, in the env or by hold().")
      .def("ignore_penetrating", &EnvScene::ignorePenetrating, py::arg("base"),
           "Of the held object, those spheres do not count from now on that penetrate something\n"
           "here, and all others do. update() and hold() have done so where the robot of the env\n"
           "is, or where the object was grasped. Nothing happens where the hand is empty.")
      .def("count_free", &EnvScene::countFree, py::arg("base"),
           "What does not count and is free here counts again, of the held object and of the\n"
           "robot. The simulation does so in each place that a robot comes to: call this along a\n"
           "way from where an object was grasped or released.")
      .def("landing", &EnvScene::landing, py::arg("base"),
           "Pose in which the held object comes to rest if it is released here, without random\n"
           "jitters, or None when it finds no place. galactic.Error where the hand is empty.");
  type.attr("__module__") = "galactic";
  refusePickling(type, "make one from its simulator");
}

}  // namespace galactic::python
