#include "robot_description/mjcf/assets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "import/affine.h"
#include "support/text/nearest_name.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNumbers = std::numeric_limits<std::uint32_t>::max();

/// The color of a shape that states none; in this case the color of its material counts.
constexpr std::array<double, 4> kUnstatedColor{0.5, 0.5, 0.5, 1};

/// Points are read in units of a micrometer or more, whatever the scale: they must fit into floats.
constexpr double kSmallestUnit = 1e-6;

/// The name of an asset: the one it states, or else that of its file.
std::string nameOf(const MjcfAttributes& asset) {
  std::string name = asset.text("name");
  if (name.empty()) name = fs::path(asset.text("file")).stem().string();
  return name;
}

template <class Asset>
std::vector<std::string> namesOf(const std::map<std::string, Asset, std::less<>>& assets) {
  std::vector<std::string> names;
  names.reserve(assets.size());
  for (const auto& [name, unused] : assets) names.push_back(name);
  return names;
}

}  // namespace

MjcfAssets::MjcfAssets(const XmlElement& root, const MjcfDefaults& defaults,
                       const MjcfSettings& settings, MjcfFindings& findings,
                       RobotDescription& robot)
    : settings_(settings), findings_(findings) {
  std::vector<const XmlElement*> materials;
  for (const XmlElement& section : root.children) {
    if (section.name != "asset") continue;
    for (const XmlElement& asset : section.children) {
      if (asset.name == "mesh") readMesh(defaults.attributesOf(asset, ""), robot);
      if (asset.name == "texture") readTexture(defaults.attributesOf(asset, ""));
      if (asset.name == "material") materials.push_back(&asset);
      if (asset.name != "model") continue;
      findings.error(asset.place,
                     "<model> brings in another model; save the whole one as one file, as MuJoCo "
                     "does, and give that",
                     ErrorCode::kUnsupported);
    }
  }
  // Read last, because they may name textures that come after them.
  for (const XmlElement* material : materials) readMaterial(defaults.attributesOf(*material, ""));
}

std::string MjcfAssets::inFolder(const std::string& folder, const std::string& file) const {
  const fs::path path = settings_.strips_paths ? fs::path(file).filename() : fs::path(file);
  if (folder.empty() || path.is_absolute()) return path.generic_string();
  return (fs::path(folder) / path).generic_string();
}

void MjcfAssets::readMesh(const MjcfAttributes& mesh, RobotDescription& robot) {
  DescribedShape shape;
  shape.geometry = DescribedGeometry::kMesh;
  const auto scale = mesh.vector<3>("scale").value_or(std::array<double, 3>{1, 1, 1});
  const auto from = mesh.vector<3>("refpos").value_or(std::array<double, 3>{});
  // Points are translated, rotated back and then scaled.
  Affine mesh_from_file = translationOf({-from[0], -from[1], -from[2]});
  bool is_turned = false;
  if (const auto quat = mesh.vector<4>("refquat")) {
    is_turned = *quat != std::array<double, 4>{1, 0, 0, 0};
    const std::array<double, 4> back{(*quat)[0], -(*quat)[1], -(*quat)[2], -(*quat)[3]};
    if (std::hypot((*quat)[0], std::hypot((*quat)[1], (*quat)[2], (*quat)[3])) > 0) {
      mesh_from_file = compose(rotationOf(back), mesh_from_file);
    } else {
      mesh.error("refquat", "a quaternion, not zeros");
    }
  }
  const Affine scaling{scale[0], 0, 0, 0, 0, scale[1], 0, 0, 0, 0, scale[2], 0};
  if (is_turned) {
    shape.size = {1, 1, 1};
    shape.link_from_shape = compose(scaling, mesh_from_file);
  } else {
    // Equivalent, but with the scale as the size of the shape.
    shape.size = scale;
    shape.link_from_shape =
        translationOf({-from[0] * scale[0], -from[1] * scale[1], -from[2] * scale[2]});
  }
  const std::string name = nameOf(mesh);
  if (mesh.has("vertex")) {
    addPoints(mesh, scale, shape, robot);
  } else if (mesh.has("file")) {
    const std::string file = mesh.text("file");
    if (file.empty()) mesh.error("file", "the name of a file");
    shape.mesh = inFolder(settings_.mesh_folder, file);
  } else {
    findings_.error(mesh.element().place,
                    fmt::format("<mesh> '{}' has neither 'file' nor 'vertex'; meshes that MuJoCo "
                                "makes are not read: save the mesh as a file",
                                name),
                    ErrorCode::kUnsupported);
  }
  if (!meshes_.try_emplace(name, MjcfMesh{shape}).second) {
    findings_.error(mesh.element().place,
                    fmt::format("<mesh> '{}' is there twice; rename one", name));
  }
}

void MjcfAssets::addPoints(const MjcfAttributes& mesh, const std::array<double, 3>& scale,
                           DescribedShape& shape, RobotDescription& robot) const {
  const auto points = mesh.numbers("vertex", 12, kMostNumbers);
  const auto corners = mesh.numbers("face", 3, kMostNumbers);
  if (!points) return;
  if (points->size() % 3 != 0) return mesh.error("vertex", "three numbers for each point");
  if (mesh.has("face") && (!corners || corners->size() % 3 != 0)) {
    return mesh.error("face", "three numbers of points for each triangle");
  }
  for (std::size_t n = 0; n < points->size(); ++n) {
    const double scaled = (*points)[n] * std::max(std::abs(scale[n % 3]), kSmallestUnit);
    if (std::abs(scaled) <= kMaxCoordinate) continue;
    return findings_.error(
        mesh.element().place,
        fmt::format("<mesh> '{}' has a point at {:.6g} along an axis, at most {} m are possible; "
                    "is the unit meters?",
                    nameOf(mesh), scaled, kMaxCoordinate));
  }
  DescribedMesh own;
  own.name = nameOf(mesh);
  for (std::size_t n = 0; n < points->size(); n += 3) {
    own.points.push_back({(*points)[n], (*points)[n + 1], (*points)[n + 2]});
  }
  const auto count = static_cast<double>(own.points.size());
  for (std::size_t n = 0; corners && n < corners->size(); n += 3) {
    Triangle& triangle = own.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const double corner = (*corners)[n + k];
      if (!(corner >= 0 && corner < count && corner == std::floor(corner))) {
        return mesh.error("face", fmt::format("numbers of points, from 0 to {}", count - 1));
      }
      triangle[k] = static_cast<std::uint32_t>(corner);
    }
  }
  shape.own_mesh = static_cast<std::uint32_t>(robot.meshes.size());
  robot.meshes.push_back(std::move(own));
}

void MjcfAssets::readTexture(const MjcfAttributes& texture) {
  const std::string file = texture.text("file");
  textures_[nameOf(texture)] = file.empty() ? file : inFolder(settings_.texture_folder, file);
}

void MjcfAssets::readMaterial(const MjcfAttributes& material) {
  MjcfMaterial read;
  read.color = material.vector<4>("rgba").value_or(read.color);
  std::string texture = material.text("texture");
  for (const XmlElement& layer : material.element().children) {
    const std::string* role = layer.find("role");
    const std::string* name = layer.find("texture");
    const bool is_color = role != nullptr && (*role == "rgb" || *role == "rgba");
    if (layer.name == "layer" && is_color && name != nullptr) texture = *name;
  }
  if (const auto found = textures_.find(texture); found != textures_.end()) {
    read.texture = found->second;
  }
  materials_[material.text("name")] = read;
}

const MjcfMesh* MjcfAssets::meshOf(const MjcfAttributes& geom) const {
  const std::string name = geom.text("mesh");
  const auto found = meshes_.find(name);
  if (found != meshes_.end()) return &found->second;
  findings_.error(
      geom.element().place,
      name.empty()
          ? fmt::format("<{}> is a mesh and names none; give it a 'mesh'", geom.element().name)
          : fmt::format("<{}> names the mesh '{}', which no <asset> has; {}", geom.element().name,
                        name, suggestNames(name, namesOf(meshes_))));
  return nullptr;
}

void MjcfAssets::paint(const MjcfAttributes& geom, DescribedShape& shape) const {
  const auto stated = geom.vector<4>("rgba");
  if (geom.has("material")) {
    const std::string name = geom.text("material");
    const auto found = materials_.find(name);
    if (found == materials_.end()) {
      findings_.error(
          geom.element().place,
          fmt::format("<{}> names the material '{}', which no <asset> has; {}", geom.element().name,
                      name, suggestNames(name, namesOf(materials_))));
      return;
    }
    shape.has_color = true;
    shape.color = found->second.color;
    shape.texture = found->second.texture;
  }
  if (stated && (!shape.has_color || *stated != kUnstatedColor)) {
    shape.has_color = true;
    shape.color = *stated;
  }
  shape.hides_looks = shape.has_color;
}

}  // namespace galactic::bake
