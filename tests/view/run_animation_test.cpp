// An animated scene has everything where the simulator had it.
#include "view/run_animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/kinematics.h"
#include "support/homes/small_home_models.h"

namespace galactic::test::run_animation_test {
namespace {

using nlohmann::json;

/// Composing poses on the way from the root to the hand rounds a little.
constexpr float kTolerance = 1e-5F;
constexpr std::size_t kSteps = 40;

/// A GLB file taken apart: where its nodes are at each key.
class Glb {
 public:
  explicit Glb(const std::string& bytes) {
    constexpr std::size_t kJsonAt = 20;
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + kJsonAt - 8, sizeof length);
    json_ = json::parse(bytes.substr(kJsonAt, length));
    binary_ = bytes.substr(kJsonAt + length + 8);
    for (std::size_t n = 0; n < json_["nodes"].size(); ++n) {
      for (const std::size_t child :
           json_["nodes"][n].value("children", std::vector<std::size_t>{}))
        parents_[child] = n;
    }
  }

  [[nodiscard]] const json& content() const { return json_; }
  [[nodiscard]] std::size_t nodeOf(const std::string& name) const {
    for (std::size_t n = 0; n < json_["nodes"].size(); ++n) {
      if (json_["nodes"][n]["name"] == name) return n;
    }
    throw std::runtime_error("no node " + name);
  }

  [[nodiscard]] Pose worldPose(std::size_t node, std::size_t key) const {
    const Pose local = localPose(node, key);
    const auto parent = parents_.find(node);
    return parent == parents_.end() ? local : worldPose(parent->second, key) * local;
  }

  /// The numbers of an accessor of floats.
  [[nodiscard]] std::vector<float> numbers(std::size_t accessor) const {
    const json& one = json_["accessors"][accessor];
    const std::map<std::string, std::size_t> widths{{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}};
    const json& view = json_["bufferViews"][one["bufferView"].get<std::size_t>()];
    std::vector<float> values(one["count"].get<std::size_t>() *
                              widths.at(one["type"].get<std::string>()));
    std::memcpy(values.data(), binary_.data() + view["byteOffset"].get<std::size_t>(),
                values.size() * sizeof(float));
    return values;
  }

 private:
  [[nodiscard]] Pose localPose(std::size_t node, std::size_t key) const {
    Pose pose;
    const json& stored = json_["nodes"][node];
    if (stored.contains("translation")) {
      const auto t = stored["translation"].get<std::vector<float>>();
      pose.translation = {t[0], t[1], t[2]};
    }
    if (stored.contains("rotation")) {
      const auto q = stored["rotation"].get<std::vector<float>>();
      pose.rotation = {q[0], q[1], q[2], q[3]};
    }
    for (const json& animation : json_.value("animations", json::array())) {
      for (const json& channel : animation["channels"]) {
        if (channel["target"]["node"] != node) continue;
        const auto values =
            numbers(animation["samplers"][channel["sampler"].get<std::size_t>()]["output"]);
        const float* const at = values.data() + key * (values.size() / keyCount());
        if (channel["target"]["path"] == "translation") {
          pose.translation = {at[0], at[1], at[2]};
        } else {
          pose.rotation = {at[0], at[1], at[2], at[3]};
        }
      }
    }
    return pose;
  }

 public:
  [[nodiscard]] std::size_t keyCount() const {
    return numbers(json_["animations"][0]["samplers"][0]["input"]).size();
  }

 private:
  json json_;
  std::string binary_;
  std::map<std::size_t, std::size_t> parents_;
};

void expectNear(const Pose& a, const Pose& b) {
  const Vec3 away = a.translation - b.translation;
  EXPECT_LT(std::hypot(away.x, away.y, away.z), kTolerance);
  const Quat& p = a.rotation;
  const Quat& q = b.rotation;
  EXPECT_NEAR(std::fabs(p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w), 1, kTolerance);
}

class RunAnimation : public testing::Test {
 protected:
  RunAnimation() : path_(writeWorld(folder_, smallHomeWorldWithModels())) {
    world_.emplace(*World::open({&path_, 1}));
    for (const PackFile& pack : world_->packs()) {
      if (pack.kind() == PackKind::kEpisodes) continue;
      auto meshes = renderMeshesOf(pack);
      assets_.push_back(
          {.pack = &pack, .meshes = std::make_shared<const RenderMeshes>(std::move(**meshes))});
    }
  }

  /// Steps and keeps the links of the first env; returns the animation.
  std::string run(std::uint32_t most_steps, bool distractors = true) {
    SimulationOptions options;
    options.envs = 2;
    options.task.most_steps = most_steps;
    options.task.distractors = distractors;
    auto simulator = *BatchSimulator::create(*world_, options);
    RunTrack track(*world_, simulator, 1);
    keep(simulator);
    std::vector<float> actions(simulator.envCount() * simulator.actionCount());
    for (std::size_t step = 0; step < kSteps; ++step) {
      for (std::size_t n = 0; n < actions.size(); ++n) {
        actions[n] = std::sin(0.9F * static_cast<float>(n + 1) + 0.05F * static_cast<float>(step));
      }
      actions[kTerminate] = 0;
      simulator.step(actions);
      track.add(simulator, actions);
      keep(simulator);
    }
    const auto glb = animationGlb(track, 0, assets_);
    EXPECT_TRUE(glb) << glb.error().message;
    return glb.value_or("");
  }

  void keep(const BatchSimulator& simulator) {
    const EnvState state = simulator.envState(0);
    std::vector<Pose>& links = links_.emplace_back(world_->robot().links().size());
    forwardKinematics(world_->robot().links(), state.world_from_root, state.joint_positions, links);
  }

  ScratchFolder folder_;
  std::filesystem::path path_;
  std::optional<World> world_;
  std::vector<PageAsset> assets_;
  std::vector<std::vector<Pose>> links_;
};

TEST_F(RunAnimation, HasEachLinkWhereTheSimulatorHadIt) {
  const Glb glb(run(0));
  ASSERT_EQ(glb.keyCount(), kSteps + 1);
  for (std::size_t link = 0; link < world_->robot().links().size(); ++link) {
    const std::size_t node = glb.nodeOf(std::string(world_->robot().linkName(link)));
    for (std::size_t key = 0; key <= kSteps; ++key) {
      expectNear(glb.worldPose(node, key), links_[key][link]);
    }
  }
}

TEST_F(RunAnimation, EndsBeforeTheNextEpisodeBegins) {
  const Glb glb(run(25));
  EXPECT_EQ(glb.keyCount(), 25U);
  const auto times = glb.numbers(glb.content()["animations"][0]["samplers"][0]["input"]);
  EXPECT_FLOAT_EQ(times.back(), 24 / kStepsPerSecond);
}

TEST_F(RunAnimation, HoldsSceneObjectsAndTheRobotsMeshes) {
  const Glb glb(run(0));
  EXPECT_EQ(glb.content()["asset"]["version"], "2.0");
  // The room with its table, two objects, base and hand.
  EXPECT_EQ(glb.content()["meshes"].size(), 5U);
  EXPECT_LT(glb.nodeOf("kitchen"), glb.nodeOf("mug"));
}

TEST_F(RunAnimation, HasOnlyTheTargetWhereNoOtherObjectIsThere) {
  const auto objectsOf = [&](const Glb& glb) {
    std::vector<std::string> found;
    for (const json& node : glb.content()["nodes"]) {
      const auto name = node["name"].get<std::string>();
      for (const std::string_view object : world_->episodes().objectNames()) {
        if (name == object) found.push_back(name);
      }
    }
    return found;
  };
  EXPECT_GT(objectsOf(Glb(run(0))).size(), 1U);
  EXPECT_EQ(objectsOf(Glb(run(0, false))).size(), 1U);
}

TEST_F(RunAnimation, IsTheSameEachTime) { EXPECT_EQ(run(0), run(0)); }

}  // namespace
}  // namespace galactic::test::run_animation_test
