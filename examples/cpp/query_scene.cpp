// Opens a scene pack and asks where a sphere may be, and what a ray meets. Usage: query_scene PACK
#include <array>
#include <cstdio>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/ray_caster.h"
#include "galactic/scene.h"

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: query_scene PACK\n");
    return galactic::kExitUsage;
  }
  // Maps the file, then checks its hash, its structure and every value in it.
  const auto pack = orThrow(galactic::PackFile::open(argv[1]));
  // A view into the pack, which has to outlive it.
  const auto scene = orThrow(galactic::Scene::from(pack));
  // Once, before the hot loop: which grid has spheres of 5 cm?
  const auto index = scene.gridIndex(0.05F);
  if (!index) {
    std::fprintf(stderr, "the pack has no grid of radius 0.05 m\n");
    return static_cast<int>(galactic::ErrorCode::kInvalidInput);
  }
  const galactic::ColumnGrid& grid = scene.grids()[*index];

  // One sphere. World frame: y up, meters.
  const galactic::Contact contact = grid.contact({-0.5F, 1.2F, -2.0F});
  if (contact.clearance == galactic::Clearance::kFree) {
    std::printf("free: %.3f m down and %.3f m up to contact\n", static_cast<double>(contact.down),
                static_cast<double>(contact.up));
  }

  // Many spheres at once: the fast way.
  const std::array<float, 3> x{-0.5F, -0.5F, 50.0F};
  const std::array<float, 3> y{1.2F, 0.0F, 1.2F};
  const std::array<float, 3> z{-2.0F, -2.0F, -2.0F};
  std::array<galactic::Clearance, 3> clearance{};
  grid.contact({.x = x, .y = y, .z = z}, {.clearance = clearance});
  for (const galactic::Clearance answer : clearance) {
    switch (answer) {
      case galactic::Clearance::kFree:
        std::printf("free\n");
        break;
      case galactic::Clearance::kBlocked:
        std::printf("blocked\n");
        break;
      case galactic::Clearance::kOutside:
        std::printf("outside the grid\n");
        break;
    }
  }

  // All free heights of a column: what galactic-pack column prints.
  if (const auto column = grid.columnAt(-0.5F, -2.0F)) {
    std::vector<galactic::Span> spans(grid.spanCount(column->i, column->k));
    grid.spans(column->i, column->k, spans);
    for (const galactic::Span& span : spans) {
      std::printf("free from %.3f to %.3f m\n", static_cast<double>(span.lo),
                  static_cast<double>(span.hi));
    }
  }

  // Rays, here a single one: how far do they get, and what do they come to?
  const galactic::RayCaster caster(scene);
  const std::array<galactic::Vec3, 1> origin{{{-0.5F, 1.2F, -2.0F}}};
  const std::array<galactic::Vec3, 1> direction{{{1, 0, 0}}};
  const std::array<float, 1> length{10};
  std::array<galactic::CastHit, 1> hit{};
  caster.castRays({origin, direction, length}, hit);
  if (hit[0].end == galactic::CastEnd::kScene) {
    std::printf("something is %.3f m along X\n", static_cast<double>(hit[0].distance));
  }
  return galactic::kExitOk;
} catch (const galactic::ErrorException& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return static_cast<int>(failure.error().code);
}
