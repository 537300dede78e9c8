#pragma once
#include <span>

#include "galactic/batch_simulator.h"
#include "galactic/episode_set.h"
#include "galactic/world.h"

namespace galactic::simulation {

/// The objects of a state that was passed to `call` (such as "RayCaster"): all of its episode, or
/// its target alone. A state does not name its world. Throws ErrorException with kInvalidInput if
/// it cannot be from this one: if there is no such scene, episode or held object, if the episode is
/// in another scene or has another number of objects, or if the robot has another number of joint
/// positions. Also throws if a number is not finite or a rotation not of unit length
/// (faultOfNumbers()).
[[nodiscard]] std::span<const Placement> checkedObjects(const char* call, const World& world,
                                                        const EnvState& state);

}  // namespace galactic::simulation
