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

/// Rows of `columns` finite numbers, (n, columns), or one for all, (columns,).
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

/// How many rows arrays of such names have together, where one may be for all of the others.
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

/// Poses of a robot, for C++.
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

/// galactic.Clearances in the making.
class MadeClearances {
 public:
  MadeClearances(std::size_t poses, std::size_t spheres, std::size_t positions)
      : shape_{static_cast<py::ssize_t>(poses), static_cast<py::ssize_t>(spheres)},
        clearances_(poses * spheres),
        bases_(withLast(kBaseNumbers)),
        joints_(withLast(positions)) {}

  // Where C++ writes.
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
  /// The link that carries each sphere, what is held included.
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

/// galactic.PlanningScene: a PlanningScene of one env of a simulator, which it keeps. Calls of
/// several threads come one after the other, under the interpreter's lock; what gives it away works
/// with a copy.
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
  /// Of x, y, z and yaw.
  static BasePlace placeOf(const py::object& base) {
    const std::vector<float> numbers = finiteNumbers(base, "base", kBaseNumbers);
    return {{numbers[0], numbers[1], numbers[2]}, numbers[3]};
  }

  [[nodiscard]] const Robot& robot() const { return simulator_->world().robot(); }
  [[nodiscard]] std::size_t positionCount() const { return robot().positionCount(); }
  static void requireFinite(float margin) {
    if (!std::isfinite(margin)) throw py::value_error("margin is not a finite number");
  }

  /// galactic.Poses of (n, `each`), or of (n,) where that is 0: what `put` makes of the links of
  /// each row.
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

  /// A state itself, or that of an env.
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
      .def(
          "is_free", &EnvScene::isFree, py::arg("base"),
          "Whether neither the robot nor what it holds penetrates anything. What carries the base\n"
          "is another question, floor_at(): half a meter above the floor, a base is free.")
      .def("floor_at", &EnvScene::floorAt, py::arg("x"), py::arg("z"), py::arg("from_height"),
           "Height of the floor for a base that comes from a height, meters; None where it\n"
           "cannot stand.")
      .def("are_free", &EnvScene::areFree, py::arg("bases"), py::arg("joint_positions"),
           py::kw_only(), py::arg("threads") = 1,
           "is_free() of many poses, whatever set_joints() has said: bool (n,).\n\n"
           "bases: (n, 4), or (4,) for all. joint_positions: (n, positions), or (positions,) for\n"
           "all. threads: 0 for all; the interpreter goes on meanwhile.")
      .def(
          "motions_free", &EnvScene::areMotionsFree, py::arg("bases"), py::arg("joint_positions"),
          py::arg("to_bases"), py::arg("to_joint_positions"), py::kw_only(), py::arg("threads") = 1,
          "Whether the robot gets from one pose to another on the straight way, both ends\n"
          "included: bool (n,).\n\n"
          "Arrays: as of are_free(). The base drives along a line, turning the shorter way round,\n"
          "and joints move evenly, those without limits the shorter way round. As with\n"
          "continuous_collision=True, no sphere moves further than its radius from one place that\n"
          "is looked at to the next; each has to be free, on a floor that carries the base from\n"
          "one to the next. The height of `bases` says which floor, that of `to_bases` where the\n"
          "way ends. What update() or hold() ignored counts from where it is free on.")
      .def(
          "clearances", &EnvScene::clearances, py::arg("bases"), py::arg("joint_positions"),
          py::arg("most"), py::kw_only(), py::arg("threads") = 1,
          "How far each sphere of the robot, and of what it holds, is from the scene and the "
          "objects\n"
          "at rest in many poses, whatever set_joints() has said: Clearances.\n\n"
          "Arrays: as of are_free(). most, meters, > 0: what is farther is not looked for, and "
          "the\n"
          "distance is `most`; -`most` where the scene is penetrated deeper. The least distance of "
          "a\n"
          "pose is below 0 where is_free() says False, and only there, to 0.1 mm.\n\n"
          "Objects are exact. Of the scene, distances are those to where the sphere's column grid\n"
          "says free no more, or again: exact to its cells, which are up to half their diagonal "
          "off\n"
          "(2.1 cm with cells of 3 cm). Spheres that only the base moves keep their height: "
          "theirs\n"
          "are the distances in the horizontal plane, or the floor would be nearest everywhere.\n"
          "Those that do not count (ignore_penetrating(), count_free()) are `most` away.")
      .def("touches_itself", &EnvScene::touchesItself, py::arg("margin") = 0.0F,
           "Whether the robot touches itself with these joints, or comes nearer to that than\n"
           "`margin`, meters. Spheres of links that touch where an episode starts do not count.\n"
           "The simulation does not ask: its robots pass through themselves.")
      .def("touch_themselves", &EnvScene::touchThemselves, py::arg("joint_positions"),
           py::arg("margin") = 0.0F,
           "touches_itself() for many joint positions, (n, positions): bool (n,).")
      .def("world_from_links", &EnvScene::worldFromLinks, py::arg("bases"),
           py::arg("joint_positions"),
           "The poses of all links in many poses of the robot: Poses of (n, links), in the order "
           "of\n"
           "World.links. Arrays: as of are_free().")
      .def("world_from_grips", &EnvScene::worldFromGrips, py::arg("bases"),
           py::arg("joint_positions"),
           "The poses of the hand in them, as world_from_grip() has one: Poses of (n,).")
      .def("bases_of", &EnvScene::basesOf, py::arg("states"),
           "The bases of n envs, of an EnvStates, whatever scenes they are in: float32 (n, 4).")
      .def("floors_at", &EnvScene::floorsAt, py::arg("bases"),
           "Heights of the floor for bases, (n, 4), that come from their y: float32 (n,), NaN "
           "where\n"
           "one cannot stand. The yaw plays no part.")
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
