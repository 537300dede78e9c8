#include "render_job.h"

#include <fmt/format.h>

#include "galactic/bake/render_source.h"
#include "galactic/bake/texture_pack.h"

namespace galactic::bake {
namespace {

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

TextureBakeOptions texturesOf(const RenderTask& task) {
  TextureBakeOptions options = task.command.render.textures;
  options.jobs = task.jobs;
  return options;
}

Result<OptionalMeshes> bakeFrom(Result<RenderSource> source, const RenderTask& task,
                                std::vector<std::string>& warnings) {
  const auto located = [&](Error error) {
    error.where = inFile(task.input, error.where);
    return tl::unexpected(std::move(error));
  };
  if (!source) return located(source.error());
  RenderBakeOptions options = task.command.render.meshes;
  options.jobs = task.jobs;
  auto meshes = bakeRenderMeshes(*source, options);
  if (!meshes) return located(meshes.error());
  const std::vector<std::string>& more = meshes->materials.warnings;
  warnings.insert(warnings.end(), more.begin(), more.end());
  return OptionalMeshes(std::move(*meshes));
}

/// The packs that the asset's textures are in.
std::vector<std::string> sharedTextures(const BakedMaterials& materials) {
  std::vector<std::string> hashes;
  if (!materials.shared) return hashes;
  hashes.reserve(materials.textures.size());
  for (const BakedTexture& texture : materials.textures) hashes.push_back(textureHash(texture));
  return hashes;
}

}  // namespace

Result<OptionalMeshes> renderScene(const SourceAsset& scene, const RenderTask& task,
                                   std::vector<std::string>& warnings) {
  if (!task.command.render.wanted) return std::nullopt;
  return bakeFrom(sceneRenderSource(scene, task.input.parent_path(), texturesOf(task)), task,
                  warnings);
}

Result<OptionalMeshes> renderObject(const SourceAsset& object, const RenderTask& task,
                                    std::vector<std::string>& warnings) {
  if (!task.command.render.wanted) return std::nullopt;
  return bakeFrom(objectRenderSource(object, task.input.parent_path(), texturesOf(task)), task,
                  warnings);
}

Result<OptionalMeshes> renderRobot(const SourceRobot& robot, const RenderTask& task,
                                   BakedRobot& baked) {
  if (!task.command.render.wanted) return std::nullopt;
  auto source = robotRenderSource(robot, task.input.parent_path(), texturesOf(task));
  if (source) standInStartPose(*source, baked.kinematics);
  return bakeFrom(std::move(source), task, baked.warnings);
}

void printRenderMeshes(const RenderBakeStatistics& figures, std::size_t textures) {
  fmt::print(
      "  render meshes: {} -> {} triangles ({} two-sided), {} -> {} vertices, {} clusters, "
      "error {:.2f} mm; {:.2f} -> {:.2f} MB\n",
      figures.source_triangles, figures.triangles, figures.two_sided_triangles,
      figures.source_vertices, figures.vertices, figures.clusters,
      1e3 * static_cast<double>(figures.largest_error), megabytes(figures.source_bytes),
      megabytes(figures.bytes));
  fmt::print("  {} texture{}: {:.2f} -> {:.2f} MB\n", textures, textures == 1 ? "" : "s",
             megabytes(figures.source_texture_bytes), megabytes(figures.texture_bytes));
}

void printRenderMeshes(const OptionalMeshes& meshes) {
  if (meshes) printRenderMeshes(meshes->statistics(), meshes->materials.textures.size());
}

Json renderReport(const BakedRenderMeshes& meshes) {
  const RenderBakeStatistics figures = meshes.statistics();
  Json json{{"source_triangles", figures.source_triangles},
            {"triangles", figures.triangles},
            {"two_sided_triangles", figures.two_sided_triangles},
            {"source_vertices", figures.source_vertices},
            {"vertices", figures.vertices},
            {"clusters", figures.clusters},
            {"source_bytes", figures.source_bytes},
            {"bytes", figures.bytes},
            {"largest_error", figures.largest_error},
            {"textures", meshes.materials.textures.size()},
            {"source_texture_bytes", figures.source_texture_bytes},
            {"texture_bytes", figures.texture_bytes}};
  if (meshes.materials.shared) json["shared_textures"] = sharedTextures(meshes.materials);
  json["models"] = Json::array();
  for (const RenderModel& model : meshes.models) {
    json["models"].push_back({{"part", model.part},
                              {"step", model.step},
                              {"source_triangles", model.source_triangles},
                              {"triangles", model.triangles},
                              {"clusters", model.cluster_count},
                              {"largest_error", model.largest_error}});
  }
  return json;
}

}  // namespace galactic::bake
