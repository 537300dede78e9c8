#include "pack_tool/export/episode_set_text.h"

#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace galactic::pack_tool {

namespace {

/// w, x, y, z in double precision, so that the turn to another frame can be taken back exactly.
using Rotation = std::array<double, 4>;

/// The rotation from the frame of a mesh file to that of its pack.
Rotation packFromFile(FileUp up) {
  constexpr double kHalf = std::numbers::sqrt2 / 2;
  switch (up) {
    case FileUp::kX:
      return {kHalf, 0, 0, kHalf};
    case FileUp::kY:
      return {1, 0, 0, 0};
    case FileUp::kZ:
      return {kHalf, -kHalf, 0, 0};
    case FileUp::kMinusX:
      return {kHalf, 0, 0, -kHalf};
    case FileUp::kMinusY:
      return {0, -1, 0, 0};
    case FileUp::kMinusZ:
      return {kHalf, kHalf, 0, 0};
  }
  return {1, 0, 0, 0};
}

/// First `b`, then `a`.
Rotation product(const Rotation& a, const Rotation& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

/// Writes the parts of an episode set one after the other.
class Writer {
 public:
  explicit Writer(FileUp up) : pack_from_file_(packFromFile(up)) {}

  /// The shortest text that reads back as the same number.
  template <class Number>
  void number(Number value) {
    std::array<char, 32> digits{};
    const auto [end, ignored] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text_.append(digits.data(), end);
  }
  void coordinate(double value) { number(value); }
  /// Readers take it for a double and round it: in the rare case that this is another float, the
  /// digits of the double are written.
  void coordinate(float value) {
    std::array<char, 32> digits{};
    const auto [end, ignored] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    double read = 0;
    std::from_chars(digits.data(), end, read);
    if (static_cast<float>(read) == value) {
      text_.append(digits.data(), end);
    } else {
      number(static_cast<double>(value));
    }
  }
  void text(std::string_view more) { text_ += more; }
  void quoted(std::string_view name) {
    text_ += nlohmann::json(name).dump(-1, ' ', false, kReplace);
  }
  void key(std::string_view name) {
    text_ += '"';
    text_ += name;
    text_ += "\": ";
  }
  template <class Numbers>
  void list(const Numbers& numbers) {
    text_ += '[';
    bool first = true;
    for (const auto value : numbers) {
      if (!first) text_ += ", ";
      first = false;
      coordinate(value);
    }
    text_ += ']';
  }
  void point(const Vec3& p) { list(std::array{p.x, p.y, p.z}); }
  /// The rotation of an object in the world, for the frame of its file.
  void rotation(const Quat& q) {
    list(product({static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y),
                  static_cast<double>(q.z)},
                 pack_from_file_));
  }
  /// "  "name": [" and one line for each of `count` elements, which `element(n)` writes.
  template <class Element>
  void elements(std::string_view name, std::size_t count, const Element& element) {
    text_ += "  ";
    key(name);
    text_ += '[';
    for (std::size_t n = 0; n < count; ++n) {
      text_ += n == 0 ? "\n    " : ",\n    ";
      element(n);
    }
    text_ += "\n  ]";
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  static constexpr auto kReplace = nlohmann::json::error_handler_t::replace;

  Rotation pack_from_file_;
  std::string text_;
};

void writeScene(Writer& out, std::string_view name, std::size_t asset) {
  out.text("{");
  out.key("name");
  out.quoted(name);
  out.text(", ");
  out.key("columnGridSetName");
  out.quoted(name);
  out.text(", ");
  out.key("renderAssetInstances");
  out.text("[{");
  out.key("renderAssetIndex");
  out.number(asset);
  out.text(
      R"(, "transform": {"origin": [0, 0, 0], "rotation": [1, 0, 0, 0], "scale": [1, 1, 1]}}]})");
}

void writeSpawn(Writer& out, const Placement& placement) {
  out.text("{");
  out.key("freeObjIndex");
  out.number(placement.object);
  out.text(", ");
  out.key("startRotation");
  out.rotation(placement.pose.rotation);
  out.text(", ");
  out.key("startPos");
  out.point(placement.pose.translation);
  out.text("}");
}

void writeEpisode(Writer& out, const Episode& episode, std::span<const float> start_positions) {
  const auto whole = [&out](std::string_view key, std::uint32_t value) {
    out.key(key);
    out.number(value);
    out.text(", ");
  };
  out.text("{");
  whole("staticSceneIndex", episode.scene);
  whole("numFreeObjectSpawns", episode.placement_count);
  whole("targetObjIndex", episode.target);
  whole("firstFreeObjectSpawnIndex", episode.first_placement);
  out.key("agentStartPos");
  out.list(std::array{episode.base_position.x, episode.base_position.z});
  out.text(", ");
  // Published sets have one floor, at height 0: readers of theirs know no such key.
  if (episode.base_position.y != 0) {
    out.key("agentStartHeight");
    out.coordinate(episode.base_position.y);
    out.text(", ");
  }
  out.key("agentStartYaw");
  out.coordinate(episode.base_yaw);
  out.text(", ");
  out.key("robotStartJointPositions");
  out.list(start_positions);
  out.text(", ");
  out.key("targetObjGoalPos");
  out.point(episode.goal.translation);
  out.text(", ");
  out.key("targetObjGoalRotation");
  out.rotation(episode.goal.rotation);
  out.text("}");
}

/// What published sets leave to their collection.
void writeRobot(Writer& out, const EpisodeSet& set) {
  if (!set.robotName().empty()) {
    out.text("  ");
    out.key("robot");
    out.quoted(set.robotName());
    out.text(",\n");
  }
  out.text("  ");
  out.key("startJoints");
  out.text("[");
  for (std::size_t n = 0; n < set.startJoints().size(); ++n) {
    if (n > 0) out.text(", ");
    out.quoted(set.startJoints()[n]);
  }
  out.text("],\n");
}

}  // namespace

std::string episodeSetText(const EpisodeSet& set, FileUp up) {
  const auto& scenes = set.sceneNames();
  const auto& objects = set.objectNames();
  Writer out(up);
  out.text("{\"episodeSet\": {\n");
  writeRobot(out, set);
  out.elements("renderAssets", scenes.size() + objects.size(), [&](std::size_t n) {
    out.text("{");
    out.key("name");
    out.quoted(n < scenes.size() ? scenes[n] : objects[n - scenes.size()]);
    out.text("}");
  });
  out.text(",\n");
  out.elements("staticScenes", scenes.size(),
               [&](std::size_t n) { writeScene(out, scenes[n], n); });
  out.text(",\n");
  out.elements("freeObjects", objects.size(), [&](std::size_t n) {
    out.text("{");
    out.key("renderAssetIndex");
    out.number(scenes.size() + n);
    out.text(R"(, "startRotations": []})");
  });
  out.text(",\n");
  // A checked pack's episodes name all placements, one after the other.
  std::vector<Placement> placements;
  std::size_t count = 0;
  for (const Episode& episode : set.episodes()) count += episode.placement_count;
  placements.reserve(count);
  for (const Episode& episode : set.episodes()) {
    const auto own = set.placements(episode);
    placements.insert(placements.end(), own.begin(), own.end());
  }
  out.elements("freeObjectSpawns", placements.size(),
               [&](std::size_t n) { writeSpawn(out, placements[n]); });
  out.text(",\n");
  out.elements("episodes", set.episodes().size(),
               [&](std::size_t n) { writeEpisode(out, set.episodes()[n], set.startPositions(n)); });
  out.text("\n}}\n");
  return out.take();
}

}  // namespace galactic::pack_tool
