#include "view/page_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace galactic {
namespace {

constexpr double kLengthStep = 1e-4;
constexpr double kRotationStep = 1.0 / 32767;

std::int32_t wholeOf(float value, double step) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max() / 4.0;
  return static_cast<std::int32_t>(
      std::lround(std::clamp(static_cast<double>(value) / step, -kMost, kMost)));
}

/// Rows of numbers, one per frame, as differences from the row before; column after column.
class DeltaTable {
 public:
  explicit DeltaTable(std::size_t columns) : columns_(columns), last_(columns) {}

  void add(std::span<const std::int32_t> row) {
    for (std::size_t n = 0; n < columns_.size(); ++n) {
      columns_[n].push_back(row[n] - last_[n]);
      last_[n] = row[n];
    }
  }

  [[nodiscard]] std::vector<std::int32_t> take() const {
    std::vector<std::int32_t> all;
    for (const auto& column : columns_) all.insert(all.end(), column.begin(), column.end());
    return all;
  }

 private:
  std::vector<std::vector<std::int32_t>> columns_;
  std::vector<std::int32_t> last_;
};

void appendPose(std::vector<std::int32_t>& row, const Pose& pose) {
  const Vec3& p = pose.translation;
  const Quat& q = pose.rotation;
  for (const float value : {p.x, p.y, p.z}) row.push_back(wholeOf(value, kLengthStep));
  for (const float value : {q.x, q.y, q.z, q.w}) row.push_back(wholeOf(value, kRotationStep));
}

/// Root pose, joint positions, held object and episode of each frame.
std::vector<std::int32_t> framesOf(const RunTrack& track, const EnvTrack& env) {
  const std::size_t positions = track.positionCount();
  constexpr std::size_t kPoseNumbers = 7;
  DeltaTable table(kPoseNumbers + positions + 2);
  std::vector<std::int32_t> row;
  for (std::size_t frame = 0; frame < env.episodes.size(); ++frame) {
    row.clear();
    appendPose(row, env.world_from_root[frame]);
    for (std::size_t n = 0; n < positions; ++n) {
      row.push_back(wholeOf(env.joints[frame * positions + n], kLengthStep));
    }
    row.push_back(env.held[frame]);
    row.push_back(static_cast<std::int32_t>(env.episodes[frame]));
    table.add(row);
  }
  return table.take();
}

std::vector<std::int32_t> movesOf(const EnvTrack& env) {
  constexpr std::size_t kMoveNumbers = 9;
  DeltaTable table(kMoveNumbers);
  std::vector<std::int32_t> row;
  for (const ObjectMove& move : env.moves) {
    row = {static_cast<std::int32_t>(move.frame), static_cast<std::int32_t>(move.placement)};
    appendPose(row, move.world_from_object);
    table.add(row);
  }
  return table.take();
}

template <class T>
std::vector<std::uint8_t> bytesOf(const std::vector<T>& values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size());
  for (const T value : values) bytes.push_back(static_cast<std::uint8_t>(value));
  return bytes;
}

void writeEnv(JsonWriter& json, PageData& data, const RunTrack& track, const EnvTrack& env) {
  Chunk chunk;
  chunk.addPlanes("frames", std::span<const std::int32_t>(framesOf(track, env)));
  chunk.addPlanes("moves", std::span<const std::int32_t>(movesOf(env)));
  chunk.add("idle", std::span<const std::uint8_t>(env.idle));
  chunk.add("rewards", std::span<const float>(env.rewards));
  chunk.add("endings", std::span<const std::uint8_t>(bytesOf(env.endings)));
  chunk.add("events", std::span<const std::uint8_t>(env.events));
  chunk.add("actions", std::span<const float>(env.actions));
  chunk.add("distances", std::span<const float>(env.distances));
  data.add(json, "", chunk);
}

void writeActionNames(JsonWriter& json, const Robot& robot) {
  json.begin("actions", '[');
  for (const ControlledJoint& joint : robot.controlledJoints()) {
    std::string_view name;
    for (std::size_t link = 0; link < robot.links().size() && name.empty(); ++link) {
      const LinkFrame& frame = robot.links()[link];
      const auto first = static_cast<std::int64_t>(frame.position);
      const std::int64_t after = first + positionCount(frame.type);
      if (first >= 0 && first <= joint.position && joint.position < after) {
        name = robot.jointName(link);
      }
    }
    json.text("", name);
  }
  for (const std::string_view name : {"forward", "turn", "grasp", "terminate"}) json.text("", name);
  json.end(']');
}

/// What is said of single envs and moments.
void writeRemarks(JsonWriter& json, const PageRun& run) {
  if (!run.names.empty()) {
    json.begin("names", '[');
    for (const std::string& name : run.names) json.text("", name);
    json.end(']');
  }
  if (!run.twins.empty()) {
    json.begin("twins", '[');
    for (const std::uint32_t twin : run.twins) json.number("", twin);
    json.end(']');
  }
  if (run.moments.empty()) return;
  json.begin("moments", '[');
  for (const PageMoment& moment : run.moments) {
    json.begin("", '{');
    json.number("env", moment.env);
    json.number("frame", moment.frame);
    json.text("text", moment.text);
    json.end('}');
  }
  json.end(']');
}

}  // namespace

void writeRun(JsonWriter& json, std::string_view key, PageData& data, const PageRun& run) {
  const RunTrack& track = *run.track;
  json.begin(key, '{');
  json.number("steps", track.steps());
  json.number("positions", track.positionCount());
  json.number("steps_per_second", kStepsPerSecond);
  json.number("length_step", kLengthStep);
  json.number("rotation_step", kRotationStep);
  json.truth("target_only", track.isTargetOnly());
  writeActionNames(json, track.world().robot());
  json.begin("distances", '[');
  for (const std::string_view name : kTrackDistances) json.text("", name);
  json.end(']');
  if (!run.facts.empty()) json.raw("facts", run.facts);
  writeRemarks(json, run);
  json.begin("envs", '[');
  for (const EnvTrack& env : track.envs()) writeEnv(json, data, track, env);
  json.end(']');
  json.end('}');
}

}  // namespace galactic
