#include "robot_description/geometry_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/srgb.h"
#include "fit/convex_hull.h"
#include "galactic/bake/triangle_mesh.h"
#include "import/asset_extents.h"
#include "import/source_files.h"
#include "robot_description/frames.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// A part that is smaller or larger than this in all directions causes a warning about its unit.
/// Meters.
constexpr double kSmallestPart = 0.002;
constexpr double kLargestPart = 10;

/// Colors in robots' files are those on a screen (sRGB).
std::array<float, 4> linearColor(const std::array<double, 4>& c) {
  const auto channel = [&](std::size_t n) {
    return static_cast<float>(srgbDecoded(std::clamp(c[n], 0.0, 1.0)));
  };
  return {channel(0), channel(1), channel(2), static_cast<float>(std::clamp(c[3], 0.0, 1.0))};
}

std::size_t sizeCount(DescribedGeometry geometry) {
  switch (geometry) {
    case DescribedGeometry::kSphere:
      return 1;
    case DescribedGeometry::kCylinder:
      return 2;
    case DescribedGeometry::kBox:
    case DescribedGeometry::kEllipsoid:
    case DescribedGeometry::kMesh:
      return 3;
  }
  return 0;
}

std::string_view sizeName(DescribedGeometry geometry) {
  switch (geometry) {
    case DescribedGeometry::kSphere:
      return "sphere of radius";
    case DescribedGeometry::kCylinder:
      return "cylinder of radius and length";
    case DescribedGeometry::kBox:
      return "box of size";
    case DescribedGeometry::kEllipsoid:
      return "ellipsoid of half axes";
    case DescribedGeometry::kMesh:
      return "mesh with scale";
  }
  return "";
}

/// Refuses numbers that no robot has. Sizes of 0 pass, except in the scale of a mesh.
Result<void> checkShape(const DescribedShape& shape, const std::string& place) {
  const std::span sizes(shape.size.data(), sizeCount(shape.geometry));
  const auto describe = [&](std::string_view wanted) {
    return fmt::format("a {} {}: {}", sizeName(shape.geometry), fmt::join(sizes, " "), wanted);
  };
  const Affine& t = shape.link_from_shape;
  if (!isFinite(t) ||
      !std::all_of(sizes.begin(), sizes.end(), [](double s) { return std::isfinite(s); })) {
    return fail(ErrorCode::kInvalidInput, place,
                "its origin or size has a number that is not finite; correct it");
  }
  const double farthest = std::max({std::abs(t[3]), std::abs(t[7]), std::abs(t[11])});
  if (farthest > kMaxCoordinate) {
    return fail(ErrorCode::kInvalidInput, place,
                fmt::format("its origin is {} m away, at most {} m are possible; is the unit "
                            "meters?",
                            farthest, kMaxCoordinate));
  }
  if (shape.geometry == DescribedGeometry::kMesh) {
    const bool flat = std::any_of(sizes.begin(), sizes.end(), [](double s) { return s == 0; });
    if (flat) return fail(ErrorCode::kInvalidInput, place, describe("a scale of 0 flattens it"));
    return {};
  }
  for (const double size : sizes) {
    if (size < 0) return fail(ErrorCode::kInvalidInput, place, describe("negative; correct it"));
    if (size > kMaxCoordinate) {
      return fail(
          ErrorCode::kInvalidInput, place,
          describe(fmt::format("at most {} m are possible; is the unit meters?", kMaxCoordinate)));
    }
  }
  return {};
}

/// Extents, along the axes of the file, of a mesh that was read as Z up.
std::array<double, 3> sizeInFile(const SourceAsset& asset) {
  const std::array<double, 3> size = extentsOf(asset);
  return {size[0], size[2], size[1]};
}

/// A mesh that is inside the robot's file, in the form that importMesh returns. If it only has
/// points, this is their convex hull, as in MuJoCo. `file` is the name of the robot's file.
SourceAsset assetOf(const DescribedMesh& described, const std::string& file) {
  SourceAsset asset;
  asset.name = described.name;
  asset.read.files.push_back({.name = file});
  SourceMesh& mesh = asset.meshes.emplace_back();
  mesh.name = described.name;
  for (const auto& [x, y, z] : described.points) {
    mesh.positions.push_back(
        {static_cast<float>(x), static_cast<float>(z), static_cast<float>(-y)});
  }
  mesh.triangles = described.triangles;
  if (mesh.triangles.empty()) {
    const fit::ConvexHull hull = fit::convexHull(mesh.positions);
    for (const std::vector<std::uint32_t>& face : hull.faces) {
      for (std::size_t n = 2; n < face.size(); ++n) {
        mesh.triangles.push_back({hull.corners[face[0]].source, hull.corners[face[n - 1]].source,
                                  hull.corners[face[n]].source});
      }
    }
  }
  asset.instances.push_back({.name = mesh.name, .mesh = 0, .world_from_mesh = kIdentityAffine});
  return asset;
}

bool hasSize(const DescribedShape& shape) {
  return std::all_of(shape.size.begin(), shape.size.begin() + sizeCount(shape.geometry),
                     [](double size) { return size != 0; });
}

}  // namespace

GeometryBuilder::GeometryBuilder(const fs::path& path, std::span<const DescribedMesh> own_meshes,
                                 const RobotImportOptions& options, SourceRobot& robot)
    : path_(path),
      own_meshes_(own_meshes),
      options_(options),
      robot_(robot),
      resolver_(path, options),
      up_from_file_(options.up == UpAxis::kZ ? kYUpFromZUp : kIdentityAffine) {}

std::string GeometryBuilder::withoutFile(const std::string& place) const {
  const std::string prefix = path_.string() + ": ";
  return place.starts_with(prefix) ? place.substr(prefix.size()) : place;
}

void GeometryBuilder::warn(const std::string& place, const std::string& message) {
  robot_.warnings.push_back(fmt::format("{}: {}", withoutFile(place), message));
}

Result<GeometryBuilder::LoadedMesh> GeometryBuilder::loadFile(const fs::path& file,
                                                              bool hides_looks) {
  // Takes the points in the file as Z up, whatever up axis the file states.
  MeshImportOptions mesh_options;
  mesh_options.up = UpAxis::kZ;
  mesh_options.smallest_size = 0;
  mesh_options.allow_outside = options_.allow_outside;
  auto asset = importMesh(file, mesh_options);
  if (!asset) {
    if (asset.error().code == ErrorCode::kInternal) return tl::unexpected(asset.error());
    robot_.read.is_settled = false;
    if (describeFile(file)) robot_.read.files.push_back({.name = nameRelativeTo(path_, file)});
    std::string failure =
        fmt::format("mesh '{}' does not load: {}", nameRelativeTo(path_, asset.error().where),
                    asset.error().message);
    robot_.unreadable.push_back(failure);
    return LoadedMesh{.index = {}, .failure = std::move(failure)};
  }
  const fs::path folder = file.parent_path();
  for (SourceFile& source : asset->read.files) {
    source.name = nameRelativeTo(path_, folder / source.name);
    robot_.read.files.push_back(source);
  }
  for (const std::string& absent : asset->read.absent) {
    robot_.read.absent.push_back(nameRelativeTo(path_, folder / absent));
  }
  for (SourceMaterial& material : asset->materials) {
    std::string& texture = material.base_color_texture;
    std::error_code ignored;
    if (texture.empty() || texture.starts_with('*')) continue;
    if (fs::exists(folder / texture, ignored)) texture = nameRelativeTo(path_, folder / texture);
  }
  for (const std::string& warning : asset->warnings) {
    const bool is_of_looks = std::ranges::find(asset->missing, warning) != asset->missing.end();
    if (!hides_looks || !is_of_looks) warn(nameRelativeTo(path_, file), warning);
  }
  robot_.meshes.push_back(std::move(*asset));
  return LoadedMesh{.index = static_cast<std::uint32_t>(robot_.meshes.size() - 1),
                    .size = sizeInFile(robot_.meshes.back()),
                    .failure = {}};
}

GeometryBuilder::LoadedMesh& GeometryBuilder::loadOwn(std::uint32_t own_mesh) {
  const auto [entry, is_new] = loaded_own_.try_emplace(own_mesh);
  if (!is_new) return entry->second;
  robot_.meshes.push_back(assetOf(own_meshes_[own_mesh], nameRelativeTo(path_, path_)));
  entry->second.index = static_cast<std::uint32_t>(robot_.meshes.size() - 1);
  entry->second.size = sizeInFile(robot_.meshes.back());
  return entry->second;
}

std::string GeometryBuilder::findTexture(const DescribedShape& shape, const std::string& place) {
  if (shape.texture.empty()) return {};
  const MeshResolution resolution = resolver_.resolve(shape.texture);
  if (resolution.file.empty()) {
    warn(place, fmt::format("the texture '{}' of its material is missing; looked for {}; its color "
                            "is drawn",
                            shape.texture, resolution.how));
    return {};
  }
  std::string name = nameRelativeTo(path_, resolution.file);
  robot_.read.files.push_back({.name = name});
  return name;
}

const MeshResolution& GeometryBuilder::resolve(const std::string& reference,
                                               const std::string& place) {
  const auto [entry, is_new] = resolutions_.try_emplace(reference);
  MeshResolution& resolution = entry->second;
  if (!is_new) return resolution;
  resolution = resolver_.resolve(reference);
  if (resolution.file.empty()) return resolution;
  const std::string file = nameRelativeTo(path_, resolution.file);
  robot_.resolutions.push_back(fmt::format("{}: {} ({})", reference, file, resolution.how));
  if (resolution.guessed) {
    warn(place,
         fmt::format("mesh '{}' was found only as '{}' ({}); name the package's folder to be "
                     "sure",
                     reference, file, resolution.how));
  }
  return resolution;
}

Result<std::optional<std::uint32_t>> GeometryBuilder::loadMesh(const DescribedShape& shape,
                                                               const std::string& place,
                                                               std::vector<LostShape>& lost) {
  if (shape.own_mesh) return checkedMesh(shape, place, loadOwn(*shape.own_mesh));
  const MeshResolution& resolution = resolve(shape.mesh, place);
  if (resolution.file.empty()) {
    robot_.missing.push_back(shape.mesh);
    lost.push_back(
        {place, fmt::format("mesh '{}' is missing; looked for {}", shape.mesh, resolution.how)});
    return std::nullopt;
  }
  auto loaded = loaded_.find(resolution.file);
  if (loaded == loaded_.end()) {
    ASSIGN_OR_RETURN(auto mesh, loadFile(resolution.file, shape.hides_looks));
    loaded = loaded_.emplace(resolution.file, std::move(mesh)).first;
  }
  const LoadedMesh& mesh = loaded->second;
  if (!mesh.index) {
    lost.push_back({place, mesh.failure});
    return std::nullopt;
  }
  return checkedMesh(shape, place, mesh);
}

std::optional<std::uint32_t> GeometryBuilder::checkedMesh(const DescribedShape& shape,
                                                          const std::string& place,
                                                          const LoadedMesh& mesh) {
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    largest = std::max(largest, mesh.size[i] * std::abs(shape.size[i]));
  }
  if (largest < kSmallestPart || largest > kLargestPart) {
    warn(place,
         fmt::format("mesh '{}' is {:.3g} m large: is its unit the meter? Correct the scale "
                     "of the <mesh>",
                     shape.own_mesh ? own_meshes_[*shape.own_mesh].name : shape.mesh, largest));
  }
  return mesh.index;
}

Result<std::optional<LinkShape>> GeometryBuilder::convert(const DescribedShape& shape,
                                                          const std::string& place,
                                                          std::vector<LostShape>& lost) {
  RETURN_IF_ERROR(checkShape(shape, place));
  if (!hasSize(shape)) {
    warn(place, fmt::format("a {} with a size of 0 is left out", sizeName(shape.geometry)));
    return std::nullopt;
  }
  LinkShape converted;
  const auto& s = shape.size;
  Affine link_from_shape = shape.link_from_shape;
  switch (shape.geometry) {
    case DescribedGeometry::kBox:
      converted.geometry = BoxShape{{s[0], s[2], s[1]}};
      break;
    case DescribedGeometry::kCylinder:
      converted.geometry = CylinderShape{.radius = s[0], .length = s[1]};
      break;
    case DescribedGeometry::kSphere:
      converted.geometry = SphereShape{s[0]};
      break;
    case DescribedGeometry::kEllipsoid: {
      const double longest = std::max({s[0], s[1], s[2]});
      converted.geometry = SphereShape{longest};
      link_from_shape = compose(link_from_shape, {s[0] / longest, 0, 0, 0, 0, s[1] / longest, 0, 0,
                                                  0, 0, s[2] / longest, 0});
      break;
    }
    case DescribedGeometry::kMesh: {
      const auto mesh = loadMesh(shape, place, lost);
      if (!mesh) return tl::unexpected(mesh.error());
      if (!*mesh) return std::nullopt;
      converted.geometry = MeshShape{**mesh};
      link_from_shape = compose(link_from_shape, {s[0], 0, 0, 0, 0, s[1], 0, 0, 0, 0, s[2], 0});
      break;
    }
  }
  // Primitives and meshes are converted to Y up in their own frames, too.
  converted.link_from_shape = conjugate(up_from_file_, link_from_shape, kZUpFromYUp);
  if (shape.has_color) converted.color = linearColor(shape.color);
  converted.hides_looks = shape.hides_looks;
  if (shape.hides_looks && shape.geometry == DescribedGeometry::kMesh) {
    converted.texture = findTexture(shape, place);
  } else if (!shape.texture.empty()) {
    warn(place, fmt::format("the texture '{}' of its material is not used", shape.texture));
  }
  return converted;
}

Result<std::vector<GeometryBuilder::LostShape>> GeometryBuilder::addList(const DescribedLink& link,
                                                                         const ShapeList& list) {
  std::vector<LostShape> lost;
  for (std::size_t i = 0; i < list.from.size(); ++i) {
    const std::string place =
        fmt::format("{}: link '{}' {} {}", path_.string(), link.name, list.kind, i + 1);
    auto shape = convert(list.from[i], place, lost);
    if (!shape) return tl::unexpected(shape.error());
    if (*shape) list.to.push_back(**shape);
  }
  return lost;
}

void GeometryBuilder::noteSearch() {
  if (resolver_.hasSearched()) robot_.read.is_settled = false;
  for (const fs::path& file : resolver_.packageFiles()) {
    robot_.read.files.push_back({.name = nameRelativeTo(path_, file)});
  }
  for (const fs::path& absent : resolver_.search().absent()) {
    robot_.read.absent.push_back(nameRelativeTo(path_, absent));
  }
}

Result<void> GeometryBuilder::addShapes(const DescribedLink& from, SourceLink& to) {
  ASSIGN_OR_RETURN(const auto lost_collisions,
                   addList(from, {from.collisions, to.collisions, "collision"}));
  ASSIGN_OR_RETURN(const auto lost_visuals, addList(from, {from.visuals, to.visuals, "visual"}));
  to.visuals_are_lost = !lost_visuals.empty() && to.visuals.empty();
  std::string drawn_instead;
  if (to.visuals_are_lost) {
    drawn_instead = to.collisions.empty() ? "; the link is not drawn"
                                          : "; the link's collision geometry is drawn instead";
  }
  for (const auto& [place, reason] : lost_collisions) warn(place, reason);
  for (const auto& [place, reason] : lost_visuals) warn(place, reason + drawn_instead);

  const auto& lost = from.collisions.empty() ? lost_visuals : lost_collisions;
  const bool lost_all =
      !lost.empty() && (from.collisions.empty() ? to.visuals : to.collisions).empty();
  const std::string place = fmt::format("{}: link '{}'", path_.string(), from.name);
  if (lost_all && !options_.allow_missing) {
    return fail(ErrorCode::kInvalidInput, place,
                fmt::format("it lost all its {} geometry: {}: {}; name the package's folder "
                            "(`package` NAME=DIR), put the file there, or give `allow-missing`",
                            from.collisions.empty() ? "visual" : "collision",
                            withoutFile(lost.front().place), lost.front().reason));
  }
  if (lost_all) {
    warn(place, "it lost all its geometry and collides with nothing");
  } else if (from.collisions.empty() && !to.visuals.empty()) {
    warn(place, "it has no collision geometry; its visual geometry stands in for it");
  }
  return {};
}

}  // namespace galactic::bake
