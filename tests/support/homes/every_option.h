#pragma once
#include "galactic/simulation_options.h"

namespace galactic::test {

// Options of which none has its default: what has to know every one of them is tested with these.
// option_lines_test sees that none is left out.

inline SensorOptions everySensor() {
  return {.bump = true,
          .target_goal = true,
          .target_up = true,
          .near_objects = 2,
          .laser = {.beams = 8,
                    .fov_degrees = 220,
                    .heights = {{0.25F, 0.25F}, {0.4F, 0.6F}},
                    .range = 4,
                    .least_range = 0.05F,
                    .noise = {0.01F, 0.02F}},
          .geodesic = true,
          .geodesic_megabytes = 512,
          .last_actions = 3};
}

/// But for `kind` and the rules by which episodes end: `needs_terminate`, `drop_fails`,
/// `distractors` and `terminate_after`. Of these, tests have cases of their own.
inline TaskOptions everyReward() {
  return {.success_reward = 3,
          .pick_reward = -2,
          .reach_weight = 2.5F,
          .transport_weight = 0.5F,
          .action_weight = 0.25F,
          .geodesic_weight = 0.5F,
          .slack_penalty = 0.125F,
          .failure_penalty = 1.5F,
          .bump_penalty = 0.0625F,
          .knock_penalty = 0.03125F,
          .drop_penalty = 0.375F,
          .tilt_penalty = 0.75F,
          .success_distance = 0.25F,
          .most_steps = 60,
          .observes_current_target = true};
}

}  // namespace galactic::test
