#pragma once
#include <span>

#include "galactic/batch_simulator.h"
#include "galactic/episode_set.h"
#include "galactic/world.h"

namespace galactic::simulation {

/// The objects of a state that somebody hands to `call` ("RayCaster"): all of its episode, or its
/// target alone. A state does not say of which world it is: throws ErrorException with
/// kInvalidInput where it cannot be of this one, as there is no such scene, episode or held object,
/// or the episode is in another scene or has another number of objects, or the robot of joint
/// positions; and where a number is not finite or a rotation is none (faultOfNumbers()).
[[nodiscard]] std::span<const Placement> checkedObjects(const char* call, const World& world,
                                                        const EnvState& state);

}  // namespace galactic::simulation
