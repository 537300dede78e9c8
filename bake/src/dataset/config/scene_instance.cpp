#include "dataset/config/scene_instance.h"

#include <fmt/format.h>

#include <cmath>

#include "common/lower_case.h"
#include "dataset/config/dataset_paths.h"
#include "json/json_reader.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Meters; what is placed in a scene has to be nearer, which is checked when it is composed.
constexpr double kFarthest = 1e6;
constexpr double kLargestScale = 1e4;
/// Radians or meters.
constexpr double kLargestPosition = 1e6;
constexpr std::string_view kNoStage = "NONE";

class SceneReader {
 public:
  SceneReader(const AttributeLayer& layer, SceneInstance& scene)
      : json_(layer.file), root_{&layer.json, layer.place}, scene_(scene) {}

  Result<void> read(bool& has_stage);

 private:
  void readStage(const JsonNode& node);
  void readList(const char* key, std::vector<SceneItem>& items, bool articulated);
  SceneItem readItem(const JsonNode& node);
  void readPose(const JsonNode& node, SceneItem& item);
  void readScale(const JsonNode& node, SceneItem& item);
  void readJoints(const JsonNode& node, SceneItem& item);
  std::optional<TranslationOrigin> readOrigin(const JsonNode& owner);
  void readMotion(const JsonNode& node, SceneItem& item);

  JsonReader json_;
  JsonNode root_;
  SceneInstance& scene_;
};

std::optional<TranslationOrigin> SceneReader::readOrigin(const JsonNode& owner) {
  const JsonNode node = JsonReader::member(owner, "translation_origin");
  const std::string stated = json_.text(node);
  const std::string name = lowerCase(stated);
  if (name == "com") return TranslationOrigin::kCenterOfMass;
  if (name == "asset_local") return TranslationOrigin::kAssetOrigin;
  if (!name.empty() && name != "unknown" && name != "unspecified") {
    json_.error(node.place, fmt::format("'{}' is unknown; known are 'COM', 'asset_local' and "
                                        "'unknown'",
                                        stated));
  }
  return std::nullopt;
}

void SceneReader::readMotion(const JsonNode& node, SceneItem& item) {
  const JsonNode motion = JsonReader::member(node, "motion_type");
  const std::string stated = json_.text(motion);
  const std::string name = lowerCase(stated);
  if (name.empty() || name == "dynamic" || name == "undefined") return;
  if (name == "static") {
    item.motion = MotionType::kStatic;
  } else if (name == "kinematic") {
    item.motion = MotionType::kKinematic;
  } else {
    json_.error(
        motion.place,
        fmt::format("'{}' is unknown; known are 'STATIC', 'KINEMATIC' and 'DYNAMIC'", stated));
  }
}

void SceneReader::readPose(const JsonNode& node, SceneItem& item) {
  json_.numbers(JsonReader::member(node, "translation"), kFarthest, item.translation);
  const JsonNode rotation = JsonReader::member(node, "rotation");
  json_.numbers(rotation, kFarthest, item.rotation);
  double squared = 0;
  for (const double v : item.rotation) squared += v * v;
  constexpr double kSmallest = 1e-12;
  if (squared < kSmallest) {
    return json_.error(rotation.place,
                       "it is a quaternion (w, x, y, z) of length 0, which turns to nowhere; "
                       "[1, 0, 0, 0] leaves it unrotated");
  }
  const double length = std::sqrt(squared);
  for (double& v : item.rotation) v /= length;
}

void SceneReader::readScale(const JsonNode& node, SceneItem& item) {
  const JsonNode uniform = JsonReader::member(node, "uniform_scale");
  const JsonNode each = JsonReader::member(node, "non_uniform_scale");
  json_.numbers(each, kLargestScale, item.scale);
  const double factor =
      uniform.json == nullptr ? 1 : json_.number(uniform, -kLargestScale, kLargestScale);
  for (double& v : item.scale) v *= factor;
  for (const double v : item.scale) {
    if (v == 0) json_.error(factor == 0 ? uniform.place : each.place, "a scale of 0 flattens it");
  }
}

void SceneReader::readJoints(const JsonNode& node, SceneItem& item) {
  const JsonNode pose = JsonReader::member(node, "initial_joint_pose");
  if (pose.json == nullptr) return;
  if (!pose.json->is_object()) {
    std::size_t number = 0;
    for (const JsonNode& value : json_.elements(pose)) {
      item.joint_positions.emplace_back(fmt::format("joint_{:04d}", number++),
                                        json_.number(value, -kLargestPosition, kLargestPosition));
    }
    return;
  }
  item.joint_positions.reserve(pose.json->size());
  for (auto value = pose.json->begin(); value != pose.json->end(); ++value) {
    const JsonNode position{&*value, fmt::format("{}.{}", pose.place, value.key())};
    item.joint_positions.emplace_back(value.key(),
                                      json_.number(position, -kLargestPosition, kLargestPosition));
  }
}

SceneItem SceneReader::readItem(const JsonNode& node) {
  SceneItem item;
  if (!node.json->is_object()) {
    json_.error(node.place, "expected an object");
    return item;
  }
  const JsonNode name = json_.require(node, "template_name");
  item.template_name = json_.text(name);
  if (item.template_name.empty()) json_.error(name.place, "is empty, expected a template's name");
  readPose(node, item);
  readScale(node, item);
  item.origin = readOrigin(node);
  readMotion(node, item);
  collectReceptacles(json_.file(), node, item.receptacles);
  return item;
}

void SceneReader::readStage(const JsonNode& node) {
  SceneItem stage = readItem(node);
  scene_.stage.reset();
  if (stage.template_name != kNoStage) scene_.stage = std::move(stage);
}

void SceneReader::readList(const char* key, std::vector<SceneItem>& items, bool articulated) {
  const JsonNode list = JsonReader::member(root_, key);
  if (list.json == nullptr) return;
  items.clear();
  for (const JsonNode& node : json_.elements(list)) {
    items.push_back(readItem(node));
    if (articulated) readJoints(node, items.back());
    if (json_.failed()) return;
  }
}

Result<void> SceneReader::read(bool& has_stage) {
  if (!root_.json->is_object()) {
    json_.error(root_.place.empty() ? "the file" : root_.place, "expected an object");
  }
  const auto origin = readOrigin(root_);
  if (origin) scene_.origin = *origin;
  const JsonNode stage = JsonReader::member(root_, "stage_instance");
  if (stage.json != nullptr && !json_.failed()) {
    has_stage = true;
    readStage(stage);
  }
  readList("object_instances", scene_.objects, false);
  readList("articulated_object_instances", scene_.articulated, true);
  if (json_.failed()) return json_.failure();
  collectReceptacles(json_.file(), root_, scene_.receptacles);
  return {};
}

}  // namespace

Result<SceneInstance> readSceneInstance(std::span<const AttributeLayer> layers) {
  SceneInstance scene;
  bool has_stage = false;
  std::string file;
  for (const AttributeLayer& layer : layers) {
    RETURN_IF_ERROR(SceneReader(layer, scene).read(has_stage));
    file = layer.file;
  }
  if (!has_stage) {
    return fail(ErrorCode::kInvalidInput, fmt::format("{}: stage_instance", file),
                "it is missing; a scene without one says \"template_name\": \"NONE\"");
  }
  return scene;
}

}  // namespace galactic::bake
