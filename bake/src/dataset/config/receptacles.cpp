#include "dataset/config/receptacles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include "dataset/config/placement.h"
#include "dataset/config/scene_instance.h"
#include "import/affine.h"
#include "robot/robot_parts.h"

namespace galactic::bake {
namespace {

using Triple = std::array<double, 3>;

constexpr std::string_view kPrefix = "receptacle_";
constexpr std::string_view kBoxPrefix = "receptacle_aabb_";
constexpr std::string_view kMeshPrefix = "receptacle_mesh_";
/// Meters.
constexpr double kFarthest = 1e6;
/// Cosine between a box's `up` and the vertical from which on it counts as upright: 26 degrees.
constexpr double kUpright = 0.9;
/// Cosine between a box's edges up to which they count as being at right angles.
constexpr double kRightAngle = 1e-3;

/// A box as it is stated.
struct StatedBox {
  std::string name;
  Triple center{};
  Triple half_extents{};
  /// (w, x, y, z), of length 1.
  std::array<double, 4> rotation{1, 0, 0, 0};
  /// Which axis of the box is up, and whether it points along or against it.
  std::size_t up_axis = 1;
  double up_sign = 1;
  bool states_up = false;
  /// Empty: none.
  std::string link;
};

/// Reads one annotation. The first thing that is wrong with it is kept.
class BoxReader {
 public:
  explicit BoxReader(const AttributeLayer& stated)
      : json_(stated.file), node_{&stated.json, stated.place} {}

  std::optional<StatedBox> read(const std::string& key) {
    StatedBox box;
    if (!node_.json->is_object()) json_.error(node_.place, "expected an object");
    box.name = json_.text(JsonReader::member(node_, "name"));
    if (box.name.empty()) box.name = key;
    json_.numbers(json_.require(node_, "position"), kFarthest, box.center);
    readUp(box);
    readScale(box);
    readRotation(box);
    box.link = json_.text(JsonReader::member(node_, "parent_link"));
    if (json_.failed()) return std::nullopt;
    return box;
  }

  void error(const char* member, std::string message) {
    json_.error(JsonReader::member(node_, member).place, std::move(message));
  }

  /// What was wrong; only after an error.
  [[nodiscard]] ReceptacleWarning warning() const {
    const Error error = json_.failure().value();
    // The file goes with the warning: it is written relative to the dataset's folder.
    std::string place = error.where;
    if (place.starts_with(json_.file())) place.erase(0, json_.file().size() + 2);
    return {json_.file(), fmt::format("{}: {}", place, error.message)};
  }

 private:
  void readUp(StatedBox& box) {
    const JsonNode node = JsonReader::member(node_, "up");
    Triple up{0, 1, 0};
    box.states_up = node.json != nullptr;
    json_.numbers(node, kFarthest, up);
    if (std::ranges::count(up, 0.0) != 2) {
      return json_.error(node.place, fmt::format("it is [{}]; expected one of the box's axes, as "
                                                 "[0, 1, 0]",
                                                 fmt::join(up, ", ")));
    }
    box.up_axis = static_cast<std::size_t>(
        std::ranges::find_if(up, [](double v) { return v != 0; }) - up.begin());
    box.up_sign = up[box.up_axis] > 0 ? 1 : -1;
  }

  void readScale(StatedBox& box) {
    const JsonNode node = json_.require(node_, "scale");
    json_.numbers(node, kFarthest, box.half_extents);
    // Boxes that were mirrored to the other side of a cupboard state negative ones.
    for (double& half : box.half_extents) half = std::abs(half);
    if (std::ranges::count(box.half_extents, 0.0) > 1) {
      json_.error(node.place, "it has several half extents of 0, which leave no room for anything");
    }
  }

  void readRotation(StatedBox& box) {
    const JsonNode node = JsonReader::member(node_, "rotation");
    json_.numbers(node, kFarthest, box.rotation);
    double squared = 0;
    for (const double v : box.rotation) squared += v * v;
    constexpr double kSmallest = 1e-12;
    if (squared < kSmallest) {
      return json_.error(node.place,
                         "it is a quaternion (w, x, y, z) of length 0, which turns to nowhere");
    }
    for (double& v : box.rotation) v /= std::sqrt(squared);
  }

  JsonReader json_;
  JsonNode node_;
};

/// World frame from that in which the box's link or parent states it; none after an error.
std::optional<Affine> frameOf(const StatedBox& box, const ReceptacleParent& parent,
                              BoxReader& reader) {
  if (parent.kind != ReceptacleParent::Kind::kFurniture) {
    if (box.link.empty()) return parent.world_from_parent;
    reader.error("parent_link",
                 fmt::format("it is '{}', but nothing here has links; leave it out", box.link));
    return std::nullopt;
  }
  const auto link = std::ranges::find(parent.links, box.link, &ReceptacleLink::name);
  if (link != parent.links.end()) return link->world_from_link;
  std::vector<std::string_view> names;
  names.reserve(parent.links.size());
  for (const ReceptacleLink& one : parent.links) names.emplace_back(one.name);
  reader.error("parent_link", fmt::format("it is '{}', expected one of the URDF's links: {}",
                                          box.link, fmt::join(names, ", ")));
  return std::nullopt;
}

/// The frame of the box itself: its center and the axes along which its half extents count.
std::optional<Affine> boxFrame(const StatedBox& box, const ReceptacleParent& parent,
                               BoxReader& reader) {
  const auto world_from_frame = frameOf(box, parent, reader);
  if (!world_from_frame) return std::nullopt;
  SceneItem turned;
  turned.translation = box.center;
  if (parent.kind == ReceptacleParent::Kind::kPlace) turned.rotation = box.rotation;
  return compose(*world_from_frame, worldFromObject(turned));
}

/// The box as a rigid frame and half extents; none where it is no box any more.
std::optional<SupportRegion> rigidBox(const Affine& world_from_box, const Triple& half_extents) {
  Affine rigid = world_from_box;
  Triple halves{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double length = std::hypot(rigid[axis], rigid[4 + axis], rigid[8 + axis]);
    if (!std::isfinite(length) || length == 0) return std::nullopt;
    halves[axis] = half_extents[axis] * length;
    for (std::size_t row = 0; row < 3; ++row) rigid[4 * row + axis] /= length;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3;
    double cosine = 0;
    for (std::size_t row = 0; row < 3; ++row) {
      cosine += rigid[4 * row + axis] * rigid[4 * row + next];
    }
    if (std::abs(cosine) > kRightAngle) return std::nullopt;
  }
  // A box is its own mirror image.
  if (determinant(rigid) < 0) {
    for (std::size_t row = 0; row < 3; ++row) rigid[4 * row] = -rigid[4 * row];
  }
  return SupportRegion{
      .name = {},
      .world_from_region = poseOf(rigid),
      .half_extents = {static_cast<float>(halves[0]), static_cast<float>(halves[1]),
                       static_cast<float>(halves[2])}};
}

bool isUpright(const StatedBox& box, const Affine& world_from_box, const ReceptacleParent& parent) {
  // Places do not tip over; those of Z up often do not say where up is.
  if (parent.kind == ReceptacleParent::Kind::kPlace && !box.states_up) return true;
  const std::size_t axis = box.up_axis;
  const double length =
      std::hypot(world_from_box[axis], world_from_box[4 + axis], world_from_box[8 + axis]);
  return box.up_sign * world_from_box[4 + axis] >= kUpright * length;
}

bool isTurned(const StatedBox& box) {
  constexpr double kRounding = 1e-9;
  return std::abs(box.rotation[0]) < 1 - kRounding;
}

/// Adds the box of one annotation, or says why there is none.
void placeBox(const std::string& key, const AttributeLayer& stated, const ReceptacleParent& parent,
              PlacedReceptacles& placed) {
  BoxReader reader(stated);
  const auto box = reader.read(key);
  const auto world_from_box = box ? boxFrame(*box, parent, reader) : std::nullopt;
  if (!world_from_box) return placed.warnings.push_back(reader.warning());
  if (!isUpright(*box, *world_from_box, parent)) return;
  auto region = rigidBox(*world_from_box, box->half_extents);
  if (!region) {
    reader.error("scale", "the scales of its template and instance leave the box oblique");
    return placed.warnings.push_back(reader.warning());
  }
  if (parent.kind != ReceptacleParent::Kind::kPlace && isTurned(*box)) {
    reader.error("rotation",
                 "only boxes of stages and scenes are turned, as in Habitat; this one "
                 "is taken as if it were not");
    placed.warnings.push_back(reader.warning());
  }
  region->name = parent.name.empty() ? box->name : parent.name + "|" + box->name;
  placed.regions.push_back(std::move(*region));
}

/// Members of `layer` replace those of `stated`, whose others stay.
void stateOver(const AttributeLayer& layer, AttributeLayer& stated) {
  stated.file = layer.file;
  stated.place = layer.place;
  if (stated.json.is_object() && layer.json.is_object()) {
    stated.json.update(layer.json);
  } else {
    stated.json = layer.json;
  }
}

/// Meshes that stand for receptacles in one file.
struct MeshReceptacles {
  std::string first;
  std::size_t count = 0;
};

}  // namespace

void collectReceptacles(const std::string& file, const JsonNode& owner, ReceptacleTexts& stated) {
  const JsonNode all = JsonReader::member(owner, "user_defined");
  if (all.json == nullptr || !all.json->is_object()) return;
  for (auto member = all.json->begin(); member != all.json->end(); ++member) {
    if (!member.key().starts_with(kPrefix)) continue;
    stateOver({file, fmt::format("{}.{}", all.place, member.key()), *member}, stated[member.key()]);
  }
}

void addStated(const ReceptacleTexts& more, ReceptacleTexts& stated) {
  for (const auto& [key, layer] : more) stateOver(layer, stated[key]);
}

PlacedReceptacles placeReceptacles(const ReceptacleTexts& stated, const ReceptacleParent& parent) {
  PlacedReceptacles placed;
  std::map<std::string, MeshReceptacles> meshes;
  for (const auto& [key, layer] : stated) {
    if (key.starts_with(kBoxPrefix)) {
      placeBox(key, layer, parent, placed);
    } else if (key.starts_with(kMeshPrefix)) {
      MeshReceptacles& mesh = meshes[layer.file];
      if (++mesh.count == 1) mesh.first = layer.place;
    } else {
      placed.warnings.push_back(
          {layer.file, fmt::format("{}: it is neither {}* nor {}*, so that it cannot be read",
                                   layer.place, kBoxPrefix, kMeshPrefix)});
    }
  }
  for (const auto& [file, mesh] : meshes) {
    placed.warnings.push_back(
        {file,
         fmt::format("{}{}: receptacles made of meshes are not supported; boxes ({}*) are",
                     mesh.first, mesh.count > 1 ? fmt::format(" and {} more", mesh.count - 1) : "",
                     kBoxPrefix)});
  }
  return placed;
}

}  // namespace galactic::bake
