#include <array>

#include "render_job.h"
#include "scene_outcome.h"

namespace galactic::bake {
namespace {

Json toJson(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json toJson(const Bounds& bounds) {
  return {{"min", toJson(bounds.min)}, {"max", toJson(bounds.max)}};
}

Json toJson(const CastCheck& check) {
  return {{"columns", check.columns},   {"columns_differing", check.columns_differing},
          {"compared", check.compared}, {"method", check.method},
          {"ties", check.ties},         {"errors", check.errors},
          {"longest", check.longest}};
}

Json toJson(const BakedGrid& baked) {
  constexpr std::array<const char*, kRegionCount> kRegionNames{"room", "outside", "enclosed"};
  const EncodedGrid& grid = baked.grid;
  Json json{{"radius", grid.frame.radius},
            {"spacing", grid.frame.spacing},
            {"columns", Json::array({grid.frame.columns_x, grid.frame.columns_z})},
            {"raw_spans", baked.raw_spans},
            {"spans", grid.spans},
            {"max_spans_per_column", grid.max_spans_per_column},
            {"overflow_columns", grid.overflow_columns},
            {"merged_gaps", baked.merged_gaps},
            {"slivers", grid.slivers}};
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    const RegionTotals& totals = baked.totals[region];
    json["regions"][kRegionNames[region]] = {
        {"components", totals.components}, {"spans", totals.spans}, {"volume", totals.volume}};
  }
  if (baked.cast_check) json["cast_check"] = toJson(*baked.cast_check);
  return json;
}

}  // namespace

Json sceneReport(const SceneOutcome& outcome) {
  const BakedScene& scene = outcome.scene;
  const StageTimes& times = outcome.times;
  Json json{{"input", outcome.input.string()},
            {"output", outcome.output.string()},
            {"pack_bytes", outcome.pack_bytes},
            {"format", scene.imported.format},
            {"convention", outcome.convention},
            {"bounds", toJson(scene.bounds)},
            {"triangles",
             {{"read", scene.imported.counts.read},
              {"degenerate", scene.imported.counts.degenerate},
              {"duplicate", scene.imported.counts.duplicate},
              {"kept", scene.imported.triangles}}},
            {"seconds",
             {{"import", times.import},
              {"clean", times.clean},
              {"columns", times.columns},
              {"regions", times.regions},
              {"encode", times.encode},
              {"check", times.check},
              {"render", times.render},
              {"write", times.write}}},
            {"warnings", scene.warnings}};
  if (scene.render_meshes) json["render_meshes"] = renderReport(*scene.render_meshes);
  json["grids"] = Json::array();
  for (const BakedGrid& grid : scene.grids) json["grids"].push_back(toJson(grid));
  return json;
}

}  // namespace galactic::bake
