#include "inspect/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "galactic/schema/pack_generated.h"
#include "support/counted.h"

namespace galactic {
namespace {

constexpr double kMega = 1e6;
constexpr double kGiga = 1e9;
constexpr double kMilli = 1e-3;

std::string clean(const flatbuffers::String* text) {
  return printable(std::string_view(text->c_str(), text->size()));
}

/// Bytes of everything that a query on the grid may read.
std::size_t gridBytes(const schema::ColumnGrid& grid) {
  return std::size_t{grid.cells()->size()} * sizeof(std::uint64_t) +
         std::size_t{grid.tile_base()->size()} * sizeof(std::uint16_t) +
         std::size_t{grid.overflow_codes()->size()} * sizeof(std::uint32_t) +
         std::size_t{grid.overflow_spans()->size()} * sizeof(schema::Span);
}

double volume(const schema::GridStatistics& statistics, schema::Region region) {
  double sum = 0;
  if (statistics.regions() == nullptr) return sum;
  for (const schema::RegionStatistics* one : *statistics.regions()) {
    if (one->region() == region) sum += one->volume();
  }
  return sum;
}

std::string castCheck(const schema::CastCheck* check) {
  if (check == nullptr) return "off";
  if (check->errors() > 0) return fmt::format("{:.1f} mm WRONG", check->errors() * 1e3);
  return fmt::format("{} columns checked, none wrong", check->columns());
}

std::string gridLine(const schema::ColumnGrid& grid) {
  const schema::GridStatistics& statistics = *grid.statistics();
  return fmt::format(
      "  {:>8g}{:>13}{:>11}{:>9}{:>9.2f}{:>11.2f}{:>11.2f}{:>11.2f}  {}\n", grid.radius(),
      fmt::format("{} x {}", grid.columns_x(), grid.columns_z()), statistics.spans(),
      statistics.max_spans_per_column(), static_cast<double>(gridBytes(grid)) / kMega,
      volume(statistics, schema::Region::Room), volume(statistics, schema::Region::Outside),
      volume(statistics, schema::Region::Enclosed), castCheck(statistics.cast_check()));
}

std::string openingLine(const PackFile& pack, const OpenTimes& times) {
  const auto bytes = static_cast<double>(pack.bytes().size());
  const std::string verified =
      times.verify > 0 ? fmt::format("verified in {:.2f} ms ({:.1f} GB/s)", times.verify / kMilli,
                                     bytes / times.verify / kGiga)
                       : std::string("trusted, not verified");
  return fmt::format("  {:.2f} MB, mapped in {:.3f} ms, {}\n", bytes / kMega, times.map / kMilli,
                     verified);
}

std::string sceneText(const schema::Scene& stored) {
  const schema::Vec3& min = stored.bounds()->min();
  const schema::Vec3& max = stored.bounds()->max();
  std::string text =
      fmt::format("  {} triangles, x {:.2f} to {:.2f}, y {:.2f} to {:.2f}, z {:.2f} to {:.2f} m\n",
                  stored.import_statistics()->triangles(), min.x(), max.x(), min.y(), max.y(),
                  min.z(), max.z());
  text +=
      fmt::format("  {:>8}{:>13}{:>11}{:>9}{:>9}{:>11}{:>11}{:>11}  {}\n", "radius m", "columns",
                  "spans", "max/col", "MB", "room m3", "outside", "enclosed", "sphere casts");
  for (const schema::ColumnGrid* grid : *stored.column_grids()) text += gridLine(*grid);
  return text;
}

std::string radiiText(const flatbuffers::Vector<float>& radii) {
  return fmt::format("  radii {} m\n",
                     fmt::join(std::vector<float>(radii.begin(), radii.end()), ", "));
}

std::string objectsText(const schema::ObjectSet& set) {
  std::string text = radiiText(*set.radii());
  text += fmt::format("  {:>20}{:>9}{:>8}{:>14}  {}\n", "box mm", "spheres", "poses",
                      "worst gap mm", "object");
  for (const schema::Object* object : *set.objects()) {
    const schema::Vec3& half = *object->box_half_extents();
    text += fmt::format(
        "  {:>20}{:>9}{:>8}{:>14.1f}  {}\n",
        fmt::format("{:.0f} x {:.0f} x {:.0f}", 2000 * half.x(), 2000 * half.y(), 2000 * half.z()),
        object->spheres()->size(), object->stable_poses()->size(),
        object->sphere_statistics()->gap()->max() / kMilli, clean(object->name()));
  }
  return text;
}

std::string robotText(const schema::Robot& robot) {
  std::size_t tested = 0;
  for (const schema::GroupPair* pair : *robot.group_pairs()) {
    if (pair->kind() == schema::PairKind::Tested) ++tested;
  }
  return radiiText(*robot.radii()) +
         fmt::format(
             "  {}, {}, {} of them controlled\n"
             "  {} in {} of links, {} of {} can collide\n"
             "  end effector: {}, camera: {}\n",
             counted(robot.links()->size(), "link"),
             counted(robot.limits()->size(), "joint position"), robot.controlled_joints()->size(),
             counted(robot.spheres()->size(), "sphere"), counted(robot.groups()->size(), "group"),
             tested, counted(robot.group_pairs()->size(), "pair"),
             robot.end_effector() == nullptr
                 ? std::string("none")
                 : clean(robot.link_names()->Get(robot.end_effector()->link())),
             robot.camera() == nullptr ? std::string("none")
                                       : clean(robot.link_names()->Get(robot.camera()->link())));
}

std::string episodesText(const schema::EpisodeSet& set) {
  std::vector<std::size_t> of_scene(set.scenes()->size());
  std::size_t fewest = set.placements()->size();
  std::size_t most = 0;
  for (const schema::Episode* episode : *set.episodes()) {
    if (episode->scene() < of_scene.size()) ++of_scene[episode->scene()];
    fewest = std::min<std::size_t>(fewest, episode->placement_count());
    most = std::max<std::size_t>(most, episode->placement_count());
  }
  std::vector<std::string> joints;
  joints.reserve(set.start_joints()->size());
  for (const flatbuffers::String* name : *set.start_joints()) joints.push_back(clean(name));
  std::string text = fmt::format(
      "  {}, {}, {} of them at a time\n"
      "  robot: {}, start joints: {}\n"
      "  {:>10}  scene\n",
      counted(set.scenes()->size(), "scene"), counted(set.objects()->size(), "object"),
      fewest == most ? fmt::format("{}", most) : fmt::format("{} to {}", fewest, most),
      set.robot()->size() == 0 ? "any" : clean(set.robot()),
      joints.empty() ? "none" : fmt::format("{}", fmt::join(joints, ", ")), "episodes");
  for (std::size_t n = 0; n < of_scene.size(); ++n) {
    text += fmt::format("  {:>10}  {}\n", of_scene[n],
                        clean(set.scenes()->Get(static_cast<flatbuffers::uoffset_t>(n))));
  }
  return text;
}

std::string worldText(const schema::World& world) {
  std::string text = fmt::format("  {:>6}{:>12}  pack\n", "kind", "MB");
  for (const schema::PackReference* one : *world.packs()) {
    text += fmt::format("  {:>6}{:>12.2f}  {}\n", clean(one->kind()),
                        static_cast<double>(one->bytes()) / kMega, clean(one->path()));
  }
  if (world.task() == nullptr) return text;
  std::string task;
  for (const schema::Option* one : *world.task()) {
    task +=
        fmt::format("{}{} {}", task.empty() ? "" : ", ", clean(one->name()), clean(one->value()));
  }
  return text + fmt::format("  task: {}\n", task);
}

std::string policyText(const schema::Policy& policy) {
  std::string parts;
  for (const schema::PolicyObservation* part : *policy.observation()) {
    parts += fmt::format("{}{} ({})", parts.empty() ? "" : ", ", clean(part->name()), part->size());
  }
  const schema::PolicyImage* image = policy.image();
  return fmt::format(
      "  {}, {} continuous and {} discrete actions, robot: {}\n"
      "  observation: {}\n"
      "  image: {}\n",
      counted(policy.layers()->size(), "layer"),
      policy.continuous() == nullptr ? 0 : policy.continuous()->count(), policy.discrete()->size(),
      policy.robot()->size() == 0 ? "any" : clean(policy.robot()), parts,
      image == nullptr ? std::string("none")
                       : fmt::format("{} x {}, camera {}", image->width(), image->height(),
                                     clean(image->camera())));
}

std::string textureText(const schema::SharedTexture& texture) {
  return fmt::format("  {} x {} texels ({}), {:.2f} MB with all levels\n", texture.size(),
                     texture.size(), schema::EnumNameTexelFormat(texture.format()),
                     static_cast<double>(texture.texels()->size()) / kMega);
}

/// What kind of asset it is, with its name where it has one, and its description.
std::pair<std::string, std::string> assetText(const schema::Pack& pack) {
  if (const schema::ObjectSet* set = pack.asset_as_ObjectSet()) {
    return {counted(set->objects()->size(), "object"), objectsText(*set)};
  }
  if (const schema::Robot* robot = pack.asset_as_Robot()) {
    return {fmt::format("robot \"{}\"", clean(robot->name())), robotText(*robot)};
  }
  if (const schema::Scene* scene = pack.asset_as_Scene()) {
    return {fmt::format("scene \"{}\"", clean(scene->name())), sceneText(*scene)};
  }
  if (const schema::EpisodeSet* set = pack.asset_as_EpisodeSet()) {
    return {
        fmt::format("{} \"{}\"", counted(set->episodes()->size(), "episode"), clean(set->name())),
        episodesText(*set)};
  }
  if (const schema::World* world = pack.asset_as_World()) {
    return {"world of " + counted(world->packs()->size(), "pack"), worldText(*world)};
  }
  if (const schema::Policy* policy = pack.asset_as_Policy()) {
    return {fmt::format("policy \"{}\"", clean(policy->name())), policyText(*policy)};
  }
  if (const schema::SharedTexture* texture = pack.asset_as_SharedTexture()) {
    return {fmt::format("texture \"{}\"", clean(texture->name())), textureText(*texture)};
  }
  return {"an asset of another kind than the header says", ""};
}

}  // namespace

std::string summarize(const PackFile& pack, const OpenTimes& times) {
  const schema::Provenance& provenance = *pack.root().provenance();
  const auto [title, content] = assetText(pack.root());
  std::string text = fmt::format("{}: {}, format {}, by {} {}\n", printable(pack.where()), title,
                                 pack.header().format_version, clean(provenance.tool()),
                                 clean(provenance.tool_version()));
  text += openingLine(pack, times);
  text += content;
  for (const flatbuffers::String* warning : *provenance.warnings()) {
    text += fmt::format("  warning: {}\n", clean(warning));
  }
  return text;
}

}  // namespace galactic
