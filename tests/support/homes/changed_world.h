#pragma once
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "galactic/batch_renderer.h"
#include "galactic/batch_simulator.h"
#include "galactic/world_views.h"
#include "support/homes/small_home_models.h"

namespace galactic::test {

/// The packs of the small home, whose payloads can be changed: headers are made to fit again.
class ChangedWorld {
 public:
  /// What came of using a world.
  struct Outcome {
    bool accepted = false;
    /// What was wrong with an accepted world; empty: nothing.
    std::string finding{};
  };

  explicit ChangedWorld(const WorldFields& fields = smallHomeWorldWithModels())
      : files_{buildPack(fields.scene), buildPack(fields.objects), buildPack(fields.robot),
               buildPack(fields.episodes)} {}

  [[nodiscard]] std::size_t packCount() const { return files_.size(); }
  [[nodiscard]] std::size_t wordCount(std::size_t pack) const {
    return (files_[pack].size() - sizeof(PackHeader)) / sizeof(std::uint32_t);
  }
  [[nodiscard]] std::uint32_t word(std::size_t pack, std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, files_[pack].bytes().data() + offsetOf(at), sizeof(value));
    return value;
  }
  void setWord(std::size_t pack, std::size_t at, std::uint32_t value) {
    std::memcpy(files_[pack].bytes().data() + offsetOf(at), &value, sizeof(value));
  }

  /// Opens the packs; where they are accepted, simulates and draws them for `steps` steps.
  [[nodiscard]] Outcome use(int steps, const SensorOptions& sensors = {},
                            const TaskOptions& task = {}) {
    std::vector<PackFile> packs;
    for (std::size_t n = 0; n < files_.size(); ++n) {
      const std::span<std::byte> file = files_[n].bytes();
      const PackHeader header = makePackHeader(kKinds[n], file.subspan(sizeof(PackHeader)));
      std::memcpy(file.data(), &header, sizeof(header));
      Result<PackFile> pack = PackFile::view(file, "changed.pack");
      if (!pack) return {};
      packs.push_back(std::move(*pack));
    }
    const Result<World> world = World::from(std::move(packs));
    if (!world) return {};
    return {.accepted = true, .finding = findingIn(*world, steps, sensors, task)};
  }

 private:
  static constexpr std::array kKinds{PackKind::kScene, PackKind::kObjects, PackKind::kRobot,
                                     PackKind::kEpisodes};
  static constexpr std::uint32_t kEnvs = 2;
  static constexpr std::uint32_t kPixels = 16;

  static std::size_t offsetOf(std::size_t word) {
    return sizeof(PackHeader) + word * sizeof(std::uint32_t);
  }

  static bool areFinite(std::span<const float> values) {
    for (const float value : values) {
      if (!std::isfinite(value)) return false;
    }
    return true;
  }

  static bool areFinite(const RigidTransform& transform) {
    const auto finite = [](const Vec3& v) { return std::isfinite(v.x + v.y + v.z); };
    return finite(transform.x_axis) && finite(transform.y_axis) && finite(transform.z_axis) &&
           finite(transform.origin);
  }

  static std::string findingIn(const World& world, int steps, const SensorOptions& sensors,
                               const TaskOptions& task) {
    SimulationOptions options;
    options.envs = kEnvs;
    options.threads = 1;
    options.body_transforms = true;
    options.order = EpisodeOrder::kLinear;
    options.sensors = sensors;
    options.task = task;
    auto simulator = BatchSimulator::create(world, options);
    // Said so: no robot need be able to start.
    if (!simulator) return {};
    const Result<WorldModels> models = WorldModels::from(world);
    if (!models) return {};
    const CameraMount above{
        .frame = CameraFrame::kWorld,
        .frame_from_camera = {},
        .world_from_camera = {rigidTransform(Pose{{0.2F, 2, 0.2F}, {0, -0.38F, 0, 0.925F}})}};
    const CameraMount mount = robotCamera(world.robot()).value_or(above);
    WorldViews on_robot(*models, *simulator, mount);
    WorldViews in_room(*models, *simulator, above);
    RenderOptions drawing;
    drawing.width = kPixels;
    drawing.height = kPixels;
    drawing.semantics = true;
    drawing.backend = RenderBackend::kSoft;
    drawing.threads = 1;
    auto renderer = BatchRenderer::create(models->library(), drawing);
    if (!renderer) return "a renderer that cannot be made: " + renderer.error().message;
    for (int step = 0; step < steps; ++step) {
      simulator->step(actionsOf(*simulator, step));
      std::string finding = findingIn(*simulator);
      for (WorldViews* views : {&on_robot, &in_room}) {
        views->update(*simulator);
        if (finding.empty()) finding = findingIn(*renderer, *views);
      }
      if (!finding.empty()) return fmt::format("{} in step {}", finding, step);
    }
    return {};
  }

  static std::vector<float> actionsOf(const BatchSimulator& simulator, int step) {
    std::vector<float> actions(simulator.envCount() * simulator.actionCount());
    for (std::size_t n = 0; n < actions.size(); ++n) {
      const auto wave = static_cast<float>(n * 7 + static_cast<std::size_t>(step) * 3);
      actions[n] = std::sin(wave);
    }
    return actions;
  }

  static std::string findingIn(const BatchSimulator& simulator) {
    if (!areFinite(simulator.observations())) return "an observation that is no number";
    if (!areFinite(simulator.rewards())) return "a reward that is no number";
    for (const RigidTransform& body : simulator.bodyTransforms()) {
      if (!areFinite(body)) return "a link or an object that is nowhere";
    }
    for (std::size_t env = 0; env < simulator.envCount(); ++env) {
      if (!areFinite(simulator.envState(env).joint_positions)) return "a joint that is nowhere";
    }
    return {};
  }

  static std::string findingIn(BatchRenderer& renderer, const WorldViews& views) {
    constexpr std::size_t kCount = std::size_t{kEnvs} * kPixels * kPixels;
    std::vector<std::uint8_t> color(kCount * 4);
    std::vector<float> depth(kCount);
    std::vector<std::uint32_t> semantics(kCount);
    renderer.render(views.views(), {color, depth, semantics});
    for (const float meters : depth) {
      if (!(meters >= 0 && std::isfinite(meters))) return "a depth that is no distance";
    }
    return {};
  }

  std::array<AlignedBytes, 4> files_;
};

}  // namespace galactic::test
