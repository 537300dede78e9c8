// Forward kinematics of many robots: eight at a time as the batch simulation does it (spheres, grip
// and bodies), one at a time (all links), and Bullet's multibody (all links), in one run:
//
//   GALACTIC_BENCH_ROBOT=fetch.pack batch_kinematics
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "galactic/kinematics.h"
#include "galactic/pack.h"
#include "galactic/robot.h"
#include "simulation/motion/motion_kernels.h"
#include "simulation/motion/motion_model.h"

namespace {

using namespace galactic;

/// As many robots as fit into the nearest caches.
constexpr std::size_t kRobots = 128;

btQuaternion toBullet(const Quat& q) { return {q.x, q.y, q.z, q.w}; }
btVector3 toBullet(const Vec3& v) { return {v.x, v.y, v.z}; }

/// The pack and the robot in it; ends the program when there is none.
const Robot& benchmarkRobot() {
  static const PackFile pack = [] {
    const char* path = std::getenv("GALACTIC_BENCH_ROBOT");
    Result<PackFile> opened = PackFile::open(path == nullptr ? "" : path);
    if (opened) return std::move(*opened);
    std::fprintf(stderr, "GALACTIC_BENCH_ROBOT: %s\n", opened.error().message.c_str());
    std::exit(2);
  }();
  static const Robot robot = [] {
    Result<Robot> made = Robot::from(pack);
    if (made) return std::move(*made);
    std::fprintf(stderr, "GALACTIC_BENCH_ROBOT: %s\n", made.error().message.c_str());
    std::exit(2);
  }();
  return robot;
}

/// Joint positions of all robots, within the limits.
std::vector<float> randomPositions(const Robot& robot) {
  std::mt19937 random(1);
  std::vector<float> positions;
  positions.reserve(kRobots * robot.positionCount());
  for (std::size_t n = 0; n < kRobots; ++n) {
    for (const PositionLimits& limits : robot.limits()) {
      const float lower = std::max(limits.lower, -std::numbers::pi_v<float>);
      const float upper = std::min(limits.upper, std::numbers::pi_v<float>);
      positions.push_back(lower + (upper - lower) * static_cast<float>(random()) * 0x1p-32F);
    }
  }
  return positions;
}

void batched(benchmark::State& state) {
  const Robot& robot = benchmarkRobot();
  const auto model = simulation::makeMotionModel(robot, {});
  if (!model) {
    state.SkipWithError(model.error().message.c_str());
    return;
  }
  const simulation::MotionTables tables = simulation::motionTables(*model);
  const simulation::MotionKernels kernels =
      state.range(0) == 0 ? simulation::portableMotion() : simulation::motionKernels();
  const std::vector<float> positions = randomPositions(robot);
  std::vector<float> x(kRobots, 1.0F);
  std::vector<float> y(kRobots);
  std::vector<float> z(kRobots, 2.0F);
  std::vector<float> yaw(kRobots, 0.5F);
  std::vector<float> variables(model->variables.size() * kRobots);
  for (std::size_t v = 0; v < model->variables.size(); ++v) {
    for (std::size_t n = 0; n < kRobots; ++n) {
      variables[v * kRobots + n] =
          positions[n * robot.positionCount() + model->variables[v].position];
    }
  }
  constexpr std::size_t kWidth = simulation::kMostWidth;
  std::vector<simulation::EnvRow> frames(simulation::frameRows(model->nodes.size()));
  const std::vector<std::uint32_t> all(kWidth, ~std::uint32_t{0});
  std::vector<float> centers(3 * model->spheres.size() * kRobots);
  std::vector<simulation::EnvRow> grips(simulation::kGripNumbers);
  std::vector<float> bodies(frames.size() * kRobots);
  for (auto _ : state) {
    for (std::size_t n = 0; n < kRobots; n += kWidth) {
      kernels.place(tables, {.pose = {x.data() + n, y.data() + n, z.data() + n, yaw.data() + n,
                                      variables.data() + n, kRobots},
                             .body = {.frames = frames.front().values,
                                      .centers = centers.data() + 3 * model->spheres.size() * n,
                                      .grips = grips.front().values},
                             .envs = kWidth});
      kernels.put_frames({.frames = frames.front().values,
                          .rows = frames.size(),
                          .wanted = all.data(),
                          .to = bodies.data() + frames.size() * n,
                          .envs = kWidth});
    }
    benchmark::DoNotOptimize(centers.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kRobots));
}

void oneByOne(benchmark::State& state) {
  const Robot& robot = benchmarkRobot();
  const std::vector<float> positions = randomPositions(robot);
  std::vector<Pose> poses(robot.links().size());
  for (auto _ : state) {
    for (std::size_t n = 0; n < kRobots; ++n) {
      const auto row = std::span(positions).subspan(n * robot.positionCount());
      forwardKinematics(robot.links(), {{1, 0, 2}, {}}, row.first(robot.positionCount()), poses);
      benchmark::DoNotOptimize(poses.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kRobots));
}

/// The robot as a multibody of massless links; link n of the robot is Bullet's n - 1.
std::unique_ptr<btMultiBody> bulletRobot(const Robot& robot) {
  const auto links = robot.links();
  const btVector3 none(0, 0, 0);
  auto body =
      std::make_unique<btMultiBody>(static_cast<int>(links.size()) - 1, 0, none, true, false);
  for (int n = 1; n < static_cast<int>(links.size()); ++n) {
    const LinkFrame& link = links[static_cast<std::size_t>(n)];
    const int parent = link.parent - 1;
    const btQuaternion turn = toBullet(conjugate(link.parent_from_joint.rotation));
    const btVector3 offset = toBullet(link.parent_from_joint.translation);
    const btVector3 axis = toBullet(link.axis);
    if (link.type == JointType::kRevolute || link.type == JointType::kContinuous) {
      body->setupRevolute(n - 1, 1, none, parent, turn, axis, offset, none);
    } else if (link.type == JointType::kPrismatic) {
      body->setupPrismatic(n - 1, 1, none, parent, turn, axis, offset, none, true);
    } else {
      body->setupFixed(n - 1, 1, none, parent, turn, offset, none);
    }
  }
  body->finalizeMultiDof();
  return body;
}

void bullet(benchmark::State& state) {
  const Robot& robot = benchmarkRobot();
  const std::vector<float> positions = randomPositions(robot);
  const std::unique_ptr<btMultiBody> body = bulletRobot(robot);
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> vectors;
  for (auto _ : state) {
    for (std::size_t n = 0; n < kRobots; ++n) {
      const float* row = positions.data() + n * robot.positionCount();
      body->setBasePos(btVector3(1, 0, 2));
      for (std::size_t link = 1; link < robot.links().size(); ++link) {
        const std::int32_t position = robot.links()[link].position;
        if (position >= 0) body->setJointPos(static_cast<int>(link) - 1, row[position]);
      }
      body->forwardKinematics(rotations, vectors);
      benchmark::DoNotOptimize(body->getLink(0).m_cachedWorldTransform);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kRobots));
}

BENCHMARK(batched)->ArgName("avx2")->Arg(1)->Arg(0);
BENCHMARK(oneByOne);
BENCHMARK(bullet);

}  // namespace

BENCHMARK_MAIN();
