// One pack, or one object of a set, that runs out of memory is no other's fault and ends no other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "galactic/bake/build.h"
#include "support/mesh_files.h"
#include "support/scratch_folder.h"

namespace galactic::test::lost_memory_test {
namespace {

namespace fs = std::filesystem;

using bake::BuildOutcome;
using bake::PackJob;
using bake::PackState;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

/// Throws what a bake throws, in the middle of the bake of one input.
class ThrowingObserver final : public bake::BuildObserver {
 public:
  explicit ThrowingObserver(std::function<void()> fault) : fault_(std::move(fault)) {}
  void show(std::string_view item, std::string_view stage, double /*fraction*/) override {
    if (item == "big.obj" && stage == "render meshes") fault_();
  }
  void end(const bake::PackOutcome& /*pack*/) override { ++ended; }

  std::atomic<int> ended{0};

 private:
  std::function<void()> fault_;
};

/// A box of 1 x 2 x 3 times `unit` meters.
std::string boxOf(float unit) {
  MeshContent box = unevenBox();
  for (auto& position : box.positions) {
    for (float& value : position) value *= unit;
  }
  return objFile(box);
}

class ABuildWithoutMemory : public testing::Test {
 protected:
  ABuildWithoutMemory() {
    for (const char* name : {"big", "small"}) addScene(name);
  }

  void addScene(const std::string& name) {
    bake::SceneJob job{.input = folder_.write(name + ".obj", boxOf(0.15F))};
    job.import.scale = 1;
    job.grids.radii = {0.05F};
    job.grids.check_columns = 0;
    packs_.push_back(
        {.name = name + ".pack", .job = job, .output = folder_.path() / (name + ".pack")});
  }

  [[nodiscard]] BuildOutcome buildWith(const std::function<void()>& fault) const {
    ThrowingObserver observer(fault);
    bake::BakeLibraries libraries;
    BuildOutcome outcome = bake::build(packs_, {.keep_going = true}, observer, libraries);
    EXPECT_EQ(observer.ended, 2) << "somebody was not told";
    return outcome;
  }
  /// Sees that the big one failed and the other is there.
  void expectOneLost(const BuildOutcome& outcome) const {
    ASSERT_THAT(outcome.packs, SizeIs(2));
    EXPECT_EQ(outcome.packs[0].state, PackState::kFailed);
    EXPECT_FALSE(outcome.packs[0].figures);
    EXPECT_THAT(outcome.packs[0].failures, SizeIs(1));
    EXPECT_EQ(outcome.packs[1].state, PackState::kBaked);
    EXPECT_FALSE(fs::exists(folder_.path() / "big.pack"));
    EXPECT_TRUE(fs::exists(folder_.path() / "small.pack"));
  }

  ScratchFolder folder_;
  std::vector<PackJob> packs_;
};

TEST_F(ABuildWithoutMemory, GoesOnWithTheNextPackAndNamesTheInput) {
  for (const std::function<void()>& fault :
       {std::function<void()>([] { throw std::bad_alloc(); }),
        std::function<void()>([] { throw std::length_error("vector"); })}) {
    const BuildOutcome outcome = buildWith(fault);
    expectOneLost(outcome);
    const Error& error = *outcome.firstError();
    EXPECT_EQ(error.code, ErrorCode::kUnsupported);
    EXPECT_EQ(error.where, (folder_.path() / "big.obj").string() + ": available memory");
    EXPECT_THAT(error.message, StartsWith("this needs more than"));
    fs::remove(folder_.path() / "small.pack");
  }
}

TEST_F(ABuildWithoutMemory, SaysOfAFileWhichItIs) {
  const BuildOutcome outcome = buildWith([] {
    throw fs::filesystem_error("status", "/a/file", std::make_error_code(std::errc::io_error));
  });
  expectOneLost(outcome);
  EXPECT_EQ(outcome.firstError()->code, ErrorCode::kIo);
  EXPECT_EQ(outcome.firstError()->where, "/a/file");
}

TEST_F(ABuildWithoutMemory, TakesAnyOtherExceptionForABug) {
  const BuildOutcome outcome = buildWith([] { throw std::runtime_error("odd"); });
  expectOneLost(outcome);
  EXPECT_EQ(outcome.firstError()->code, ErrorCode::kInternal);
  EXPECT_EQ(outcome.firstError()->message, "odd; please report it");
}

/// Kills the first process that this one starts, as a system does whose memory runs out.
class KillerOfAReader {
 public:
  ~KillerOfAReader() { stop_ = true; }
  [[nodiscard]] bool hasKilled() const { return has_killed_; }

 private:
  void watch() {
    while (!stop_ && !has_killed_) {
      const std::optional<pid_t> child = anyChild();
      has_killed_ = child && ::kill(*child, SIGKILL) == 0;
    }
  }
  static std::optional<pid_t> anyChild() {
    for (const auto& thread : fs::directory_iterator("/proc/self/task")) {
      std::ifstream children(thread.path() / "children");
      pid_t child = 0;
      if (children >> child) return child;
    }
    return std::nullopt;
  }

  std::atomic<bool> stop_{false};
  std::atomic<bool> has_killed_{false};
  std::jthread thread_{[this] { watch(); }};
};

TEST_F(ABuildWithoutMemory, GoesOnWithTheNextObjectOfASet) {
  bake::ObjectJob job;
  for (const char* name : {"a.obj", "b.obj", "c.obj"}) {
    job.inputs.push_back(folder_.write(name, boxOf(0.03F)));
  }
  job.shape.spheres.radii = {0.03F, 0.05F};
  job.shape.spheres.eps = 0.02F;
  job.shape.spheres.tau = 0.03F;
  bake::ReadLog log;
  bake::BakeLibraries libraries;
  bake::BakeContext context{.output = folder_.path() / "things.pack",
                            .log = log,
                            .libraries = libraries,
                            .keep_going = true};
  const KillerOfAReader killer;
  const auto made = bakeObjectFiles(job, context);
  ASSERT_TRUE(killer.hasKilled());
  ASSERT_TRUE(made) << made.error().text();
  const auto& outcome = std::get<bake::ObjectSetOutcome>(made->outcome);
  EXPECT_THAT(outcome.objects, SizeIs(2));
  ASSERT_THAT(outcome.failures, SizeIs(1));
  const bake::BakeFailure& failure = outcome.failures.front();
  EXPECT_EQ(failure.error.where, failure.input.string() + ": a process that reads files");
  EXPECT_THAT(failure.error.message, HasSubstr("was killed from outside"));
  EXPECT_TRUE(fs::exists(context.output));
}

}  // namespace
}  // namespace galactic::test::lost_memory_test
