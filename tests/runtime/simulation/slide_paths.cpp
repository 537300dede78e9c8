// Draws how carts slide along walls, into corners, through doorways and around tables, rule by
// rule:
//
//   slide_paths OUT.svg
//
// One column for each place, one row for each rule: none, the published one, the default. Each cart
// drives straight ahead; a line is its path, a dot a step that left it where it was.
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "support/homes/box_world.h"

namespace {

using galactic::BatchSimulator;
using galactic::SimulationOptions;
using galactic::SlideDirection;
using galactic::Vec3;
using galactic::test::Block;
using galactic::test::BoxRoom;
using galactic::test::BoxWorld;
using galactic::test::Start;

constexpr float kRadiansPerDegree = std::numbers::pi_v<float> / 180;
constexpr int kSteps = 45;
constexpr float kSpeed = 0.6F;
/// Pixels for each meter, and between pictures.
constexpr float kScale = 90;
constexpr float kGap = 30;

struct Place {
  std::string name;
  std::vector<Block> blocks{};
  std::vector<Start> starts{};
  /// Whether the carts reach ahead while they drive.
  bool reaches = false;
};

Start startAt(float x, float z, float degrees) {
  // Its object is out of the way.
  return {.base = {x, 0, z}, .yaw = degrees * kRadiansPerDegree, .objects = {{0.1F, 2.5F, 0.1F}}};
}

std::vector<Place> places() {
  const Block far_wall{{0, 0, 0}, {3, 1, 0.1F}};
  Place wall{.name = "wall", .blocks = {far_wall}};
  for (const float degrees : {10.0F, 30.0F, 60.0F, 85.0F}) {
    wall.starts.push_back(startAt(0.3F, 0.5F + degrees / 60, degrees));
  }
  Place corner{.name = "corner", .blocks = {far_wall, {{2.9F, 0, 0}, {3, 1, 3}}}};
  for (const float degrees : {20.0F, 45.0F, 70.0F}) {
    corner.starts.push_back(startAt(1, 0.9F + degrees / 60, degrees));
  }
  Place doorway{.name = "doorway",
                .blocks = {{{1.5F, 0, 0}, {1.6F, 1, 1.3F}}, {{1.5F, 0, 1.7F}, {1.6F, 1, 3}}}};
  for (const float z : {1.25F, 1.4F, 1.5F, 1.6F, 1.75F}) {
    doorway.starts.push_back(startAt(0.4F, z, 0));
  }
  Place table{.name = "table", .blocks = {{{1.2F, 0.27F, 1}, {2.2F, 0.33F, 2}}}, .reaches = true};
  for (const float z : {0.95F, 1.2F, 1.5F, 1.8F, 2.05F})
    table.starts.push_back(startAt(0.3F, z, 0));
  return {wall, corner, doorway, table};
}

struct Rule {
  std::string name;
  galactic::SlideOptions slide{};
};

std::vector<Rule> rules() {
  return {{"no sliding", {.attempts = 0}},
          {"published: five pushes of 5 cm",
           {.attempts = 5, .direction = SlideDirection::kTowardsBase, .step = 0.05F}},
          {"glide", {}}};
}

std::string point(float x, float z) {
  return std::to_string(x * kScale) + "," + std::to_string(z * kScale) + " ";
}

std::string drawPaths(const Place& place, const Rule& rule) {
  std::vector<Block> blocks = place.blocks;
  blocks.push_back(galactic::test::plainFloor());
  const BoxWorld world(blocks, place.starts);
  SimulationOptions options;
  options.envs = static_cast<std::uint32_t>(place.starts.size());
  options.order = galactic::EpisodeOrder::kLinear;
  options.task.kind = galactic::TaskKind::kNone;
  options.task.most_steps = 0;
  options.slide = rule.slide;
  BatchSimulator simulator = BatchSimulator::create(world.world(), options).value();
  std::vector<float> actions(options.envs * galactic::test::kCartActions);
  for (std::size_t env = 0; env < options.envs; ++env) {
    float* row = actions.data() + env * galactic::test::kCartActions;
    row[0] = place.reaches ? 0.4F : 0;
    row[galactic::test::kCartJoints] = kSpeed;
  }
  std::vector<std::string> paths(options.envs);
  std::string dots;
  std::vector<std::uint64_t> refused(options.envs);
  for (int step = 0; step <= kSteps; ++step) {
    for (std::size_t env = 0; env < options.envs; ++env) {
      const Vec3 at = simulator.envState(env).world_from_root.translation;
      paths[env] += point(at.x, at.z);
      const std::uint64_t now = simulator.statistics(env).refused;
      if (now != refused[env]) {
        dots += "<circle cx='" + std::to_string(at.x * kScale) + "' cy='" +
                std::to_string(at.z * kScale) + "' r='3' fill='#c22'/>";
      }
      refused[env] = now;
    }
    simulator.step(actions);
  }
  std::string drawn;
  for (const std::string& path : paths) {
    drawn += "<polyline points='" + path + "' fill='none' stroke='#26c' stroke-width='1.5'/>\n";
  }
  return drawn + dots;
}

std::string drawPlace(const Place& place, const Rule& rule) {
  const float size = BoxRoom::kSize * kScale;
  std::string drawn = "<rect width='" + std::to_string(size) + "' height='" + std::to_string(size) +
                      "' fill='#f6f6f6'/>\n";
  for (const Block& block : place.blocks) {
    drawn += "<rect x='" + std::to_string(block.min.x * kScale) + "' y='" +
             std::to_string(block.min.z * kScale) + "' width='" +
             std::to_string((block.max.x - block.min.x) * kScale) + "' height='" +
             std::to_string((block.max.z - block.min.z) * kScale) + "' fill='#999'/>\n";
  }
  return drawn + drawPaths(place, rule) + "<text y='-5'>" + place.name + ", " + rule.name +
         "</text>\n";
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "slide_paths OUT.svg\n");
    return 1;
  }
  const float cell = BoxRoom::kSize * kScale + kGap;
  const std::vector<Place> all = places();
  std::ofstream out(arguments[1]);
  out << "<svg xmlns='http://www.w3.org/2000/svg' width='" << cell * static_cast<float>(all.size())
      << "' height='" << cell * static_cast<float>(rules().size())
      << "' font-family='sans-serif' font-size='12'>\n";
  float y = kGap;
  for (const Rule& rule : rules()) {
    float x = kGap / 2;
    for (const Place& place : all) {
      out << "<g transform='translate(" << x << "," << y << ")'>" << drawPlace(place, rule)
          << "</g>\n";
      x += cell;
    }
    y += cell;
  }
  out << "</svg>\n";
  return out.flush() ? 0 : 2;
}
