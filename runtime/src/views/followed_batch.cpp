#include "views/followed_batch.h"

#include <fmt/format.h>

#include "support/call_check.h"

namespace galactic::views {

void requireBodies(const char* call, const BatchSimulator& simulator) {
  if (!simulator.bodyTransforms().empty()) return;
  detail::refuseCall(call,
                     "found a simulator without poses of bodies; make it with "
                     "SimulationOptions::body_transforms");
}

void requireSameBatch(const char* call, const BatchSimulator& simulator, std::size_t envs,
                      std::size_t bodies) {
  requireBodies(call, simulator);
  if (simulator.envCount() >= envs && simulator.bodyCount() == bodies) return;
  detail::refuseCall(
      call,
      fmt::format("found a simulator of {} envs with {} bodies each, expected the one that the "
                  "views were made for: {} envs, {} bodies",
                  simulator.envCount(), simulator.bodyCount(), envs, bodies));
}

}  // namespace galactic::views
