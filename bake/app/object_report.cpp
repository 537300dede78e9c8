#include "object_outcome.h"
#include "render_job.h"

namespace galactic::bake {
namespace {

Json toJson(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

/// Order of text: w, x, y, z.
Json toJson(const Quat& q) { return Json::array({q.w, q.x, q.y, q.z}); }

Json toJson(const LengthStatistics& lengths) {
  return {{"mean", lengths.mean}, {"p95", lengths.p95}, {"max", lengths.max}};
}

Json toJson(const BoxFitResult& fit) {
  return {{"centre", toJson(fit.box.pose.translation)},
          {"rotation_wxyz", toJson(fit.box.pose.rotation)},
          {"half_extents", toJson(fit.box.half_extents)},
          {"volume", fit.volume},
          {"axis_aligned_volume", fit.axis_aligned_volume},
          {"pca_volume", fit.pca_volume}};
}

}  // namespace

Json sphereSetReport(const SphereSet& set, std::size_t radii) {
  std::vector<std::size_t> counts(radii);
  for (const SetSphere& sphere : set.spheres) ++counts[sphere.radius_index];
  const SphereSetQuality& quality = set.quality;
  return {{"count", set.spheres.size()},
          {"count_per_radius", counts},
          {"gap", toJson(quality.gap)},
          {"protrusion", toJson(quality.protrusion)},
          {"volume_ratio", quality.volume_ratio},
          {"thin_points", quality.thin_points},
          {"samples", quality.samples},
          {"guaranteed_gap", set.guaranteed_gap},
          {"guaranteed_protrusion", set.guaranteed_protrusion},
          {"meets_tolerances", set.meets_tolerances}};
}

Json objectReport(const BakedObject& object, const ObjectOutcome& outcome,
                  const ObjectSetOutcome& set) {
  Json json{{"input", outcome.input.string()},
            {"output", set.output.string()},
            {"pack_bytes", set.pack_bytes},
            {"name", object.name},
            {"format", object.imported.format},
            {"triangles",
             {{"read", object.imported.counts.read},
              {"degenerate", object.imported.counts.degenerate},
              {"duplicate", object.imported.counts.duplicate},
              {"kept", object.imported.triangles}}},
            {"box", toJson(object.box)},
            {"authored_spheres", object.authored_spheres},
            {"spheres", sphereSetReport(object.spheres, set.radii.size())}};
  json["stable_poses"] = Json::array();
  for (const StablePose& pose : object.stable_poses) {
    json["stable_poses"].push_back({{"rotation_wxyz", toJson(pose.rotation)},
                                    {"height", pose.height},
                                    {"likelihood", pose.likelihood}});
  }
  json["seconds"] = {{"import", outcome.import_seconds},
                     {"box", object.times.box},
                     {"stable_poses", object.times.stable_poses},
                     {"spheres", object.times.spheres},
                     {"render", object.times.render}};
  if (object.render_meshes) json["render_meshes"] = renderReport(*object.render_meshes);
  json["warnings"] = object.warnings;
  return json;
}

}  // namespace galactic::bake
