#include "view/page_assets.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>
#include <utility>
#include <vector>

#include "galactic/episode_set.h"
#include "galactic/object_set.h"
#include "galactic/robot.h"
#include "galactic/scene.h"
#include "galactic/schema/pack_generated.h"
#include "support/try.h"
#include "view/page_grid.h"

namespace galactic {
namespace {

std::span<const float> floatsOf(const Pose& pose) {
  static_assert(sizeof(Pose) == 7 * sizeof(float));
  return {&pose.translation.x, 7};
}

std::span<const float> floatsOf(const Vec3& v) {
  static_assert(sizeof(Vec3) == 3 * sizeof(float));
  return {&v.x, 3};
}

template <class T>
std::span<const std::uint8_t> bytesOf(std::span<const T> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

void writeNames(JsonWriter& json, std::string_view key,
                const std::vector<std::string_view>& names) {
  json.begin(key, '[');
  for (const std::string_view name : names) json.text("", name);
  json.end(']');
}

/// Four numbers a sphere: center in its frame, radius.
void writeSpheres(JsonWriter& json, std::span<const SetSphere> spheres,
                  std::span<const float> radii) {
  std::vector<float> numbers;
  for (const SetSphere& sphere : spheres) {
    const Vec3& center = sphere.center;
    numbers.insert(numbers.end(), {center.x, center.y, center.z, radii[sphere.radius_index]});
  }
  json.numbers("spheres", std::span<const float>(numbers));
}

void writeSurface(JsonWriter& json, PageData& data, std::string_view key,
                  const schema::Surface* surface) {
  if (surface == nullptr || surface->triangles()->size() == 0) return;
  const auto& positions = *surface->positions();
  Chunk chunk;
  chunk.add("positions", std::span(reinterpret_cast<const float*>(positions.Data()),
                                   std::size_t{3} * positions.size()));
  chunk.add("corners", std::span(surface->triangles()->data(), surface->triangles()->size()));
  chunk.add("colors", std::span(surface->colors()->data(), surface->colors()->size()));
  data.add(json, key, chunk);
}

void writeMaterials(JsonWriter& json, const RenderMeshes& meshes,
                    const std::vector<std::size_t>& textures) {
  json.begin("materials", '[');
  for (const RenderMaterial& material : meshes.materials) {
    json.begin("", '{');
    json.text("name", material.name);
    json.number("color", material.color);
    if (material.texture >= 0) {
      json.number("texture", textures[static_cast<std::size_t>(material.texture)]);
    }
    json.number("alpha_cutoff", material.alpha_cutoff);
    json.end('}');
  }
  json.end(']');
}

void writeModels(JsonWriter& json, const RenderMeshes& meshes) {
  json.begin("models", '[');
  for (const RenderModel& model : meshes.models) {
    json.begin("", '{');
    json.number("part", model.part);
    json.number("step", model.step);
    json.number("first_cluster", model.first_cluster);
    json.number("cluster_count", model.cluster_count);
    json.numbers("min", floatsOf(model.bounds_min));
    json.numbers("max", floatsOf(model.bounds_max));
    json.number("triangles", model.triangles);
    json.number("source_triangles", model.source_triangles);
    json.number("largest_error", model.largest_error);
    json.end('}');
  }
  json.end(']');
}

/// What a texel is expected to be: the median of its neighbors and of the plane through them
/// (LOCO-I, Weinberger et al. 2000).
std::uint8_t expected(std::uint8_t left, std::uint8_t above, std::uint8_t corner) {
  const auto [low, high] = std::minmax(left, above);
  if (corner >= high) return low;
  if (corner <= low) return high;
  return static_cast<std::uint8_t>(left + above - corner);
}

/// An image of RGBA as four planes (red less green, green, blue less green, alpha) of what differs
/// from the expected: compresses better than texels do.
std::vector<std::uint8_t> residualsOf(std::span<const std::uint8_t> texels, std::size_t size) {
  const std::size_t count = size * size;
  std::vector<std::uint8_t> residuals;
  residuals.reserve(4 * count);
  std::vector<std::uint8_t> plane(count);
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const bool is_relative = channel == 0 || channel == 2;
    for (std::size_t n = 0; n < count; ++n) {
      const int green = is_relative ? texels[4 * n + 1] : 0;
      plane[n] = static_cast<std::uint8_t>(texels[4 * n + channel] - green);
    }
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint8_t left = n % size > 0 ? plane[n - 1] : std::uint8_t{0};
      const std::uint8_t above = n >= size ? plane[n - size] : std::uint8_t{0};
      const bool has_corner = n % size > 0 && n >= size;
      const std::uint8_t corner = has_corner ? plane[n - size - 1] : std::uint8_t{0};
      residuals.push_back(static_cast<std::uint8_t>(plane[n] - expected(left, above, corner)));
    }
  }
  return residuals;
}

void writeMarks(JsonWriter& json, const Robot& robot) {
  if (const auto& hand = robot.endEffector()) {
    json.begin("grasp", '{');
    json.number("link", hand->link);
    json.numbers("point", floatsOf(hand->grasp_point));
    json.number("radius", hand->grasp_radius);
    json.end('}');
  }
  if (const auto& camera = robot.camera()) {
    json.begin("camera", '{');
    json.number("link", camera->link);
    json.numbers("pose", floatsOf(camera->link_from_camera));
    json.number("vertical_fov", camera->vertical_fov);
    json.end('}');
  }
  if (const auto& base = robot.base()) {
    json.begin("base", '{');
    json.number("root_height", base->root_height);
    json.number("forward_step", base->forward_step);
    json.number("turn_step", base->turn_step);
    json.numbers("footprint_min", floatsOf(base->footprint_min));
    json.numbers("footprint_max", floatsOf(base->footprint_max));
    json.number("footprint_radius", base->footprint_radius);
    json.end('}');
  }
}

void writeLinks(JsonWriter& json, PageData& data, const Robot& robot, const schema::Robot& stored) {
  json.begin("links", '[');
  for (std::size_t n = 0; n < robot.links().size(); ++n) {
    const LinkFrame& link = robot.links()[n];
    json.begin("", '{');
    json.text("name", robot.linkName(n));
    json.text("joint", robot.jointName(n));
    json.numbers("frame", floatsOf(link.parent_from_joint));
    json.numbers("axis", floatsOf(link.axis));
    json.number("parent", link.parent);
    json.number("position", link.position);
    json.number("multiplier", link.multiplier);
    json.number("offset", link.offset);
    json.number("type", static_cast<unsigned>(link.type));
    for (const schema::LinkSurface* surface : *stored.surfaces()) {
      if (surface->link() != n) continue;
      const bool is_seen =
          surface->visual() != nullptr && surface->visual()->triangles()->size() > 0;
      writeSurface(json, data, "surface", is_seen ? surface->visual() : surface->collision());
    }
    json.end('}');
  }
  json.end(']');
}

void writeJoints(JsonWriter& json, const Robot& robot) {
  json.begin("limits", '[');
  for (const PositionLimits& limits : robot.limits()) {
    json.numbers("", std::span<const float>(std::array{limits.lower, limits.upper}));
  }
  json.end(']');
  json.numbers("start", robot.startPositions());
  json.begin("controlled", '[');
  for (const ControlledJoint& joint : robot.controlledJoints()) {
    json.begin("", '{');
    json.number("position", joint.position);
    json.number("step", joint.step);
    json.number("lower", joint.lower);
    json.number("upper", joint.upper);
    json.end('}');
  }
  json.end(']');
}

}  // namespace

Result<void> AssetWriter::write(const PageAsset& asset) {
  const PackFile& pack = *asset.pack;
  json_.begin("", '{');
  json_.text("file", std::filesystem::path(pack.where()).filename().string());
  json_.text("kind", packKindName(pack.kind()));
  json_.number("bytes", pack.bytes().size());
  if (!asset.facts.empty()) json_.raw("facts", asset.facts);
  writeMeshes(asset);
  Result<void> written;
  if (pack.kind() == PackKind::kScene) written = writeScene(pack);
  if (pack.kind() == PackKind::kObjects) written = writeObjects(pack);
  if (pack.kind() == PackKind::kRobot) written = writeRobot(pack);
  if (pack.kind() == PackKind::kEpisodes) written = writeEpisodes(asset);
  json_.end('}');
  return written;
}

void AssetWriter::writeMeshes(const PageAsset& asset) {
  if (asset.meshes == nullptr) return;
  const RenderMeshes& meshes = *asset.meshes;
  meshes_.push_back(asset.meshes);
  std::vector<std::size_t> textures;
  for (const RenderTexture& texture : meshes.textures) textures.push_back(textureNumber(texture));
  json_.begin("meshes", '{');
  writeModels(json_, meshes);
  writeMaterials(json_, meshes, textures);
  writeNames(json_, "semantics", meshes.semantics);
  json_.number("missing_textures", meshes.missing_textures.size());
  Chunk chunk;
  chunk.add("clusters", bytesOf(meshes.clusters));
  chunk.addPlanes("vertices", meshes.vertices);
  chunk.add("triangles", meshes.triangles);
  chunk.add("colors", meshes.colors);
  data_.add(json_, "data", chunk);
  json_.end('}');
}

std::size_t AssetWriter::textureNumber(const RenderTexture& texture) {
  const std::string_view texels(reinterpret_cast<const char*>(texture.texels.data()),
                                texture.texels.size());
  const auto [found, added] = number_of_texels_.try_emplace(texels, textures_.size());
  if (added) textures_.push_back(&texture);
  return found->second;
}

Result<void> AssetWriter::writeScene(const PackFile& pack) {
  ASSIGN_OR_RETURN(const auto scene, Scene::from(pack));
  const schema::Bounds& bounds = *pack.root().asset_as_Scene()->bounds();
  json_.begin("scene", '{');
  json_.text("name", scene.name());
  json_.numbers("min", std::span(reinterpret_cast<const float*>(&bounds.min()), 3));
  json_.numbers("max", std::span(reinterpret_cast<const float*>(&bounds.max()), 3));
  json_.begin("grids", '[');
  for (const ColumnGrid& grid : scene.grids()) writeGrid(grid, json_, data_);
  json_.end(']');
  json_.end('}');
  return {};
}

Result<void> AssetWriter::writeObjects(const PackFile& pack) {
  ASSIGN_OR_RETURN(const auto set, ObjectSet::from(pack));
  const auto& stored = *pack.root().asset_as_ObjectSet()->objects();
  json_.begin("objects", '[');
  for (std::size_t n = 0; n < set.objects().size(); ++n) {
    const ObjectModel& object = set.objects()[n];
    json_.begin("", '{');
    json_.text("name", object.name);
    json_.numbers("box", floatsOf(object.box.pose));
    json_.numbers("half_extents", floatsOf(object.box.half_extents));
    writeSpheres(json_, object.spheres, set.radii());
    json_.begin("stable_poses", '[');
    for (const StablePose& pose : object.stable_poses) {
      json_.begin("", '{');
      json_.numbers("rotation", std::span<const float>(&pose.rotation.x, 4));
      json_.number("height", pose.height);
      json_.number("likelihood", pose.likelihood);
      json_.end('}');
    }
    json_.end(']');
    writeSurface(json_, data_, "surface",
                 stored.Get(static_cast<flatbuffers::uoffset_t>(n))->surface());
    json_.end('}');
  }
  json_.end(']');
  return {};
}

Result<void> AssetWriter::writeRobot(const PackFile& pack) {
  ASSIGN_OR_RETURN(const auto robot, Robot::from(pack));
  json_.begin("robot", '{');
  json_.text("name", robot.name());
  writeLinks(json_, data_, robot, *pack.root().asset_as_Robot());
  writeJoints(json_, robot);
  json_.begin("groups", '[');
  for (const SphereGroup& group : robot.groups()) {
    json_.begin("", '{');
    json_.number("link", group.link);
    writeSpheres(json_, group.spheres, robot.radii());
    json_.end('}');
  }
  json_.end(']');
  std::vector<std::uint32_t> pairs;
  for (const GroupPair& pair : robot.testedPairs()) {
    pairs.insert(pairs.end(), {pair.first, pair.second});
  }
  json_.numbers("tested_pairs", std::span<const std::uint32_t>(pairs));
  writeMarks(json_, robot);
  json_.end('}');
  return {};
}

Result<void> AssetWriter::writeEpisodes(const PageAsset& asset) {
  ASSIGN_OR_RETURN(const auto set, EpisodeSet::from(*asset.pack));
  std::vector<std::uint32_t> which = asset.episodes;
  if (which.empty()) {
    which.resize(set.episodes().size());
    std::iota(which.begin(), which.end(), 0U);
  }
  std::vector<std::uint32_t> numbers;
  std::vector<float> starts;
  std::vector<float> joints;
  std::vector<std::uint32_t> placed;
  std::vector<float> poses;
  for (const std::uint32_t n : which) {
    const Episode& episode = set.episodes()[n];
    numbers.insert(numbers.end(), {episode.scene, static_cast<std::uint32_t>(placed.size()),
                                   episode.placement_count, episode.target});
    const Vec3& base = episode.base_position;
    starts.insert(starts.end(), {base.x, base.y, base.z, episode.base_yaw});
    const auto goal = floatsOf(episode.goal);
    starts.insert(starts.end(), goal.begin(), goal.end());
    const auto given = set.startPositions(n);
    joints.insert(joints.end(), given.begin(), given.end());
    for (const Placement& placement : set.placements(episode)) {
      placed.push_back(placement.object);
      const auto pose = floatsOf(placement.pose);
      poses.insert(poses.end(), pose.begin(), pose.end());
    }
  }
  json_.begin("episodes", '{');
  json_.text("name", set.name());
  writeNames(json_, "scenes", set.sceneNames());
  writeNames(json_, "objects", set.objectNames());
  json_.text("robot", set.robotName());
  writeNames(json_, "start_joints", set.startJoints());
  json_.number("count", which.size());
  Chunk chunk;
  chunk.add("which", std::span<const std::uint32_t>(which));
  chunk.add("numbers", std::span<const std::uint32_t>(numbers));
  chunk.add("starts", std::span<const float>(starts));
  chunk.add("joints", std::span<const float>(joints));
  chunk.add("placed", std::span<const std::uint32_t>(placed));
  chunk.add("poses", std::span<const float>(poses));
  data_.add(json_, "data", chunk);
  json_.end('}');
  return {};
}

void AssetWriter::writeTextures(std::string_view key) {
  json_.begin(key, '[');
  for (const RenderTexture* texture : textures_) {
    const bool is_blocks = texture->format == TexelFormat::kBc1;
    std::span<const std::uint8_t> texels = texture->texels;
    std::uint32_t size = texture->size;
    const auto level_bytes = [is_blocks](std::size_t edge) {
      constexpr std::size_t kBlockEdge = 4;
      constexpr std::size_t kBlockBytes = 8;
      const std::size_t blocks = (edge + kBlockEdge - 1) / kBlockEdge;
      return is_blocks ? blocks * blocks * kBlockBytes : edge * edge * sizeof(std::uint32_t);
    };
    for (; size > texture_size_; size /= 2) texels = texels.subspan(level_bytes(size));
    texels = texels.first(level_bytes(size));
    json_.begin("", '{');
    json_.text("name", texture->name);
    json_.number("size", size);
    json_.text("format", is_blocks ? "bc1" : "rgba8");
    Chunk chunk;
    if (is_blocks) {
      chunk.add("texels", texels);
    } else {
      chunk.add("texels", std::span<const std::uint8_t>(residualsOf(texels, size)));
    }
    data_.add(json_, "data", chunk);
    json_.end('}');
  }
  json_.end(']');
}

}  // namespace galactic
