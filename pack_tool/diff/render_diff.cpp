#include "pack_tool/diff/render_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "layout/render_layout.h"
#include "view/render_surfaces.h"

namespace galactic::pack_tool {

namespace {

/// A model of one side and the pack's pools.
struct ModelSide {
  const RenderMeshes& meshes;
  const RenderModel& model;

  [[nodiscard]] std::string_view materialName(const RenderCluster& cluster) const {
    if (cluster.material >= meshes.materials.size()) return {};
    return meshes.materials[cluster.material].name;
  }
  [[nodiscard]] std::string_view semanticName(const RenderCluster& cluster) const {
    if (cluster.semantic >= meshes.semantics.size()) return {};
    return meshes.semantics[cluster.semantic];
  }
};

double difference(float a, float b) {
  return std::abs(static_cast<double>(a) - static_cast<double>(b));
}

double distance(const Vec3& a, const Vec3& b) {
  return std::hypot(difference(a.x, b.x), difference(a.y, b.y), difference(a.z, b.z));
}

/// Compares two models with equally many clusters, cluster by cluster.
class ModelComparison {
 public:
  ModelComparison(const ModelSide& a, const ModelSide& b, double tolerance)
      : a_(a), b_(b), tolerance_(tolerance) {
    const auto clusters_a = clustersOf(a.meshes, a.model);
    const auto clusters_b = clustersOf(b.meshes, b.model);
    clusters_ = std::min(clusters_a.size(), clusters_b.size());
    for (std::size_t n = 0; n < clusters_; ++n) compare(clusters_a[n], clusters_b[n]);
  }

  /// What differs, under the name of the model.
  void report(const std::string& name, std::vector<FieldDifference>& to) const {
    const std::string field = "render_meshes.models." + name;
    if (other_clusters_ > 0) {
      to.push_back({field + ".clusters", std::to_string(clusters_),
                    fmt::format("{}, {} with other triangles, materials or sides", clusters_,
                                other_clusters_)});
    }
    if (moved_ > 0) {
      to.push_back({field + ".places", std::to_string(vertices_),
                    fmt::format("{}, {} moved by up to {:.3g} m", vertices_, moved_, farthest_)});
    }
    if (other_uvs_ > 0) {
      to.push_back({field + ".texture_coordinates", std::to_string(vertices_),
                    fmt::format("{}, {} others", vertices_, other_uvs_)});
    }
    if (other_colors_ > 0) {
      to.push_back({field + ".colors", std::to_string(vertices_),
                    fmt::format("{}, {} others", vertices_, other_colors_)});
    }
  }

 private:
  void compare(const RenderCluster& a, const RenderCluster& b) {
    RenderSurface surface_a;
    RenderSurface surface_b;
    appendCluster(a_.meshes, a_.model, a, surface_a);
    appendCluster(b_.meshes, b_.model, b, surface_b);
    const bool same_kind = a.two_sided == b.two_sided && a_.materialName(a) == b_.materialName(b) &&
                           a_.semanticName(a) == b_.semanticName(b);
    if (!same_kind || surface_a.corners != surface_b.corners ||
        surface_a.vertices.size() != surface_b.vertices.size()) {
      ++other_clusters_;
      return;
    }
    vertices_ += surface_a.vertices.size();
    for (std::size_t n = 0; n < surface_a.vertices.size(); ++n) {
      compare(surface_a.vertices[n], surface_b.vertices[n]);
    }
  }

  void compare(const RenderVertex& a, const RenderVertex& b) {
    const double way = distance(a.position, b.position);
    if (way > tolerance_) ++moved_;
    farthest_ = std::max(farthest_, way);
    if (std::max(difference(a.u, b.u), difference(a.v, b.v)) > tolerance_) ++other_uvs_;
    if (a.color != b.color) ++other_colors_;
  }

  ModelSide a_;
  ModelSide b_;
  double tolerance_;
  std::size_t clusters_ = 0;
  std::size_t other_clusters_ = 0;
  /// Of the clusters that agree in their triangles.
  std::size_t vertices_ = 0;
  std::size_t moved_ = 0;
  std::size_t other_uvs_ = 0;
  std::size_t other_colors_ = 0;
  double farthest_ = 0;
};

using ModelsByName = std::map<std::string, const RenderModel*>;

ModelsByName modelsByName(const PackFile& pack, const RenderMeshes& meshes) {
  ModelsByName models;
  for (const RenderModel& model : meshes.models) models[partName(pack, model.part)] = &model;
  return models;
}

/// Takes what tells how the meshes were made out of their description.
Json takeMadeBy(Json& render) {
  Json taken = Json::object();
  const auto take = [](Json& from, Json& to) {
    for (const char* key : {"source_triangles", "largest_error"}) {
      to[key] = from.at(key);
      from.erase(key);
    }
  };
  take(render, taken);
  // Sums of what the lists tell.
  for (const char* key : {"clusters", "two_sided_clusters", "vertices", "triangles",
                          "geometry_bytes", "texture_bytes"}) {
    render.erase(key);
  }
  taken["models"] = Json::array();
  for (Json& model : render.at("models")) {
    Json part{{"name", model.at("name")}};
    take(model, part);
    taken["models"].push_back(std::move(part));
  }
  return taken;
}

Json under(const char* name, Json json) {
  Json outer = Json::object();
  outer[name] = std::move(json);
  return outer;
}

void compareGeometry(const PackPair& packs, double tolerance,
                     std::vector<FieldDifference>& differences) {
  const auto meshes_a = renderMeshesOf(packs.a);
  const auto meshes_b = renderMeshesOf(packs.b);
  if (!meshes_a || !*meshes_a || !meshes_b || !*meshes_b) return;
  const ModelsByName models_b = modelsByName(packs.b, **meshes_b);
  for (const auto& [name, model_a] : modelsByName(packs.a, **meshes_a)) {
    const auto found = models_b.find(name);
    // Other numbers of clusters are told with the descriptions.
    if (found == models_b.end() || model_a->cluster_count != found->second->cluster_count) continue;
    ModelComparison({**meshes_a, *model_a}, {**meshes_b, *found->second}, tolerance)
        .report(name, differences);
  }
}

}  // namespace

void compareRenderMeshes(const PackPair& packs, const DescribedPair& descriptions,
                         const DiffOptions& options, PackDifference& difference) {
  constexpr const char* kField = "render_meshes";
  Json a = descriptions.a.at(kField);
  Json b = descriptions.b.at(kField);
  if (a.is_null() && b.is_null()) return;
  if (a.is_null() || b.is_null()) {
    difference.content.push_back(
        {kField, a.is_null() ? "none" : "present", b.is_null() ? "none" : "present"});
    return;
  }
  Json made_a = under(kField, takeMadeBy(a));
  Json made_b = under(kField, takeMadeBy(b));
  if (options.scope == DiffScope::kEverything) {
    append(difference.provenance, compareFields(made_a, made_b, 0));
  }
  append(difference.content, compareFields(under(kField, std::move(a)), under(kField, std::move(b)),
                                           options.tolerance));
  compareGeometry(packs, options.tolerance, difference.content);
}

}  // namespace galactic::pack_tool
