#include "views/followed_batch.h"

#include <fmt/format.h>

#include "support/call_check.h"

namespace galactic::views {
namespace {

/// Throws unless the state can be read: it must have poses of bodies, and no thread may be changing
/// it.
void requireState(const char* call, const BatchSimulator& simulator) {
  if (simulator.isStepping()) {
    detail::refuseCall(call, "found a step that has begun; end it first, with endStep()");
  }
  if (simulator.bodyTransforms().empty()) {
    detail::refuseCall(call,
                       "found a simulator without poses of bodies; make it with "
                       "SimulationOptions::body_transforms");
  }
}

}  // namespace

void requireParts(const char* call, std::uint64_t models, const BatchSimulator& simulator) {
  if (models != simulator.world().hash()) {
    detail::refuseCall(call,
                       "found models of another world than that of the simulator; make them of "
                       "BatchSimulator::world()");
  }
  requireState(call, simulator);
}

void requireFollowed(const char* call, std::uint64_t world, const BatchSimulator& simulator,
                     std::size_t envs) {
  if (simulator.world().hash() != world) {
    detail::refuseCall(call,
                       "found a simulator of another world than the one that the views were made "
                       "of; make views of that one, too");
  }
  requireState(call, simulator);
  if (simulator.envCount() >= envs) return;
  detail::refuseCall(call, fmt::format("found a simulator of {} envs, expected at least the {} "
                                       "that the views were made for",
                                       simulator.envCount(), envs));
}

}  // namespace galactic::views
