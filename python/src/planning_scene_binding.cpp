#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "env_states.h"
#include "filled.h"
#include "galactic/kinematics.h"
#include "galactic/planning_scene.h"
#include "galactic/self_collision.h"
#include "options.h"
#include "simulator.h"

namespace galactic::python {
namespace {

/// Rows of `columns` finite numbers: (n, columns), or (columns,) for a row that applies to all.
class Rows {
 public:
  Rows(const py::handle& given, const char* name, std::size_t columns) : columns_(columns) {
    const py::array numbers = numbersIn(given, name);
    const auto width = static_cast<py::ssize_t>(columns);
    is_one_ = numbers.ndim() == 1;
    const py::ssize_t rows = numbers.ndim() == 0 ? 0 : numbers.shape(0);
    array_ = inputOf<float>(numbers, name, is_one_ ? Shape{width} : Shape{rows, width});
    count_ = is_one_ ? 1 : static_cast<std::size_t>(rows);
    const float* first = array_.data();
    const float* wrong = std::find_if_not(first, first + array_.size(),
                                          [](float one) { return std::isfinite(one); });
    if (wrong == first + array_.size()) return;
    throw py::value_error(fmt::format("{}[{}] holds a number that is not finite", name,
                                      static_cast<std::size_t>(wrong - first) / columns));
  }

  [[nodiscard]] bool isOne() const { return is_one_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::span<const float> operator[](std::size_t row) const {
    return {array_.data() + (is_one_ ? 0 : row * columns_), columns_};
  }

 private:
  InputArray<float> array_;
  std::size_t columns_;
  std::size_t count_ = 0;
  bool is_one_ = false;
};

/// The common number of rows of several named arrays, without those that have one row for all.
/// Raises ValueError if they differ.
std::size_t countOf(std::initializer_list<std::pair<const char*, const Rows*>> arrays) {
  const std::pair<const char*, const Rows*>* first = nullptr;
  for (const auto& array : arrays) {
    if (array.second->isOne()) continue;
    if (first == nullptr) first = &array;
    if (array.second->count() == first->second->count()) continue;
    throw py::value_error(fmt::format("{} has {} rows, and {} has {}", first->first,
                                      first->second->count(), array.first, array.second->count()));
  }
  return first == nullptr ? 1 : first->second->count();
}

/// Poses of a robot in the form that C++ takes.
class GivenPoses {
 public:
  GivenPoses(const Rows& bases, const Rows& joints, std::size_t count) {
    bases_.reserve(count);
    for (std::size_t n = 0; n < count; ++n) {
      const std::span<const float> base = bases[n];
      bases_.push_back({{base[0], base[1], base[2]}, base[3]});
      joints_.insert(joints_.end(), joints[n].begin(), joints[n].end());
    }
  }
  [[nodiscard]] RobotPoses view() const { return {bases_, joints_}; }

 private:
  std::vector<BasePlace> bases_;
  std::vector<float> joints_;
};

constexpr std::size_t kBaseNumbers = 4;

std::span<float> spanOf(py::array_t<float>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

/// Memory for clearances, and their conversion to galactic.Clearances.
class MadeClearances {
 public:
  MadeClearances(std::size_t poses, std::size_t spheres, std::size_t positions)
      : shape_{static_cast<py::ssize_t>(poses), static_cast<py::ssize_t>(spheres)},
        clearances_(poses * spheres),
        bases_(withLast(kBaseNumbers)),
        joints_(withLast(positions)) {}

  // The memory into which C++ writes.
  [[nodiscard]] std::span<SphereClearance> clearances() { return clearances_; }
  [[nodiscard]] ClearanceGradients gradients() { return {spanOf(bases_), spanOf(joints_)}; }

  [[nodiscard]] py::object object(const Robot& robot) const {
    Filled<float> distances(shape_);
    Filled<std::uint8_t> nearest(shape_);
    Filled<std::int32_t> indices(shape_);
    Filled<float> directions(withLast(3));
    for (const SphereClearance& one : clearances_) {
      distances.put(one.distance);
      nearest.put(static_cast<std::uint8_t>(one.nearest));
      indices.put(one.index);
      directions.put(numbersOf(one.direction));
    }
    return py::module_::import("galactic.clearances")
        .attr("Clearances")(distances.array(), nearest.array(), indices.array(), directions.array(),
                            bases_, joints_, linksOf(robot));
  }

 private:
  [[nodiscard]] Shape withLast(std::size_t last) const {
    return {shape_[0], shape_[1], static_cast<py::ssize_t>(last)};
  }
  /// The link that carries each sphere, including those of the held object.
  [[nodiscard]] py::array_t<std::int32_t> linksOf(const Robot& robot) const {
    py::array_t<std::int32_t> links(shape_[1]);
    std::int32_t* next = links.mutable_data();
    for (const SphereGroup& group : robot.groups()) {
      next = std::fill_n(next, group.spheres.size(), static_cast<std::int32_t>(group.link));
    }
    std::fill(next, links.mutable_data() + links.size(),
              static_cast<std::int32_t>(robot.endEffector()->link));
    return links;
  }

  Shape shape_;
  std::vector<SphereClearance> clearances_;
  py::array_t<float> bases_;
  py::array_t<float> joints_;
};

/// galactic.PlanningScene: a PlanningScene of one env of a simulator, which it keeps alive. The
/// interpreter's lock serializes calls from several threads; calls that release it work on a copy.
class EnvScene {
 public:
  EnvScene(const py::object& simulator, const py::object& env)
      : simulator_(&simulatorOf(simulator)),
        scene_(simulator_->world(), simulator_->batch().options()),
        self_collision_(simulator_->world().robot()) {
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

  [[nodiscard]] py::array_t<bool> areFree(const py::object& bases, const py::object& joints,
                                          const py::object& threads) const {
    const Rows places(bases, "bases", kBaseNumbers);
    const Rows positions(joints, "joint_positions", positionCount());
    const std::size_t count = countOf({{"bases", &places}, {"joint_positions", &positions}});
    const GivenPoses poses(places, positions, count);
    const std::uint32_t wanted = threadsOf(threads);
    const PlanningScene scene(scene_);
    std::vector<std::uint8_t> free(count);
    {
      const py::gil_scoped_release unlocked;
      scene.areFree(poses.view(), free, wanted);
    }
    return truthsOf(free);
  }
  [[nodiscard]] py::array_t<bool> areMotionsFree(const py::object& bases, const py::object& joints,
                                                 const py::object& to_bases,
                                                 const py::object& to_joints,
                                                 const py::object& threads) const {
    const Rows from(bases, "bases", kBaseNumbers);
    const Rows positions(joints, "joint_positions", positionCount());
    const Rows to(to_bases, "to_bases", kBaseNumbers);
    const Rows to_positions(to_joints, "to_joint_positions", positionCount());
    const std::size_t count = countOf({{"bases", &from},
                                       {"joint_positions", &positions},
                                       {"to_bases", &to},
                                       {"to_joint_positions", &to_positions}});
    const GivenPoses begins(from, positions, count);
    const GivenPoses ends(to, to_positions, count);
    const std::uint32_t wanted = threadsOf(threads);
    const PlanningScene scene(scene_);
    std::vector<std::uint8_t> free(count);
    {
      const py::gil_scoped_release unlocked;
      scene.areMotionsFree(begins.view(), ends.view(), free, wanted);
    }
    return truthsOf(free);
  }

  [[nodiscard]] py::object clearances(const py::object& bases, const py::object& joints, float most,
                                      const py::object& threads) const {
    const Rows places(bases, "bases", kBaseNumbers);
    const Rows positions(joints, "joint_positions", positionCount());
    const std::size_t count = countOf({{"bases", &places}, {"joint_positions", &positions}});
    const GivenPoses poses(places, positions, count);
    const std::uint32_t wanted = threadsOf(threads);
    if (!(most > 0) || !std::isfinite(most)) {
      throw py::value_error(fmt::format("most is {:g}, expected meters above 0", most));
    }
    const PlanningScene scene(scene_);
    MadeClearances made(count, scene.sphereCount(), positionCount());
    {
      const py::gil_scoped_release unlocked;
      scene.clearances(poses.view(), most, made.clearances(), made.gradients(), wanted);
    }
    return made.object(robot());
  }

  [[nodiscard]] bool touchesItself(float margin) const {
    requireFinite(margin);
    return scene_.touchesItself(margin);
  }
  [[nodiscard]] py::array_t<bool> touchThemselves(const py::object& joints, float margin) const {
    requireFinite(margin);
    const Rows positions(joints, "joint_positions", positionCount());
    std::vector<std::uint8_t> touching(positions.count());
    {
      const py::gil_scoped_release unlocked;
      std::vector<Pose> links(robot().links().size());
      for (std::size_t n = 0; n < touching.size(); ++n) {
        forwardKinematics(robot().links(), {}, positions[n], links);
        touching[n] = self_collision_.touches(links, margin) ? 1 : 0;
      }
    }
    return truthsOf(touching);
  }

  [[nodiscard]] py::object worldFromLinks(const py::object& bases, const py::object& joints) const {
    const std::size_t links = robot().links().size();
    return posesOf(bases, joints, links, [](std::span<const Pose> world_from_links, auto& poses) {
      for (const Pose& pose : world_from_links) poses.put(pose);
    });
  }
  [[nodiscard]] py::object worldFromGrips(const py::object& bases, const py::object& joints) const {
    const EndEffector& hand = *robot().endEffector();
    return posesOf(bases, joints, 0, [&](std::span<const Pose> world_from_links, auto& poses) {
      poses.put(world_from_links[hand.link] * Pose{hand.grasp_point, {}});
    });
  }
  [[nodiscard]] py::array_t<float> basesOf(const py::object& states) const {
    requireStates(states);
    const py::object roots = states.attr("world_from_root");
    const Rows places(roots.attr("translation"), "states.world_from_root.translation", 3);
    const Rows rotations(roots.attr("rotation"), "states.world_from_root.rotation", kBaseNumbers);
    const std::size_t count = countOf({{"states.world_from_root.translation", &places},
                                       {"states.world_from_root.rotation", &rotations}});
    Filled<float> bases({static_cast<py::ssize_t>(count), kBaseNumbers});
    for (std::size_t n = 0; n < count; ++n) {
      const std::span<const float> t = places[n];
      const std::span<const float> q = rotations[n];
      EnvState state;
      state.world_from_root = {{t[0], t[1], t[2]}, {.x = q[1], .y = q[2], .z = q[3], .w = q[0]}};
      const BasePlace base = scene_.baseOf(state);
      bases.put(std::array{base.position.x, base.position.y, base.position.z, base.yaw});
    }
    return bases.array();
  }
  [[nodiscard]] py::array_t<float> floorsAt(const py::object& bases) const {
    const Rows places(bases, "bases", kBaseNumbers);
    Filled<float> heights({static_cast<py::ssize_t>(places.count())});
    for (std::size_t n = 0; n < places.count(); ++n) {
      const std::span<const float> base = places[n];
      constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
      heights.put(scene_.floorAt(base[0], base[2], base[1]).value_or(kNone));
    }
    return heights.array();
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
  /// A base from x, y, z and yaw.
  static BasePlace placeOf(const py::object& base) {
    const std::vector<float> numbers = finiteNumbers(base, "base", kBaseNumbers);
    return {{numbers[0], numbers[1], numbers[2]}, numbers[3]};
  }

  [[nodiscard]] const Robot& robot() const { return simulator_->world().robot(); }
  [[nodiscard]] std::size_t positionCount() const { return robot().positionCount(); }
  static void requireFinite(float margin) {
    if (!std::isfinite(margin)) throw py::value_error("margin is not a finite number");
  }

  /// galactic.Poses of (n, `each`), or of (n,) if that is 0: `put` adds the poses for each row,
  /// given those of its links.
  template <class Put>
  [[nodiscard]] py::object posesOf(const py::object& bases, const py::object& joints,
                                   std::size_t each, const Put& put) const {
    const Rows places(bases, "bases", kBaseNumbers);
    const Rows positions(joints, "joint_positions", positionCount());
    const std::size_t count = countOf({{"bases", &places}, {"joint_positions", &positions}});
    Shape shape{static_cast<py::ssize_t>(count)};
    if (each > 0) shape.push_back(static_cast<py::ssize_t>(each));
    FilledPoses poses(shape);
    {
      const py::gil_scoped_release unlocked;
      std::vector<Pose> links(robot().links().size());
      for (std::size_t n = 0; n < count; ++n) {
        const std::span<const float> base = places[n];
        const Pose world_from_root = scene_.worldFromRoot({{base[0], base[1], base[2]}, base[3]});
        forwardKinematics(robot().links(), world_from_root, positions[n], links);
        put(links, poses);
      }
    }
    return poses.poses(py::module_::import("galactic.env_states"));
  }

  /// The state that was given, or that of the env with the given number.
  [[nodiscard]] EnvState stateOf(const py::object& env) const {
    if (py::isinstance<NamedEnvState>(env)) return env.cast<const NamedEnvState&>();
    const Confinement::Use use = simulator_->readState();
    return simulator_->batch().envState(simulator_->envNumber(env));
  }

  Simulator* simulator_;
  PlanningScene scene_;
  SelfCollision self_collision_;
  BasePlace base_;
};

}  // namespace

void bindPlanningScene(py::module_& module) {
  py::class_<EnvScene> type(module, "PlanningScene");
  type.def(py::init<const py::object&, const py::object&>(), py::arg("simulator"),
           py::arg("env") = 0, py::keep_alive<1, 2>(),
           "Uses the world and the options of a simulator, and takes over the state of `env`,\n"
           "as update() does.");
  type.doc() =
      "Answers a planner's questions about one env: is a pose of the robot free, where is the\n"
      "hand, what would it grasp, where would an object land? The rules are those of the\n"
      "simulation, which is neither changed nor stepped.\n\n"
      "A base is four numbers: x, y, z of the point on the floor under the robot's root,\n"
      "meters, and the yaw, radians. Answers refer to the state and the joints of the last\n"
      "update() and set_joints().";
  type.def("update", &EnvScene::update, py::arg("env"),
           "Takes over a state: its objects, what the robot holds, its joints. env: number of an\n"
           "env, for its current state, or an EnvState of the same world. Spheres of the held\n"
           "object that penetrate something in this state, and spheres of the robot that\n"
           "penetrate resting objects, are ignored until count_free(), as in the simulation\n"
           "after a grasp and after a release.")
      .def("set_joints", &EnvScene::setJoints, py::arg("joint_positions"),
           "Sets the joint positions for the following questions: (positions,), as in EnvState,\n"
           "radians or meters. Limits are not enforced.")
      .def_property_readonly("base", &EnvScene::base,
                             "The base of the env at the last update(): float32 (4,).")
      .def_property_readonly("root_from_links", &EnvScene::rootFromLinks,
                             "The poses of all links for these joints (forward kinematics), in\n"
                             "the order of World.links.")
      .def_property_readonly("reach", &EnvScene::reach,
                             "How far the robot reaches from the vertical axis through its\n"
                             "root, meters.")
      .def("world_from_root", &EnvScene::worldFromRoot, py::arg("base"), "Pose of the root link.")
      .def("world_from_grip", &EnvScene::worldFromGrip, py::arg("base"),
           "Pose of the hand: origin at the grasp point, axes of the end effector's link.")
      .def("is_free", &EnvScene::isFree, py::arg("base"),
           "Whether neither the robot nor what it holds penetrates anything. This does not check\n"
           "for a floor under the base, which floor_at() does: half a meter above the floor, a\n"
           "base is free.")
      .def("floor_at", &EnvScene::floorAt, py::arg("x"), py::arg("z"), py::arg("from_height"),
           "Height of the floor at x and z for a base that comes from a given height, meters;\n"
           "None if it cannot stand there.")
      .def("are_free", &EnvScene::areFree, py::arg("bases"), py::arg("joint_positions"),
           py::kw_only(), py::arg("threads") = 1,
           "is_free() for many poses, independent of set_joints(): bool (n,). bases: (n, 4), or\n"
           "(4,) for all. joint_positions: (n, positions), or (positions,) for all. threads: 0\n"
           "for all; the call releases the interpreter's lock.")
      .def("motions_free", &EnvScene::areMotionsFree, py::arg("bases"), py::arg("joint_positions"),
           py::arg("to_bases"), py::arg("to_joint_positions"), py::kw_only(),
           py::arg("threads") = 1,
           "Whether the robot can move from one pose to another along the straight path, both\n"
           "ends included: bool (n,).\n\n"
           "Arrays: as in are_free(). The base drives along a line and turns the shorter way\n"
           "round; joints move uniformly, those without limits the shorter way round. As with\n"
           "continuous_collision=True, no sphere moves further than its radius between two\n"
           "checked poses; each of these must be free, and the floor must carry the base from\n"
           "one to the next. The heights of `bases` select the floor on which the path begins,\n"
           "and those of `to_bases` where it must end. Spheres that update() or hold() ignored\n"
           "count again once they are free.")
      .def("clearances", &EnvScene::clearances, py::arg("bases"), py::arg("joint_positions"),
           py::arg("most"), py::kw_only(), py::arg("threads") = 1,
           "How far each sphere of the robot, and of what it holds, is from the scene and the\n"
           "resting objects in many poses, independent of set_joints(): Clearances. Arrays: as\n"
           "in are_free(). most, meters, > 0: larger distances are reported as `most`, and\n"
           "deeper penetrations of the scene as -`most`. The smallest distance of a pose is\n"
           "negative exactly if is_free() is False, to within 0.1 mm.\n\n"
           "Distances to objects are exact. Distances to the scene are those to the boundary of\n"
           "the free space in the sphere's column grid, and accurate to half the diagonal of its\n"
           "cells (2.1 cm with cells of 3 cm). Spheres that only the base moves keep their\n"
           "height, so theirs are distances in the horizontal plane; otherwise the floor would\n"
           "be nearest everywhere. Ignored spheres (ignore_penetrating(), count_free()) are\n"
           "`most` away.")
      .def("touches_itself", &EnvScene::touchesItself, py::arg("margin") = 0.0F,
           "Whether the robot touches itself with these joints, or comes closer to itself than\n"
           "`margin`, meters. Links whose spheres touch in the pose at the start of an episode\n"
           "are not checked against each other. The simulation does not check this: its robots\n"
           "pass through themselves.")
      .def("touch_themselves", &EnvScene::touchThemselves, py::arg("joint_positions"),
           py::arg("margin") = 0.0F,
           "touches_itself() for many joint positions, (n, positions): bool (n,).")
      .def("world_from_links", &EnvScene::worldFromLinks, py::arg("bases"),
           py::arg("joint_positions"),
           "The poses of all links in many poses of the robot: Poses of (n, links), in the\n"
           "order of World.links. Arrays: as in are_free().")
      .def("world_from_grips", &EnvScene::worldFromGrips, py::arg("bases"),
           py::arg("joint_positions"),
           "world_from_grip() for many poses of the robot: Poses of (n,). Arrays: as in\n"
           "are_free().")
      .def("bases_of", &EnvScene::basesOf, py::arg("states"),
           "The bases of n envs, from an EnvStates: float32 (n, 4). The envs may be in any\n"
           "scene.")
      .def("floors_at", &EnvScene::floorsAt, py::arg("bases"),
           "floor_at() for many bases, (n, 4), each from its own height: float32 (n,), NaN\n"
           "where a base cannot stand. The yaw is ignored.")
      .def("grasped_at", &EnvScene::graspedAt, py::arg("base"),
           "Index of the object that the hand would grasp if it closed here, or None.")
      .def("hold", &EnvScene::hold, py::arg("object"), py::arg("base"),
           "Holds an object as if it had been grasped here: its spheres that penetrate\n"
           "something are ignored, see ignore_penetrating(). Raises galactic.Error if the hand\n"
           "is not empty.")
      .def("put_back", &EnvScene::putBack,
           "Puts the object that hold() took back where it rested. Raises galactic.Error if\n"
           "hold() took nothing.")
      .def_property_readonly("is_holding", &EnvScene::isHolding,
                             "Whether the hand holds something, from the env or by hold().")
      .def("ignore_penetrating", &EnvScene::ignorePenetrating, py::arg("base"),
           "From now on, ignores those spheres of the held object that penetrate something\n"
           "here, and no others. update() and hold() do so where the robot is, and where the\n"
           "object was grasped. Does nothing if the hand is empty.")
      .def("count_free", &EnvScene::countFree, py::arg("base"),
           "Ignored spheres of the held object and of the robot that are free here count again.\n"
           "The simulation does this wherever a robot moves: call it along a path from where an\n"
           "object was grasped or released.")
      .def("landing", &EnvScene::landing, py::arg("base"),
           "Pose in which the held object comes to rest if it is released here, without random\n"
           "jitter, or None if it finds no place. Raises galactic.Error if the hand is empty.");
  type.attr("__module__") = "galactic";
  refusePickling(type, "make one from its simulator");
}

}  // namespace galactic::python
