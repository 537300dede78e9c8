#include "report.h"

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "galactic/atomic_file.h"

namespace galactic::bake {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json toJson(const Bounds& bounds) {
  return {{"min", toJson(bounds.min)}, {"max", toJson(bounds.max)}};
}

Json toJson(const CastCheck& check) {
  return {{"columns", check.columns},   {"columns_differing", check.columns_differing},
          {"compared", check.compared}, {"method", check.method},
          {"ties", check.ties},         {"errors", check.errors}};
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

Json toJson(const BakeOutcome& outcome) {
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
              {"write", times.write}}},
            {"warnings", scene.warnings}};
  json["grids"] = Json::array();
  for (const BakedGrid& grid : scene.grids) json["grids"].push_back(toJson(grid));
  return json;
}

}  // namespace

Result<void> writeReport(const std::filesystem::path& path,
                         const std::vector<BakeOutcome>& outcomes,
                         const std::vector<BakeFailure>& failures) {
  Json json{{"tool", "galactic-bake"}, {"version", GALACTIC_VERSION}};
  json["baked"] = Json::array();
  for (const BakeOutcome& outcome : outcomes) json["baked"].push_back(toJson(outcome));
  json["failed"] = Json::array();
  for (const BakeFailure& failure : failures) {
    json["failed"].push_back({{"input", failure.input.string()},
                              {"code", static_cast<int>(failure.error.code)},
                              {"where", failure.error.where},
                              {"message", failure.error.message}});
  }
  const std::string text =
      json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  return writeFileAtomically(path, {std::as_bytes(std::span(text))});
}

}  // namespace galactic::bake
