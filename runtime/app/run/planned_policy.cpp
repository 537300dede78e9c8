#include "run/planned_policy.h"

#include <utility>

#include "scripted/scripted_policy.h"
#include "support/try.h"

namespace galactic {
namespace {

class PlannedPolicy final : public Policy {
 public:
  PlannedPolicy(ScriptedPolicy policy, const BatchSimulator& simulator)
      : policy_(std::move(policy)), simulator_(simulator) {}

  Result<void> act(std::uint64_t, std::span<float> actions) override {
    policy_.act(simulator_, actions);
    return {};
  }

  void expectLag(bool lags) override { policy_.expectLag(lags); }

 private:
  ScriptedPolicy policy_;
  const BatchSimulator& simulator_;
};

}  // namespace

Result<std::unique_ptr<Policy>> makePlannedPolicy(const World& world,
                                                  const BatchSimulator& simulator) {
  ASSIGN_OR_RETURN(ScriptedPolicy policy, ScriptedPolicy::create(world, simulator.options()));
  return std::make_unique<PlannedPolicy>(std::move(policy), simulator);
}

}  // namespace galactic
