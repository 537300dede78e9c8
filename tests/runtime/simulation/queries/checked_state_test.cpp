// States that are handed to queries and are none of their world.
#include "simulation/queries/checked_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "galactic/planning_scene.h"
#include "galactic/ray_caster.h"
#include "support/homes/small_home.h"
#include "support/homes/task_twins.h"

namespace galactic::test::checked_state_test {
namespace {

using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Why `call`, which throws as `where`, is refused; empty where it is not.
template <class Call>
std::string refusalOf(const std::string& where, const Call& call) {
  try {
    call();
  } catch (const ErrorException& refused) {
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(refused.error().where, where);
    return refused.error().message;
  }
  return {};
}

/// The same of whoever takes a state: all of them ask alike.
std::string refusalOf(const World& world, const EnvState& state) {
  std::string message = refusalOf(
      "Check", [&] { static_cast<void>(simulation::checkedObjects("Check", world, state)); });
  PlanningScene scene(world, {});
  EXPECT_EQ(refusalOf("PlanningScene::update", [&] { scene.update(state); }), message);
  EXPECT_EQ(refusalOf("RayCaster", [&] { const RayCaster caster(world, state); }), message);
  return message;
}

/// As an env begins.
EnvState stateIn(const World& world) {
  SimulationOptions options;
  options.envs = 1;
  options.threads = 1;
  options.order = EpisodeOrder::kLinear;
  return simulatorOf(world, options).envState(0);
}

class StateForQueries : public testing::Test {
 protected:
  template <class Change>
  [[nodiscard]] std::string refused(const Change& change) const {
    EnvState changed = state_;
    change(changed);
    return refusalOf(home_.world(), changed);
  }

  SmallHome home_;
  EnvState state_ = stateIn(home_.world());
};

TEST_F(StateForQueries, IsTakenAsTheSimulatorHasIt) {
  EXPECT_EQ(refused([](EnvState&) {}), "");
  // Also where a hand holds something, and wherever that is.
  EXPECT_EQ(refused([](EnvState& s) { s.held = 1; }), "");
  const auto objects = simulation::checkedObjects("Check", home_.world(), state_);
  EXPECT_EQ(objects.size(), state_.objects.size());
}

TEST_F(StateForQueries, IsRefusedWhereItsIndicesAndLengthsAreThoseOfAnotherWorld) {
  EXPECT_EQ(refused([](EnvState& s) { s.scene = 1; }), "found scene 1, expected one below 1");
  EXPECT_EQ(refused([](EnvState& s) { s.episode = 4; }), "found episode 4, expected one below 4");
  EXPECT_EQ(refused([](EnvState& s) { s.episode = 1; }),
            "\"objects\" has the length 2, expected 3");
  EXPECT_EQ(refused([](EnvState& s) { s.joint_positions.pop_back(); }),
            "\"joint_positions\" has the length 3, expected 4");
  EXPECT_EQ(refused([](EnvState& s) { s.joint_positions.clear(); }),
            "\"joint_positions\" has the length 0, expected 4");
  EXPECT_EQ(refused([](EnvState& s) { s.objects.emplace_back(); }),
            "\"objects\" has the length 3, expected 2");
  EXPECT_EQ(refused([](EnvState& s) { s.objects.clear(); }),
            "\"objects\" has the length 0, expected 2");
  for (const std::int32_t held : {2, 99, -2, std::numeric_limits<std::int32_t>::min()}) {
    EXPECT_EQ(refused([&](EnvState& s) { s.held = held; }),
              "found held " + std::to_string(held) + ", expected -1 or an index below 2");
  }
}

TEST_F(StateForQueries, IsRefusedWhereANumberIsNone) {
  for (const auto& number : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    for (const float wrong : {kNan, kInfinity, -1e30F}) {
      EXPECT_THAT(refused([&](EnvState& s) { s.world_from_root.translation.*number = wrong; }),
                  HasSubstr("found a state that has world_from_root.translation ("));
      EXPECT_THAT(refused([&](EnvState& s) { s.objects[1].translation.*number = wrong; }),
                  HasSubstr("found a state that has objects[1].translation ("));
    }
  }
  EXPECT_EQ(refused([](EnvState& s) { s.joint_positions[2] = kNan; }),
            "found a state that has joint_positions[2] nan, expected a finite number of at most "
            "1e+06");
  EXPECT_EQ(refused([](EnvState& s) {
              s.objects[0].rotation = {0, 0, 0, 0};
            }),
            "found a state that has objects[0].rotation (0, 0, 0, 0), expected a unit quaternion: "
            "w, x, y, z");
  EXPECT_THAT(refused([](EnvState& s) {
                s.objects[0].rotation = {0, 0, kNan, 1};
              }),
              HasSubstr("objects[0].rotation (1, 0, 0, nan)"));
  EXPECT_THAT(refused([](EnvState& s) {
                s.held = 0;
                s.world_from_grip.rotation = {2, 0, 0, 0};
              }),
              HasSubstr("world_from_grip.rotation ("));
}

/// The small home, and before it another scene that looks alike and has no episodes.
class TwoHomes {
 public:
  TwoHomes() {
    const auto add = [](std::vector<PackFile>& packs, const AlignedBytes& bytes) {
      packs.push_back(orThrow(PackFile::view(bytes.bytes(), "pack")));
    };
    std::vector<PackFile> packs;
    for (const AlignedBytes* bytes : {&attic_, &scene_, &objects_, &robot_, &episodes_}) {
      add(packs, *bytes);
    }
    world_.emplace(orThrow(World::from(std::move(packs))));
  }
  [[nodiscard]] const World& world() const { return *world_; }

 private:
  static ScenePackFields attic() {
    ScenePackFields fields = smallHomeWorld().scene;
    fields.name = "attic";
    return fields;
  }

  AlignedBytes attic_ = buildPack(attic());
  AlignedBytes scene_ = buildPack(smallHomeWorld().scene);
  AlignedBytes objects_ = buildPack(smallHomeWorld().objects);
  AlignedBytes robot_ = buildPack(smallHomeWorld().robot);
  AlignedBytes episodes_ = buildPack(smallHomeWorld().episodes);
  std::optional<World> world_;
};

TEST_F(StateForQueries, IsRefusedWhereItsEpisodeIsInAnotherScene) {
  const TwoHomes homes;
  ASSERT_EQ(homes.world().scenes().size(), 2U);
  EnvState state = stateIn(homes.world());
  ASSERT_EQ(state.scene, 1U);
  EXPECT_EQ(refusalOf(homes.world(), state), "");
  state.scene = 0;
  EXPECT_EQ(refusalOf(homes.world(), state),
            "found scene 0 and episode " + std::to_string(state.episode) + ", which is in scene 1");
}

}  // namespace
}  // namespace galactic::test::checked_state_test
