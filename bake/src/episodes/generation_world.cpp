#include "episodes/generation_world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "galactic/render_meshes.h"
#include "galactic/schema/pack_generated.h"
#include "layout/render_layout.h"
#include "support/text/counted.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

bool sameRadii(std::span<const float> a, std::span<const float> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

std::string listOf(std::span<const float> radii) {
  return fmt::format("{}", fmt::join(radii, ", "));
}

Result<void> checkRobot(const Robot& robot) {
  const auto refuse = [&](std::string_view what) {
    return fail(ErrorCode::kInvalidInput, std::string(robot.name()),
                fmt::format("the robot has no {}; bake it with a recipe that gives it one", what));
  };
  if (!robot.base()) return refuse("base");
  if (!robot.endEffector()) return refuse("end effector");
  if (robot.spheres().empty()) return refuse("spheres");
  return {};
}

Result<void> checkRadii(const Scene& scene, std::span<const ObjectSet> sets, const Robot& robot) {
  std::vector<float> radii;
  radii.reserve(scene.grids().size());
  for (const ColumnGrid& grid : scene.grids()) radii.push_back(grid.radius());
  const auto refuse = [&](std::string_view other, std::span<const float> found) {
    return fail(ErrorCode::kInvalidInput, std::string(scene.name()),
                fmt::format("the scene is baked for spheres of {} m, the {} for {} m; bake all "
                            "with the same `radii`",
                            listOf(radii), other, listOf(found)));
  };
  if (radii.empty()) {
    return fail(ErrorCode::kInvalidInput, std::string(scene.name()), "the scene has no grids");
  }
  if (!sameRadii(radii, robot.radii())) return refuse("robot", robot.radii());
  for (const ObjectSet& set : sets) {
    if (!sameRadii(radii, set.radii())) return refuse("objects", set.radii());
  }
  return {};
}

/// Sorts by name and refuses equal names.
template <class T, class NameOf>
Result<void> sortByName(std::vector<T>& items, std::string_view kind, const NameOf& name_of) {
  std::ranges::sort(items, {}, name_of);
  const auto twice = std::ranges::adjacent_find(items, {}, name_of);
  if (twice == items.end()) return {};
  return fail(ErrorCode::kInvalidInput, std::string(name_of(*twice)),
              fmt::format("two {} have this name; give {} of different names", kind, kind));
}

std::uint64_t sourceBytes(const PackFile& pack) {
  std::uint64_t bytes = 0;
  const auto* sources = pack.root().provenance()->sources();
  if (sources == nullptr) return bytes;
  for (const schema::SourceFile* file : *sources) bytes += file->bytes();
  return bytes;
}

/// The vertices of everything that is drawn of one object, in its frame.
std::vector<Vec3> drawnPoints(const RenderMeshes& meshes, std::uint32_t model_number) {
  const RenderModel& model = meshes.models[model_number];
  std::vector<Vec3> points;
  for (std::uint32_t c = 0; c < model.cluster_count; ++c) {
    const RenderCluster& cluster = meshes.clusters[model.first_cluster + c];
    for (std::uint32_t v = 0; v < cluster.vertex_count; ++v) {
      const std::size_t vertex = cluster.first_vertex + std::size_t{v};
      const auto coordinate = [&](std::int32_t origin, VertexRow row) {
        const std::int64_t steps = std::int64_t{origin} + vertexValue(meshes, vertex, row);
        return static_cast<float>(static_cast<double>(model.step) * static_cast<double>(steps));
      };
      points.push_back({coordinate(cluster.origin_x, kVertexX),
                        coordinate(cluster.origin_y, kVertexY),
                        coordinate(cluster.origin_z, kVertexZ)});
    }
  }
  return points;
}

}  // namespace

Result<GenerationWorld> GenerationWorld::open(std::span<const PackFile* const> packs) {
  GenerationWorld world;
  for (const PackFile* pack : packs) {
    RETURN_IF_ERROR(world.add(*pack));
  }
  RETURN_IF_ERROR(world.check());
  const auto scene_name = [](const SceneOfPack& one) { return one.scene.name(); };
  RETURN_IF_ERROR(sortByName(world.scenes_, "scenes", scene_name));
  const auto object_name = [](const ObjectModel& model) { return model.name; };
  RETURN_IF_ERROR(sortByName(world.objects_, "objects", object_name));
  return world;
}

Result<void> GenerationWorld::add(const PackFile& pack) {
  switch (pack.kind()) {
    case PackKind::kScene: {
      ASSIGN_OR_RETURN(auto scene, Scene::from(pack));
      scenes_.push_back({&pack, std::move(scene), sourceBytes(pack)});
      return {};
    }
    case PackKind::kObjects:
      return addObjects(pack);
    case PackKind::kRobot: {
      if (!robot_.empty()) {
        return fail(ErrorCode::kInvalidInput, pack.where(),
                    fmt::format("is a second robot, the first is {}; give one of them",
                                robot_.front().name()));
      }
      ASSIGN_OR_RETURN(auto robot, Robot::from(pack));
      robot_.push_back(std::move(robot));
      common_packs_.push_back(&pack);
      return {};
    }
    case PackKind::kTexture:
      // The looks of scenes do not matter here.
      return {};
    case PackKind::kEpisodes:
    case PackKind::kPolicy:
    case PackKind::kWorld:
      break;
  }
  return fail(ErrorCode::kInvalidInput, pack.where(),
              fmt::format("is a pack of kind {}; episodes are generated in packs of scenes, "
                          "objects and a robot",
                          packKindName(pack.kind())));
}

Result<void> GenerationWorld::addObjects(const PackFile& pack) {
  ASSIGN_OR_RETURN(auto set, ObjectSet::from(pack));
  objects_.insert(objects_.end(), set.objects().begin(), set.objects().end());
  sets_.push_back(std::move(set));
  common_packs_.push_back(&pack);
  return {};
}

Result<void> GenerationWorld::check() const {
  if (scenes_.empty() || objects_.empty() || robot_.empty()) {
    return fail(ErrorCode::kInvalidInput, "episodes",
                fmt::format("found {}, {} and {}; episodes are generated in at least one scene, "
                            "with at least one object and one robot",
                            counted(scenes_.size(), "scene"), counted(objects_.size(), "object"),
                            counted(robot_.size(), "robot")));
  }
  if (auto checked = checkRobot(robot_.front()); !checked) return checked;
  for (const SceneOfPack& one : scenes_) {
    if (auto checked = checkRadii(one.scene, sets_, robot_.front()); !checked) return checked;
  }
  return {};
}

Result<std::vector<SettlingBody>> GenerationWorld::settlingBodies() const {
  std::vector<SettlingBody> bodies(objects_.size());
  for (const PackFile* pack : common_packs_) {
    if (pack->kind() != PackKind::kObjects) continue;
    ASSIGN_OR_RETURN(const auto set, ObjectSet::from(*pack));
    const auto meshes = renderMeshesOf(*pack);
    if (!meshes) return tl::unexpected(meshes.error());
    for (std::uint32_t part = 0; part < set.objects().size(); ++part) {
      const ObjectModel& model = set.objects()[part];
      const auto at = std::ranges::lower_bound(objects_, model.name, {}, &ObjectModel::name);
      const auto drawn = *meshes ? (*meshes)->modelOf(part) : std::nullopt;
      bodies[static_cast<std::size_t>(at - objects_.begin())] =
          drawn ? hullBody(drawnPoints(**meshes, *drawn), model) : boxBody(model);
    }
  }
  return bodies;
}

}  // namespace galactic::bake
