#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct EpisodeSet;
struct ObjectSet;
struct Policy;
struct Robot;
struct Scene;
}  // namespace galactic::schema

namespace galactic::detail {

// These functions check every value of a pack whose structure has been verified.

/// Does not check that the names in the set exist: World does, which has the scenes, objects and
/// robot.
[[nodiscard]] Result<void> checkEpisodeSet(const schema::EpisodeSet& set, const std::string& where);

[[nodiscard]] Result<void> checkObjectSet(const schema::ObjectSet& set, const std::string& where);

/// A policy that passes runs on any observation and image. Whether it fits a robot is checked when
/// the two meet.
[[nodiscard]] Result<void> checkPolicy(const schema::Policy& policy, const std::string& where);

/// A robot that passes is safe for forwardKinematics.
[[nodiscard]] Result<void> checkRobot(const schema::Robot& robot, const std::string& where);

/// `file` is the whole pack.
[[nodiscard]] Result<void> checkScene(const schema::Scene& scene, std::span<const std::byte> file,
                                      const std::string& where);

}  // namespace galactic::detail
