#include <array>
#include <limits>

#include "galactic/bake/jobs.h"

namespace galactic::bake {
namespace {

constexpr OptionRange kMetersAboveZero{.least = 0, .most = 1e4, .above = true};
constexpr OptionRange kMeters{.least = 0, .most = 1e4};
constexpr OptionRange kShare{.least = 0, .most = 1};
constexpr std::uint64_t kMostSeed = std::numeric_limits<std::uint64_t>::max();

constexpr std::array<Named<UpAxis>, 6> kAxisNames{{{"x", UpAxis::kX},
                                                   {"y", UpAxis::kY},
                                                   {"z", UpAxis::kZ},
                                                   {"-x", UpAxis::kMinusX},
                                                   {"-y", UpAxis::kMinusY},
                                                   {"-z", UpAxis::kMinusZ}}};
constexpr std::array<Named<Engine>, 3> kEngineNames{
    {{"exact", Engine::kExact}, {"bullet", Engine::kBullet}, {"embree", Engine::kEmbree}}};
constexpr std::array<Named<Coverage>, 2> kCoverageNames{
    {{"column", Coverage::kColumn}, {"cell", Coverage::kCell}}};
constexpr std::array<Named<Keep>, 2> kKeepNames{{{"room", Keep::kRoom}, {"all", Keep::kAll}}};
constexpr std::array<Named<BoxFit>, 3> kBoxNames{
    {{"yaw", BoxFit::kYaw}, {"min", BoxFit::kMinimum}, {"aabb", BoxFit::kAxisAligned}}};
constexpr std::array<Named<TexelFormat>, 2> kTexelNames{
    {{"rgba8", TexelFormat::kRgba8}, {"bc1", TexelFormat::kBc1}}};
constexpr std::array<Named<Lighting>, 3> kLightingNames{
    {{"auto", Lighting::kAuto}, {"all", Lighting::kAll}, {"none", Lighting::kNone}}};
constexpr std::array<Named<HabitatTargets>, 2> kTargetNames{
    {{"first", HabitatTargets::kFirst}, {"each", HabitatTargets::kEach}}};
constexpr std::array<Named<PoseChoice>, 2> kPoseNames{
    {{"dropped", PoseChoice::kDropped}, {"upright", PoseChoice::kUpright}}};
constexpr std::array<Named<SupportChoice>, 3> kSupportNames{
    {{"found", SupportChoice::kFound},
     {"receptacles", SupportChoice::kReceptacles},
     {"both", SupportChoice::kBoth}}};
constexpr std::array<Named<SplitSide>, 2> kSplitNames{
    {{"train", SplitSide::kTrain}, {"validation", SplitSide::kValidation}}};

constexpr OptionInfo kSeedInfo{
    "seed", "N",
    "Generate, and import of Habitat's in packs: the number from which the random ones are drawn; "
    "also instead of a recipe's"};

/// Named tolerances of sphere sets, meters.
struct Tolerances {
  float eps = 0;
  float tau = 0;
};
constexpr std::array<Named<Tolerances>, 4> kProfiles{{{"object", {0.015F, 0.020F}},
                                                      {"robot", {0.020F, 0.040F}},
                                                      {"tight", {0.010F, 0.020F}},
                                                      {"coarse", {0.020F, 0.030F}}}};

void visitRadii(std::vector<float>& radii, OptionVisitor& v) {
  v.group("Spheres (scenes, objects, robots)");
  v.option({"radii", "R,R,...", "Sphere radii, meters, ascending"},
           numbers(radii, kMetersAboveZero));
}

void visitReach(bool& allow_outside, OptionVisitor& v) {
  v.group("Files (scenes, objects, robots)");
  v.option({"allow-outside", "",
            "Read what meshes, robots and datasets name wherever it points, not only below their "
            "folders and in packages"},
           flag(allow_outside));
}

void visitGrids(SceneBakeOptions& options, OptionVisitor& v) {
  auto& [radii, spacing, engine, coverage, free_space, check_columns] = options;
  auto& [keep, seeds, components] = free_space;
  v.group("Scenes");
  v.option({"spacing", "METERS", "Edge of a cell, meters; at most twice the least radius"},
           number(spacing, kMetersAboveZero));
  v.option({"engine", "exact|bullet|embree",
            "exact: closed form; bullet: the published sphere casts; embree: rays"},
           choice(engine, kEngineNames));
  v.option({"coverage", "column|cell",
            "column: free on the cell's center line; cell: free over the whole cell"},
           choice(coverage, kCoverageNames));
  v.option({"keep", "room|all", "What to store: the room, or all free spans"},
           choice(keep, kKeepNames));
  v.option(
      {"keep-components", "N", "Without `inside`: how many of the largest free parts are the room"},
      whole(components, {1, 1'000'000}));
  v.option({"inside", "X,Y,Z", "A point of the room, meters, y up (may be repeated)"},
           points(seeds));
  v.option({"check-columns", "N", "Columns per grid to replay with sphere casts; 0: none"},
           whole(check_columns, {0, 1'000'000}));
  v.internals(radii);
}

void visitImport(MeshImportOptions& options, OptionVisitor& v) {
  auto& [up, scale, affine, smallest_size, allow_outside, time_limit, memory_limit] = options;
  v.group("Meshes (scenes, objects)");
  v.option({"up", "AXIS", "Up axis of the input: x, y, z, -x, -y, -z (default: the file's)"},
           choice(up, kAxisNames));
  v.option({"scale", "METERS", "Meters per unit of the input (default: the file's)"},
           number(scale, {.least = 0, .most = 1e9, .above = true}));
  v.option({"transform", "N,N,...", "Applied last, Y up and meters: 12 or 16 numbers, row by row"},
           transform(affine));
  v.internals(smallest_size, allow_outside, time_limit, memory_limit);
}

void visitDrawing(DrawOptions& options, OptionVisitor& v) {
  auto& [wanted, meshes, textures, shared_textures] = options;
  auto& [error, lighting] = meshes;
  auto& [largest, format] = textures;
  v.group("Render meshes (scenes, objects, robots)");
  v.option({"no-render-meshes", "", "Leave out what is drawn: a pack for physics alone"},
           flag(wanted, false));
  v.option({"render-error", "METERS",
            "How far simplification may move a surface (default: 0.005 of scenes, else 0.002)"},
           number(error, kMeters));
  v.option({"texture-size", "N", "Longest edge of a texture, texels: a power of two up to 4096"},
           powerOfTwo(largest, {1, 4096}));
  v.option({"texture-format", "rgba8|bc1",
            "bc1: an eighth of the size, for graphics processors; opaque textures only"},
           choice(format, kTexelNames));
  v.option({"lighting", "auto|all|none",
            "What is shaded by its place and direction: all, what has no light of its own (auto), "
            "or nothing (none)"},
           choice(lighting, kLightingNames));
  v.internals(shared_textures);
}

/// The sphere fields that the option structs of objects and robots share.
template <class Length, class Count>
struct SphereFields {
  Length& eps;
  Length& tau;
  Count& max_spheres;
};

template <class Length, class Count>
void visitSpheres(SphereFields<Length, Count> fields, OptionVisitor& v) {
  v.group("Spheres and boxes (objects, robots)");
  std::vector<std::string_view> names;
  names.reserve(std::size(kProfiles));
  for (const Named<Tolerances>& one : kProfiles) names.push_back(one.name);
  v.option({"profile", "object|robot|tight|coarse",
            "Tolerances of the spheres by name (default: by the kind)"},
           preset(std::move(names), [fields](std::size_t n) {
             fields.eps = kProfiles[n].value.eps;
             fields.tau = kProfiles[n].value.tau;
           }));
  v.option({"eps", "METERS",
            "Every reachable surface point lies this near to a sphere, meters (default: 0.015 of "
            "objects, 0.02 of robots)"},
           number(fields.eps, kMetersAboveZero));
  v.option({"tau", "METERS",
            "No sphere sticks out further, but for thin parts, meters (default: 0.02 of objects, "
            "0.04 of robots)"},
           number(fields.tau, kMetersAboveZero));
  v.option({"max-spheres", "N",
            "Most spheres of an object or robot; 0: as many as the tolerances need (default: 0 of "
            "objects, 100 of robots, more where gaps would be wide)"},
           whole(fields.max_spheres, {0, 1'000'000}));
}

void visitShape(ObjectBakeOptions& options, OptionVisitor& v) {
  auto& [box, spheres, keep_above_support, authored] = options;
  auto& [radii, eps, tau, support, max_spheres] = spheres;
  v.group("Objects");
  v.option({"obb", "yaw|min|aabb",
            "Box of an object: yaw keeps it upright, min has the least volume, aabb is "
            "axis-aligned"},
           choice(box, kBoxNames));
  v.option({"no-support", "", "Let an object's spheres reach below the face on which it rests"},
           flag(keep_above_support, false));
  visitSpheres(SphereFields<float, std::uint32_t>{eps, tau, max_spheres}, v);
  v.internals(radii, support, authored);
}

void visitShape(RobotBakeOptions& options, OptionVisitor& v) {
  auto& [radii, eps, tau, max_spheres, hand_spheres] = options;
  using Fields = SphereFields<std::optional<float>, std::optional<std::uint32_t>>;
  visitSpheres(Fields{eps, tau, max_spheres}, v);
  v.internals(radii, hand_spheres);
}

void visitImport(EpisodeImportOptions& options, OptionVisitor& v) {
  auto& [object_up, object_centers, centers_needed, targets, start_joints, scene_names, only] =
      options;
  v.option({"scene-name", "OLD=NEW",
            "Import: the name of a scene's pack for that of the file (may be repeated)"},
           namedTexts(scene_names, "OLD=NEW"));
  v.option({"start-joints", "NAME,NAME,...",
            "Import: the joints of robotStartJointPositions (default: Fetch's arm)"},
           names(start_joints));
  v.option({"object-up", "AXIS",
            "Import: up axis of the objects' frames in the file (default: z; Habitat's: y)"},
           choice(object_up, kAxisNames));
  v.option({"targets", "first|each",
            "Import of Habitat's: the first target of an episode, or each as an episode"},
           choice(targets, kTargetNames));
  v.internals(object_centers, centers_needed, only);
}

void visitSplit(SceneSplit& split, OptionVisitor& v) {
  auto& [side, held_out, seed] = split;
  v.option({"split", "train|validation", "Generate: use one part of the scenes"},
           choice(side, kSplitNames));
  v.option({"held-out", "SHARE", "Generate: share of the scenes that is for validation"},
           number(held_out, kShare));
  v.option({"split-seed", "N", "Generate: the number that decides which scenes are held out"},
           whole(seed, {0, kMostSeed}));
}

void visitGeneration(EpisodeGeneratorOptions& options, OptionVisitor& v) {
  auto& [episodes, objects, seed, heights, flatness, target_to_goal, shorten_way, start_to_target,
         goal_on_other_support, most_skipped, supports, poses, split] = options;
  v.group("Episodes");
  v.option(kSeedInfo, whole(seed, {0, kMostSeed}));
  v.option({"count", "N", "Generate: how many episodes; also instead of a recipe's"},
           whole(episodes, {1, 1'000'000}));
  v.option({"objects", "N|LEAST,MOST", "Generate: objects of each episode, the target among them"},
           counts(objects, {1, 1024}));
  v.option({"heights", "LOW,HIGH", "Generate: objects stand this high above the floor, meters"},
           bounds(heights));
  v.option({"flatness", "METERS",
            "Generate: how far the surface under an object may be from flat, meters; scans need "
            "about 0.01"},
           number(flatness, {.least = 1e-6, .most = static_cast<double>(kMostFlatness)}));
  v.option({"goal-distance", "LEAST[,MOST]",
            "Generate: from target to goal, meters (default 1, less in small scenes)"},
           distances(target_to_goal, shorten_way));
  v.option({"start-distance", "LEAST[,MOST]",
            "Generate: from the robot to the target on the ground, meters"},
           distances(start_to_target));
  v.option({"most-skipped", "SHARE",
            "Generate: share of the episodes that may find no place; they are skipped"},
           number(most_skipped, kShare));
  v.option({"goal-elsewhere", "", "Generate: goals lie on another surface than their targets"},
           flag(goal_on_other_support));
  v.option({"supports", "found|receptacles|both",
            "Generate: objects stand on all surfaces that are found, in the dataset's "
            "receptacles, or half of them in these where a scene has any"},
           choice(supports, kSupportNames));
  v.option({"poses", "dropped|upright",
            "Generate: objects stand as drops end, so that bottles mostly lie, or upright"},
           choice(poses, kPoseNames));
  visitSplit(split, v);
  v.internals(shorten_way);
}

}  // namespace

void visitOptions(SceneJob& job, OptionVisitor& v) {
  auto& [input, instance, name, import, grids, draw] = job;
  visitRadii(grids.radii, v);
  visitReach(import.allow_outside, v);
  visitGrids(grids, v);
  visitImport(import, v);
  visitDrawing(draw, v);
  v.internals(input, instance, name);
}

void visitOptions(ObjectJob& job, OptionVisitor& v) {
  auto& [inputs, name, collection, import, shape, draw] = job;
  visitRadii(shape.spheres.radii, v);
  visitReach(import.allow_outside, v);
  visitShape(shape, v);
  v.group("Objects");
  v.option({"collection", "FILE",
            "Published *.collection.json: the objects in it get its boxes and spheres"},
           path(collection));
  visitImport(import, v);
  visitDrawing(draw, v);
  v.internals(inputs, name);
}

void visitOptions(RobotJob& job, OptionVisitor& v) {
  auto& [input, packages, recipe, spheres, allow_missing, allow_outside, shape, draw] = job;
  visitRadii(shape.radii, v);
  visitReach(allow_outside, v);
  visitShape(shape, v);
  v.group("Robots");
  v.option(
      {"recipe", "FILE", "Robot recipe (TOML, see `print-recipe`) or published *.collection.json"},
      path(recipe));
  v.option(
      {"spheres", "FILE",
       "Hand-made spheres: a spherized URDF or MJCF, or an SRDF; they replace the fitted ones"},
      path(spheres));
  v.option({"package", "NAME=DIR", "Folder of a ROS package (may be repeated)"},
           namedPaths(packages, "NAME=DIR"));
  v.option({"allow-missing", "", "Links that lost all their geometry are warnings, not errors"},
           flag(allow_missing));
  visitDrawing(draw, v);
  v.internals(input);
}

void visitOptions(EpisodeImportJob& job, OptionVisitor& v) {
  auto& [input, packs, only, object_packs, import, seed] = job;
  v.group("Episodes");
  v.option({"only", "FILE", "Import: keep the episodes whose indices stand in this text file"},
           path(only));
  visitImport(import, v);
  v.option({"object-pack", "PACK",
            "Import of Habitat's: a pack of objects, which says where their centers are, or a "
            "world's (may be repeated)"},
           paths(object_packs));
  v.option(kSeedInfo, whole(seed, {0, kMostSeed}));
  v.internals(input, packs);
}

void visitOptions(EpisodeGenerationJob& job, OptionVisitor& v) {
  auto& [packs, generate, solve, geometry, scenes] = job;
  visitGeneration(generate, v);
  v.option({"geometry", "SCENE=FILE",
            "Generate: the mesh a scene was baked from, to settle objects on (may be repeated)"},
           namedPaths(geometry, "SCENE=FILE"));
  v.option({"solve", "N",
            "Generate: of how many episodes to say whether the scripted policy solves them; 0: "
            "none"},
           whole(solve, {0, 1'000'000}));
  v.internals(packs, scenes);
}

void visitOptions(WorldJob& job, OptionVisitor& v) {
  auto& [packs, task] = job;
  v.internals(packs, task);
}

void visitOptions(Job& job, OptionVisitor& visitor) {
  std::visit([&](auto& one) { visitOptions(one, visitor); }, job);
}

}  // namespace galactic::bake
