#include "view/run_animation.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "galactic/kinematics.h"
#include "support/try.h"
#include "view/glb_file.h"
#include "view/render_glb.h"

namespace galactic {
namespace {

/// Turns -Z, where a camera of glTF looks, to +X; +Y stays.
constexpr float kRootHalf = 0.707106781F;
constexpr Quat kCameraTurn{0, -kRootHalf, 0, kRootHalf};

/// Frames of the first episode: the frame after the step that ended it is of the next one.
std::size_t frameCount(const EnvTrack& env) {
  const auto end = std::find_if(env.endings.begin(), env.endings.end(),
                                [](EpisodeEnd ending) { return ending != EpisodeEnd::kNone; });
  return static_cast<std::size_t>(end - env.endings.begin()) + 1;
}

class AnimationWriter {
 public:
  AnimationWriter(const RunTrack& track, std::size_t env, std::span<const PageAsset> assets)
      : world_(track.world()),
        env_(track.envs()[env]),
        episode_(world_.episodes().episodes()[env_.episodes.front()]),
        assets_(assets),
        is_target_only_(track.isTargetOnly()),
        frames_(frameCount(env_)) {}

  Result<std::string> run() {
    RETURN_IF_ERROR(writeScene());
    RETURN_IF_ERROR(writeRobot());
    RETURN_IF_ERROR(writeObjects());
    std::vector<float> times;
    for (std::size_t frame = 0; frame < frames_; ++frame) {
      times.push_back(static_cast<float>(frame) / kStepsPerSecond);
    }
    if (!motions_.empty()) file_.addAnimation("run", times, motions_);
    return file_.bytes();
  }

 private:
  /// Adds the model of a part of a pack under a node; nothing where there is none.
  Result<void> writeModel(const PageAsset& asset, std::uint32_t part, std::size_t node) {
    if (asset.meshes == nullptr) return {};
    const RenderMeshes& meshes = *asset.meshes;
    const auto model = meshes.modelOf(part);
    if (!model) return {};
    RenderGlbWriter& writer = writers_.try_emplace(&meshes, meshes, file_).first->second;
    return writer.write(meshes.models[*model], "mesh", node);
  }

  Result<void> writeScene() {
    const std::string_view name = world_.sceneOf(episode_).name();
    const std::size_t node = file_.addNode({.name = std::string(name)});
    for (const PageAsset& asset : assets_) {
      if (asset.pack->kind() != PackKind::kScene) continue;
      const auto scene = Scene::from(*asset.pack);
      if (!scene || scene->name() != name) continue;
      if (auto written = writeModel(asset, 0, node); !written) return written;
    }
    return {};
  }

  [[nodiscard]] std::vector<Pose> linksOf(std::size_t frame) const {
    const Robot& robot = world_.robot();
    const std::size_t positions = robot.positionCount();
    std::vector<Pose> poses(robot.links().size());
    forwardKinematics(robot.links(), env_.world_from_root[frame],
                      std::span(env_.joints).subspan(frame * positions, positions), poses);
    // Under its parent.
    for (std::size_t n = poses.size(); n-- > 0;) {
      const std::int32_t parent = robot.links()[n].parent;
      if (parent >= 0) poses[n] = inverse(poses[static_cast<std::size_t>(parent)]) * poses[n];
    }
    return poses;
  }

  Result<void> writeRobot() {
    const Robot& robot = world_.robot();
    std::vector<std::vector<Pose>> keys(robot.links().size());
    for (std::size_t frame = 0; frame < frames_; ++frame) {
      const std::vector<Pose> poses = linksOf(frame);
      for (std::size_t n = 0; n < poses.size(); ++n) keys[n].push_back(poses[n]);
    }
    const auto pack = std::find_if(assets_.begin(), assets_.end(), [](const PageAsset& asset) {
      return asset.pack->kind() == PackKind::kRobot;
    });
    std::vector<std::size_t> nodes;
    for (std::uint32_t n = 0; n < keys.size(); ++n) {
      const std::int32_t parent = robot.links()[n].parent;
      GlbNode node{.name = std::string(robot.linkName(n)), .parent_from_node = keys[n].front()};
      if (parent >= 0) node.parent = nodes[static_cast<std::size_t>(parent)];
      nodes.push_back(file_.addNode(node));
      addMotion(nodes.back(), robot.links()[n], std::move(keys[n]));
      if (pack == assets_.end()) continue;
      if (auto written = writeModel(*pack, n, nodes.back()); !written) return written;
    }
    if (const auto& camera = robot.camera()) {
      file_.addNode({.name = "camera",
                     .parent_from_node = camera->link_from_camera * Pose{{}, kCameraTurn},
                     .camera_fov = camera->vertical_fov,
                     .parent = nodes[camera->link]});
    }
    return {};
  }

  /// A link that stands still on its parent needs no keys.
  void addMotion(std::size_t node, const LinkFrame& link, std::vector<Pose> keys) {
    if (link.parent >= 0 && link.type == JointType::kFixed) return;
    addMotion(node, std::move(keys));
  }

  void addMotion(std::size_t node, std::vector<Pose> keys) {
    const bool moves = std::any_of(keys.begin(), keys.end(),
                                   [&](const Pose& pose) { return pose != keys.front(); });
    if (moves) motions_.push_back({node, std::move(keys)});
  }

  Result<void> writeObjects() {
    const PresentObjects present = world_.episodes().present(episode_, !is_target_only_);
    for (std::uint32_t n = 0; n < present.placements.size(); ++n) {
      std::vector<Pose> keys;
      Pose pose = present.placements[n].pose;
      auto move = env_.moves.begin();
      for (std::uint32_t frame = 0; frame < frames_; ++frame) {
        for (; move != env_.moves.end() && move->frame <= frame; ++move) {
          if (move->placement == present.first + n) pose = move->world_from_object;
        }
        keys.push_back(pose);
      }
      const std::string_view name = world_.objectOf(present.placements[n]).name;
      const std::size_t node =
          file_.addNode({.name = std::string(name), .parent_from_node = keys.front()});
      addMotion(node, std::move(keys));
      if (auto written = writeObjectModel(name, node); !written) return written;
    }
    return {};
  }

  Result<void> writeObjectModel(std::string_view name, std::size_t node) {
    for (const PageAsset& asset : assets_) {
      if (asset.pack->kind() != PackKind::kObjects) continue;
      const auto set = ObjectSet::from(*asset.pack);
      const auto found = set ? set->find(name) : std::nullopt;
      if (found) return writeModel(asset, static_cast<std::uint32_t>(*found), node);
    }
    return {};
  }

  const World& world_;
  const EnvTrack& env_;
  const Episode& episode_;
  std::span<const PageAsset> assets_;
  bool is_target_only_;
  std::size_t frames_;
  GlbFile file_;
  std::vector<GlbMotion> motions_;
  /// Asked by address, never walked through.
  std::map<const RenderMeshes*, RenderGlbWriter> writers_;
};

}  // namespace

Result<std::string> animationGlb(const RunTrack& track, std::size_t env,
                                 std::span<const PageAsset> assets) {
  return AnimationWriter(track, env, assets).run();
}

}  // namespace galactic
