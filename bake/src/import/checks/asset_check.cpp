#include "import/checks/asset_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "import/affine.h"
#include "import/asset_extents.h"

namespace galactic::bake {
namespace {

tl::unexpected<Error> invalid(std::string where, std::string message) {
  return fail(ErrorCode::kInvalidInput, std::move(where), std::move(message));
}

bool isFinitePoint(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string meshPlace(const SourceAsset& asset, std::size_t index, const std::string& where) {
  return fmt::format("{}: mesh {} '{}'", where, index, asset.meshes[index].name);
}

Result<void> checkIndices(const SourceAsset& asset, std::size_t index, const std::string& where) {
  const SourceMesh& mesh = asset.meshes[index];
  const std::size_t vertices = mesh.positions.size();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      if (vertex < vertices) continue;
      return invalid(meshPlace(asset, index, where),
                     fmt::format("triangle {} uses vertex {}, but the mesh has {} vertices; "
                                 "export the file again",
                                 t, vertex, vertices));
    }
  }
  const bool ragged = (!mesh.uvs.empty() && mesh.uvs.size() != vertices) ||
                      (!mesh.colors.empty() && mesh.colors.size() != vertices);
  if (ragged) {
    return invalid(meshPlace(asset, index, where),
                   "texture coordinates or colors are not one per vertex; export the file again");
  }
  if (!asset.materials.empty() && mesh.material >= asset.materials.size()) {
    return invalid(meshPlace(asset, index, where),
                   fmt::format("uses material {}, but the file has {}; export the file again",
                               mesh.material, asset.materials.size()));
  }
  return {};
}

Result<void> checkPositions(const SourceAsset& asset, std::size_t index, const std::string& where) {
  const SourceMesh& mesh = asset.meshes[index];
  if (std::all_of(mesh.positions.begin(), mesh.positions.end(), isFinitePoint)) return {};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      const Vec3& v = mesh.positions[vertex];
      if (isFinitePoint(v)) continue;
      return invalid(
          meshPlace(asset, index, where),
          fmt::format("vertex {} of triangle {} is at ({}, {}, {}), which is not finite; "
                      "repair the mesh",
                      vertex, t, v.x, v.y, v.z));
    }
  }
  return {};
}

Result<void> checkInstance(const SourceAsset& asset, const SourceInstance& instance,
                           const std::string& where) {
  const std::string place = fmt::format("{}: node '{}'", where, instance.name);
  if (instance.mesh >= asset.meshes.size()) {
    return invalid(place, fmt::format("places mesh {}, but the file has {}; export the file again",
                                      instance.mesh, asset.meshes.size()));
  }
  if (!isFinite(instance.world_from_mesh)) {
    return invalid(place,
                   "its transform has a NaN or infinite element; correct the node or its parents");
  }
  if (!isInvertible(instance.world_from_mesh)) {
    return invalid(place,
                   "its transform flattens the mesh (a scale of 0); correct or remove the "
                   "node");
  }
  return {};
}

/// The likely values of `scale`, for messages.
constexpr std::string_view kUnits =
    "0.01 for centimeters, 0.001 for millimeters, 1 if it is right in meters";

}  // namespace

Result<void> checkAsset(const SourceAsset& asset, const std::string& where) {
  std::vector<bool> placed(asset.meshes.size(), false);
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < asset.meshes.size(); ++i) {
    if (auto checked = checkIndices(asset, i, where); !checked) return checked;
  }
  for (const SourceInstance& instance : asset.instances) {
    if (auto checked = checkInstance(asset, instance, where); !checked) return checked;
    placed[instance.mesh] = true;
    triangles += asset.meshes[instance.mesh].triangles.size();
  }
  if (triangles == 0) {
    return invalid(where,
                   fmt::format("it has no triangles ({} meshes, {} placed); expected a surface, "
                               "not points, lines or an empty scene",
                               asset.meshes.size(), asset.instances.size()));
  }
  for (std::size_t i = 0; i < asset.meshes.size(); ++i) {
    if (!placed[i]) continue;
    if (auto checked = checkPositions(asset, i, where); !checked) return checked;
  }
  return {};
}

void warnAboutSize(SourceAsset& asset, double smallest_size) {
  if (smallest_size <= 0) return;
  const std::array<double, 3> size = extentsOf(asset);
  if (*std::ranges::max_element(size) >= smallest_size) return;
  asset.warnings.push_back(fmt::format(
      "the whole scene is only {:.3g} x {:.3g} x {:.3g} m large: is its unit the meter? "
      "Give meters per unit with `scale`",
      size[0], size[1], size[2]));
}

Result<void> checkHeight(const SourceAsset& asset, const std::string& where) {
  // A room 2.5 m high is 98 inches or 250 cm, and a house of three storeys is 10 m high.
  constexpr double kGreatestHeight = 60;
  const double height = extentsOf(asset)[1];
  if (height <= kGreatestHeight) return {};
  return invalid(where, fmt::format("the scene is {:.4g} m high ({}), and homes are lower than {} "
                                    "m; give meters per unit with `scale`: {}",
                                    height, asset.convention, kGreatestHeight, kUnits));
}

Result<void> checkObjectSize(const SourceAsset& asset, const std::string& where) {
  const std::array<double, 3> size = extentsOf(asset);
  const double largest = *std::ranges::max_element(size);
  if (largest <= kLargestObject) return {};
  // Things that hands grasp, and furniture, are at least this large.
  constexpr double kSmallestLikely = 0.05;
  std::string likely;
  for (const double unit : {0.01, 0.001}) {
    const double size_in_unit = largest / asset.meters_per_unit * unit;
    if (size_in_unit < kSmallestLikely || size_in_unit > kLargestObject) continue;
    likely = fmt::format("; {} is likely", unit);
    break;
  }
  return invalid(
      where,
      fmt::format("the object is {:.4g} x {:.4g} x {:.4g} m large ({}), and objects are "
                  "smaller than {} m; give meters per unit with `scale`: {}{}",
                  size[0], size[1], size[2], asset.convention, kLargestObject, kUnits, likely));
}

}  // namespace galactic::bake
