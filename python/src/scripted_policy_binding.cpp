#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "arrays.h"
#include "bindings.h"
#include "galactic/error.h"
#include "options.h"
#include "scripted/scripted_policy.h"
#include "simulator.h"

namespace galactic::python {
namespace {

/// galactic.ScriptedPolicy: acts in the envs of a simulator, which it keeps alive.
class Expert {
 public:
  Expert(const py::object& simulator, const py::object& most_plans)
      : simulator_(&simulatorOf(simulator)),
        policy_(
            orThrow(ScriptedPolicy::create(simulator_->world(), simulator_->batch().options()))) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
    policy_.allowPlans(static_cast<std::uint32_t>(wholeOf("most_plans", most_plans, 1, kMost)));
  }

  py::array_t<float> act(const py::object& mask) {
    const Confinement::Use use = confinement_.enter();
    const Confinement::Use reading = simulator_->readState();
    const BatchSimulator& batch = simulator_->batch();
    const auto chosen = mask.is_none() ? InputArray<std::uint8_t>()
                                       : inputOf<std::uint8_t>(mask, "mask", {simulator_->envs()});
    const std::span<const std::uint8_t> where(chosen.data(),
                                              static_cast<std::size_t>(chosen.size()));
    py::array_t<float> actions({batch.envCount(), batch.actionCount()});
    const std::span<float> rows(actions.mutable_data(), static_cast<std::size_t>(actions.size()));
    std::ranges::fill(rows, 0.0F);
    const py::gil_scoped_release unlocked;
    policy_.act(batch, rows, where);
    return actions;
  }

  [[nodiscard]] std::size_t envs() const { return simulator_->batch().envCount(); }
  [[nodiscard]] py::array_t<std::uint8_t> phases() {
    return perEnv([&](std::size_t env) { return policy_.phase(env); });
  }
  [[nodiscard]] py::array_t<std::uint8_t> troubles() {
    return perEnv([&](std::size_t env) { return policy_.trouble(env); });
  }

 private:
  template <class Value>
  [[nodiscard]] py::array_t<std::uint8_t> perEnv(const Value& value) {
    const Confinement::Use use = confinement_.enter();
    py::array_t<std::uint8_t> numbers(simulator_->envs());
    for (std::size_t env = 0; env < envs(); ++env) {
      numbers.mutable_data()[env] = static_cast<std::uint8_t>(value(env));
    }
    return numbers;
  }

  Simulator* simulator_;
  Confinement confinement_{"ScriptedPolicy"};
  ScriptedPolicy policy_;
};

}  // namespace

void bindScriptedPolicy(py::module_& module) {
  bindEnum(module, "ScriptedPhase",
           {{"PICK", static_cast<int>(ScriptedPhase::kPick)},
            {"PLACE", static_cast<int>(ScriptedPhase::kPlace)},
            {"FINISH", static_cast<int>(ScriptedPhase::kFinish)},
            {"GAVE_UP", static_cast<int>(ScriptedPhase::kGaveUp)}},
           "What a ScriptedPolicy is doing in an env.");
  bindEnum(module, "ScriptedTrouble",
           {{"NONE", static_cast<int>(ScriptedTrouble::kNone)},
            {"NO_WAY_TO_TARGET", static_cast<int>(ScriptedTrouble::kNoWayToTarget)},
            {"NO_WAY_TO_GOAL", static_cast<int>(ScriptedTrouble::kNoWayToGoal)},
            {"NO_GRASP", static_cast<int>(ScriptedTrouble::kNoGrasp)},
            {"NO_PLACEMENT", static_cast<int>(ScriptedTrouble::kNoPlacement)},
            {"NO_FOLD", static_cast<int>(ScriptedTrouble::kNoFold)},
            {"STUCK", static_cast<int>(ScriptedTrouble::kStuck)},
            {"MISSED", static_cast<int>(ScriptedTrouble::kMissed)}},
           "Why a ScriptedPolicy gave up, or planned anew.");
  py::class_<Expert> type(module, "ScriptedPolicy");
  type.def(
      py::init<const py::object&, const py::object&>(), py::arg("simulator"), py::kw_only(),
      py::arg("most_plans") = ScriptedPolicy::kMostPlans, py::keep_alive<1, 2>(),
      "simulator: the simulator in whose envs the policy acts. Raises Error if its task is\n"
      "'none', or if every action or no action grasps, lets go or terminates (grasp_from,\n"
      "release_below, terminate_from). most_plans: how often it plans in an episode before it\n"
      "gives up. A plan takes tens of milliseconds; plans are made by as many threads as the\n"
      "simulator has.");
  type.doc() =
      "Solves Rearrange and Mobile Pick with a plan, made from the full state of each env: an\n"
      "expert to imitate or to compare with. galactic-run's --policy scripted is the same.";
  type.def(
      "act", &Expert::act, py::arg("mask") = py::none(),
      "The actions of the next step of all envs: float32 (num_envs, action_count), for\n"
      "Simulator.step. You may step with other actions, such as those of a policy that learns\n"
      "from it: if the robot has left the planned path, the policy steers back or plans anew.\n"
      "Where it has given up, or an env is idle, actions are 0, except that the hand keeps what\n"
      "it holds.\n\n"
      "mask: bool or uint8 (num_envs,), the envs to plan and act in; in others, actions are 0.");
  type.def_property_readonly("phases", &Expert::phases,
                             "What the last act() did in each env, as values of ScriptedPhase:\n"
                             "uint8 (num_envs,), a copy.");
  type.def_property_readonly(
      "troubles", &Expert::troubles,
      "Why it gave up or planned anew in each env, as values of ScriptedTrouble: uint8\n"
      "(num_envs,), a copy.");
  type.def("__repr__", [](const Expert& one) {
    return fmt::format("<galactic.ScriptedPolicy in {} envs>", one.envs());
  });
  type.attr("__module__") = "galactic";
  refusePickling(type, "make one from its simulator");
}

}  // namespace galactic::python
