#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/robot.h"
#include "simulation/motion/motion_kernels.h"
#include "support/assets.h"
#include "support/oracles/resting_oracle.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::test {

/// A robot in memory with its motion model.
struct MotionRobot {
  AlignedBytes bytes;
  std::unique_ptr<PackFile> pack;
  std::unique_ptr<Robot> robot;
  simulation::MotionModel model;
  simulation::MotionTables tables;

  /// `also_variable`: see makeMotionModel.
  MotionRobot(AlignedBytes file, const std::vector<std::uint32_t>& also_variable)
      : bytes(std::move(file)) {
    pack = std::make_unique<PackFile>(PackFile::view(bytes.bytes(), "robot").value());
    robot = std::make_unique<Robot>(Robot::from(*pack).value());
    model = simulation::makeMotionModel(*robot, also_variable).value();
    tables = simulation::motionTables(model);
  }
};

/// Sixteen envs in rows longer than that, so that a kernel that mixes up strides is found out.
class MotionBatch {
 public:
  static constexpr std::size_t kEnvs = simulation::kMostWidth;
  static constexpr std::size_t kStride = kEnvs + 3;

  explicit MotionBatch(const MotionRobot& robot)
      : robot_(robot),
        actions_(actionCount()),
        variables_(kStride * robot.model.variables.size()),
        moved_variables_(variables_.size()),
        centers_(kEnvs * 3 * robot.model.spheres.size()),
        grips_(simulation::kGripNumbers),
        bodies_(kEnvs * bodyCount()),
        bounds_(kEnvs * simulation::kBounds * groupStride() / simulation::kLanes),
        frames_(simulation::frameRows(robot.model.nodes.size())) {}

  [[nodiscard]] std::size_t actionCount() const {
    return ActionLayout{robot_.model.controlled.size(), robot_.model.base.sideways_step > 0}
        .count();
  }
  [[nodiscard]] std::size_t bodyCount() const { return robot_.model.nodes.size() + 1; }
  [[nodiscard]] std::size_t groupStride() const {
    return simulation::paddedToLanes(robot_.model.spheres.size() / simulation::kLanes);
  }
  /// Bound b of group n.
  [[nodiscard]] float bound(std::size_t env, std::size_t b, std::size_t group) const {
    return bounds_.data()->data()[(simulation::kBounds * env + b) * groupStride() + group];
  }
  [[nodiscard]] float extent(std::size_t env, std::size_t b) const { return extents_[env][b]; }

  /// Poses and variables anywhere in their ranges, often at an end; actions often 0 or +-1.
  void draw(std::mt19937& random) {
    constexpr float kPi = 3.14159265F;
    for (std::size_t env = 0; env < kEnvs; ++env) {
      x[env] = uniformIn(random, -8, 8);
      y[env] = uniformIn(random, -1, 4);
      z[env] = uniformIn(random, -8, 8);
      yaw[env] = random() % 8 == 0 ? -kPi : uniformIn(random, -kPi, kPi);
      for (std::size_t v = 0; v < robot_.model.variables.size(); ++v) {
        variable(v, env) = drawVariable(robot_.model.variables[v], random);
      }
    }
    constexpr std::array kSpecial{-1.0F, 0.0F, 1.0F};
    for (std::size_t env = 0; env < kEnvs; ++env) {
      for (simulation::EnvRow& row : actions_) {
        const bool is_special = random() % 4 == 0;
        row.values[env] =
            is_special ? kSpecial[random() % kSpecial.size()] : uniformIn(random, -1, 1);
      }
    }
  }

  /// The first `envs` of them; likewise below.
  void move(const simulation::MotionKernels& kernels, std::size_t envs = kEnvs) {
    kernels.move(robot_.tables, {.actions = actions_.front().values,
                                 .joints = robot_.model.controlled.size(),
                                 .from = poses(),
                                 .to = {.x = moved_x.data(),
                                        .y = moved_y.data(),
                                        .z = moved_z.data(),
                                        .yaw = moved_yaw.data(),
                                        .variables = moved_variables_.data(),
                                        .stride = kStride},
                                 .envs = envs});
  }

  void place(const simulation::MotionKernels& kernels, std::size_t envs = kEnvs) {
    kernels.place(robot_.tables, {.pose = poses(),
                                  .body = {.frames = frames_.front().values,
                                           .centers = centers_.data(),
                                           .grips = grips_.front().values,
                                           .bounds = bounds_.data()->data(),
                                           .extents = extents_.data()->data()},
                                  .envs = envs});
    kernels.put_frames({.frames = frames_.front().values,
                        .rows = frames_.size(),
                        .wanted = wanted.data(),
                        .to = &bodies_.front().x_axis.x,
                        .envs = envs});
  }

  [[nodiscard]] float& action(std::size_t env, std::size_t n) { return actions_[n].values[env]; }
  [[nodiscard]] float& variable(std::size_t v, std::size_t env) {
    return variables_[v * kStride + env];
  }
  [[nodiscard]] float movedVariable(std::size_t v, std::size_t env) const {
    return moved_variables_[v * kStride + env];
  }
  [[nodiscard]] Vec3 center(std::size_t env, std::size_t sphere) const {
    const std::size_t count = robot_.model.spheres.size();
    const float* row = centers_.data() + 3 * env * count;
    return {row[sphere], row[count + sphere], row[2 * count + sphere]};
  }
  [[nodiscard]] std::array<float, simulation::kGripNumbers> grip(std::size_t env) const {
    std::array<float, simulation::kGripNumbers> grip;
    for (std::size_t n = 0; n < grip.size(); ++n) grip[n] = grips_[n].values[env];
    return grip;
  }
  [[nodiscard]] const RigidTransform& body(std::size_t env, std::size_t n) const {
    return bodies_[env * bodyCount() + n];
  }

  /// Bits of everything that the kernels write.
  [[nodiscard]] std::vector<std::uint32_t> moved() const {
    std::vector<std::uint32_t> bits;
    for (const auto& values : {moved_x, moved_y, moved_z, moved_yaw}) append(values, bits);
    append(moved_variables_, bits);
    return bits;
  }
  [[nodiscard]] std::vector<std::uint32_t> placed() const {
    std::vector<std::uint32_t> bits;
    append(centers_, bits);
    for (const simulation::EnvRow& row : grips_) append(row.values, bits);
    for (const AlignedEight& eight : bounds_) append(eight, bits);
    for (const AlignedEight& eight : extents_) append(eight, bits);
    for (const RigidTransform& body : bodies_) {
      append(std::bit_cast<std::array<float, 12>>(body), bits);
    }
    return bits;
  }

  std::array<float, kEnvs> x{}, y{}, z{}, yaw{};
  /// The envs whose bodies are placed.
  std::array<std::uint32_t, kEnvs> wanted = allEnvs();
  std::array<float, kEnvs> moved_x{}, moved_y{}, moved_z{}, moved_yaw{};

 private:
  struct alignas(32) AlignedEight : std::array<float, simulation::kLanes> {};

  static constexpr std::array<std::uint32_t, kEnvs> allEnvs() {
    std::array<std::uint32_t, kEnvs> all{};
    for (std::uint32_t& lane : all) lane = ~std::uint32_t{0};
    return all;
  }

  simulation::PoseArrays poses() {
    return {.x = x.data(),
            .y = y.data(),
            .z = z.data(),
            .yaw = yaw.data(),
            .variables = variables_.data(),
            .stride = kStride};
  }

  static float drawVariable(const simulation::MotionVariable& variable, std::mt19937& random) {
    constexpr float kPi = 3.14159265F;
    const float lower = std::max(variable.lower, -kPi);
    const float upper = std::min(variable.upper, kPi);
    switch (random() % 8) {
      case 0:
        return lower;
      case 1:
        return variable.wraps ? lower : upper;
      default:
        return uniformIn(random, lower, upper);
    }
  }

  template <class Values>
  static void append(const Values& values, std::vector<std::uint32_t>& bits) {
    for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  }

  const MotionRobot& robot_;
  std::vector<simulation::EnvRow> actions_;
  std::vector<float> variables_;
  std::vector<float> moved_variables_;
  std::vector<float> centers_;
  std::vector<simulation::EnvRow> grips_;
  std::vector<RigidTransform> bodies_;
  std::vector<AlignedEight> bounds_;
  std::array<AlignedEight, kEnvs> extents_{};
  std::vector<simulation::EnvRow> frames_;
};

}  // namespace galactic::test
