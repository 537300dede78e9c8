#pragma once
#include <array>

#include "galactic/bake/figures.h"
#include "support/option_table.h"

namespace galactic::bake {

// The members of the JSON objects that describe what was baked. Each is named once, for writers
// (reports, the cache) and readers (the cache). The functions of a visitor:
//   field(name, value)            takes the value; an empty optional is left out.
//   nonzero(name, value)          is left out if the value is 0.
//   detail(name, value)           is not in reports, nor is detailChoice().
//   when(condition, name, value)  is not in reports if the condition is false.
//   message(name, sentences)      takes sentences for people, with options in backquotes.
//   choice(name, value, names)    takes one of the names.
//   object(name, list)            takes an object whose members `list` visits.

inline constexpr std::array<Named<Region>, kRegionCount> kRegionNames{
    {{"room", Region::kRoom}, {"outside", Region::kOutside}, {"enclosed", Region::kEnclosed}}};
inline constexpr std::array<Named<PairKind>, 5> kPairNames{{{"tested", PairKind::kTested},
                                                            {"adjacent", PairKind::kAdjacent},
                                                            {"always", PairKind::kAlways},
                                                            {"never", PairKind::kNever},
                                                            {"ignored", PairKind::kIgnored}}};
inline constexpr std::array<Named<BoxFit>, 3> kBoxFitNames{
    {{"yaw", BoxFit::kYaw}, {"min", BoxFit::kMinimum}, {"aabb", BoxFit::kAxisAligned}}};

template <class V>
void listFields(V& v, Bounds& bounds) {
  v.field("min", bounds.min);
  v.field("max", bounds.max);
}

template <class V>
void listFields(V& v, LengthStatistics& lengths) {
  v.field("mean", lengths.mean);
  v.field("p95", lengths.p95);
  v.field("max", lengths.max);
}

/// Members of scenes and objects, not a JSON object of their own.
template <class V>
void listImport(V& v, ImportStatistics& imported) {
  v.field("format", imported.format);
  v.detail("source_meshes", imported.meshes);
  v.detail("source_instances", imported.instances);
  v.object("triangles", [&](V& inner) {
    inner.field("read", imported.counts.read);
    inner.field("degenerate", imported.counts.degenerate);
    inner.field("duplicate", imported.counts.duplicate);
    inner.field("kept", imported.triangles);
  });
}

template <class V>
void listFields(V& v, RenderFigures::Model& model) {
  v.field("part", model.part);
  v.field("step", model.step);
  v.field("source_triangles", model.source_triangles);
  v.field("triangles", model.triangles);
  v.field("clusters", model.clusters);
  v.field("largest_error", model.largest_error);
}

template <class V>
void listFields(V& v, RenderFigures& figures) {
  RenderBakeStatistics& all = figures.all;
  v.field("source_triangles", all.source_triangles);
  v.field("triangles", all.triangles);
  v.field("two_sided_triangles", all.two_sided_triangles);
  v.field("source_vertices", all.source_vertices);
  v.field("vertices", all.vertices);
  v.field("clusters", all.clusters);
  v.field("source_bytes", all.source_bytes);
  v.field("bytes", all.bytes);
  v.field("largest_error", all.largest_error);
  v.field("textures", figures.textures);
  v.field("source_texture_bytes", all.source_texture_bytes);
  v.field("texture_bytes", all.texture_bytes);
  v.field("shared_textures", figures.shared_textures);
  v.field("models", figures.models);
}

template <class V>
void listFields(V& v, RegionTotals& totals) {
  v.field("components", totals.components);
  v.field("spans", totals.spans);
  v.field("volume", totals.volume);
}

template <class V>
void listFields(V& v, CastCheck& check) {
  v.field("columns", check.columns);
  v.field("columns_differing", check.columns_differing);
  v.field("compared", check.compared);
  v.field("method", check.method);
  v.field("ties", check.ties);
  v.field("errors", check.errors);
  v.field("longest", check.longest);
  v.field("longest_tie", check.longest_tie);
}

template <class V>
void listFields(V& v, GridFigures::Part& part) {
  v.choice("region", part.region, kRegionNames);
  v.field("volume", part.volume);
  v.field("bounds", part.bounds);
}

template <class V>
void listFields(V& v, GridFigures& grid) {
  v.field("radius", grid.radius);
  v.field("spacing", grid.spacing);
  v.field("columns", grid.columns);
  v.field("raw_spans", grid.raw_spans);
  v.field("spans", grid.spans);
  v.field("max_spans_per_column", grid.max_spans_per_column);
  v.field("overflow_columns", grid.overflow_columns);
  v.field("merged_gaps", grid.merged_gaps);
  v.field("slivers", grid.slivers);
  v.detail("stored_bytes", grid.stored_bytes);
  v.object("regions", [&](V& inner) {
    for (const Named<Region>& region : kRegionNames) {
      inner.field(region.name, grid.regions[static_cast<std::size_t>(region.value)]);
    }
  });
  v.field("cast_check", grid.cast_check);
  v.detail("parts", grid.parts);
  v.detail("largest_parts", grid.largest_parts);
}

template <class V>
void listFields(V& v, StageTimes& times) {
  v.field("import", times.import);
  v.field("clean", times.clean);
  v.field("columns", times.columns);
  v.field("regions", times.regions);
  v.field("encode", times.encode);
  v.field("check", times.check);
  v.field("render", times.render);
  v.field("write", times.write);
}

template <class V>
void listFields(V& v, SceneFigures& scene) {
  v.field("input", scene.input);
  listImport(v, scene.imported);
  v.message("convention", scene.convention);
  v.field("bounds", scene.bounds);
  v.field("seconds", scene.seconds);
  v.message("warnings", scene.warnings);
  v.field("render_meshes", scene.render_meshes);
  v.field("grids", scene.grids);
}

template <class V>
void listFields(V& v, BoxFitResult& fit) {
  v.field("center", fit.box.pose.translation);
  v.field("rotation_wxyz", fit.box.pose.rotation);
  v.field("half_extents", fit.box.half_extents);
  v.field("volume", fit.volume);
  v.field("axis_aligned_volume", fit.axis_aligned_volume);
  v.field("pca_volume", fit.pca_volume);
}

template <class V>
void listFields(V& v, SphereFigures& spheres) {
  v.field("count", spheres.count);
  v.field("count_per_radius", spheres.count_per_radius);
  v.field("gap", spheres.quality.gap);
  v.field("protrusion", spheres.quality.protrusion);
  v.field("volume_ratio", spheres.quality.volume_ratio);
  v.field("thin_points", spheres.quality.thin_points);
  v.field("samples", spheres.quality.samples);
  v.field("guaranteed_gap", spheres.guaranteed_gap);
  v.field("guaranteed_protrusion", spheres.guaranteed_protrusion);
  v.field("meets_tolerances", spheres.meets_tolerances);
}

template <class V>
void listFields(V& v, StablePose& pose) {
  v.field("rotation_wxyz", pose.rotation);
  v.field("height", pose.height);
  v.field("likelihood", pose.likelihood);
}

template <class V>
void listFields(V& v, ObjectFigures::Times& times) {
  v.field("import", times.import);
  v.field("box", times.bake.box);
  v.field("stable_poses", times.bake.stable_poses);
  v.field("spheres", times.bake.spheres);
  v.field("render", times.bake.render);
}

template <class V>
void listFields(V& v, ObjectFigures& object) {
  v.field("input", object.input);
  v.field("name", object.name);
  listImport(v, object.imported);
  v.detailChoice("fit", object.box.used, kBoxFitNames);
  v.field("box", object.box);
  v.field("authored_spheres", object.authored_spheres);
  v.field("spheres", object.spheres);
  v.field("stable_poses", object.stable_poses);
  v.field("seconds", object.seconds);
  v.field("render_meshes", object.render_meshes);
  v.message("warnings", object.warnings);
}

/// In the cache only: a report has an entry for each object.
template <class V>
void listFields(V& v, ObjectSetFigures& set) {
  v.field("radii", set.radii);
  v.field("objects", set.objects);
  v.message("warnings", set.warnings);
  v.field("seconds", set.seconds);
}

template <class V>
void listFields(V& v, RobotFigures::Group& group) {
  v.field("link", group.link);
  v.field("links", group.links);
  v.field("by_hand", group.by_hand);
  v.field("eps", group.eps);
  v.field("tau", group.tau);
  v.field("count", group.spheres.count);
  v.detail("is_measured", group.is_measured);
  v.when(group.is_measured, "spheres", group.spheres);
}

template <class V>
void listFields(V& v, RobotFigures::Pair& pair) {
  v.field("first", pair.first);
  v.field("second", pair.second);
  v.choice("kind", pair.kind, kPairNames);
}

template <class V>
void listFields(V& v, RobotFigures::Times& times) {
  v.field("import", times.import);
  v.field("spheres", times.bake.spheres);
  v.field("self_collision", times.bake.self_collision);
  v.field("render", times.bake.render);
  v.field("write", times.write);
  v.field("all", times.all);
}

template <class V>
void listFields(V& v, RobotFigures& robot) {
  v.field("input", robot.input);
  v.field("name", robot.name);
  v.field("links", robot.links);
  v.field("joint_positions", robot.joint_positions);
  v.field("controlled_joints", robot.controlled_joints);
  v.field("groups", robot.groups);
  v.field("pairs", robot.pairs);
  v.message("meshes", robot.meshes);
  v.field("seconds", robot.seconds);
  v.field("render_meshes", robot.render_meshes);
  v.message("warnings", robot.warnings);
}

template <class V>
void listFields(V& v, EpisodeFigures::Distances& distances) {
  v.field("min", distances.min);
  v.field("mean", distances.mean);
  v.field("max", distances.max);
}

template <class V>
void listFields(V& v, GeneratedScene& scene) {
  v.field("name", scene.name);
  v.field("episodes", scene.episodes);
  v.field("floor_places", scene.floor_places);
  v.field("floor_parts", scene.floor_parts);
  v.field("support_places", scene.support_places);
  v.field("surfaces", scene.surfaces);
  v.field("receptacles", scene.receptacles);
  v.field("settled", scene.has_mesh);
  v.nonzero("skipped", scene.skipped);
  v.field("shortened_way", scene.shortened_way);
}

template <class V>
void listFields(V& v, UnusableScene& scene) {
  v.field("scene", scene.name);
  v.field("reason", scene.reason);
}

template <class V>
void listFields(V& v, RejectionCounts& counts) {
  for (std::size_t n = 0; n < kRejectionCount; ++n) {
    const auto reason = static_cast<EpisodeRejection>(n);
    v.field(rejectionName(reason), counts[reason]);
  }
}

template <class V>
void listFields(V& v, SolvedSample& sample) {
  v.field("episodes", sample.episodes);
  v.field("solved", sample.solved);
  v.field("unsolved", sample.unsolved);
}

template <class V>
void listFields(V& v, EpisodeGeneration& generation) {
  v.field("rejections", generation.rejections);
  v.field("scenes", generation.scenes);
  v.field("left_out", generation.left_out);
  v.nonzero("skipped", generation.skipped);
  v.nonzero("with_fewer_objects", generation.with_fewer_objects);
  v.when(generation.sample.episodes > 0, "scripted_policy", generation.sample);
}

template <class V>
void listFields(V& v, WorldFigures& world) {
  v.field("packs", world.packs);
  v.field("seconds", world.seconds);
}

template <class V>
void listFields(V& v, EpisodeFigures& set) {
  v.field("input", set.input);
  v.field("name", set.name);
  v.field("robot", set.robot);
  v.field("episodes", set.episodes);
  v.field("placements", set.placements);
  v.field("most_placements", set.most_placements);
  v.field("scenes", set.scenes);
  v.field("objects", set.objects);
  v.field("start_joints", set.start_joints);
  v.field("target_to_goal", set.target_to_goal);
  v.field("seconds", set.seconds);
  v.message("warnings", set.warnings);
  v.field("generation", set.generation);
}

}  // namespace galactic::bake
