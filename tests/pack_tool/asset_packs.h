#pragma once
#include <optional>
#include <string>
#include <vector>

#include "galactic/pack.h"
#include "galactic/pose.h"
#include "galactic/shapes.h"
#include "support/aligned_bytes.h"
#include "support/packs/render_pack_builder.h"

namespace galactic::test {

/// One object of a small pack; a test changes what it wants to differ.
struct ToyObject {
  std::string name = "block";
  /// Of an axis-aligned block around the object's origin, meters.
  Vec3 half{0.05F, 0.1F, 0.03F};
  std::vector<SetSphere> spheres{{{0, 0.02F, 0}, 1}, {{0, -0.06F, 0}, 0}};
  bool colored = false;
  double gap = 0.012;
};

struct ToyObjects {
  std::vector<ToyObject> objects{{}, {.name = "die", .half = {0.01F, 0.01F, 0.01F}}};
  std::string tool_version = "0.1.0";
  RenderMeshesField render_meshes = {};
};

/// A robot of five links: base -> upper (revolute) -> slide (prismatic, no limits) -> finger
/// (mimics upper), and a fixed head on the base.
struct ToyRobot {
  std::string name = "arm";
  float upper_limit = 2;
  /// base_from_upper where the joint is at 0.
  Quat upper_rotation{0.5F, 0.5F, 0.5F, 0.5F};
  std::vector<SetSphere> base_spheres{{{0, 0.2F, 0}, 1}, {{0.125F, 0.5F, -0.25F}, 0}};
  bool with_recipe = true;
  RenderMeshesField render_meshes = {};
};

/// The whole file: header and payload.
[[nodiscard]] AlignedBytes buildPack(const ToyObjects& toys);
[[nodiscard]] AlignedBytes buildPack(const ToyRobot& toy);

/// A pack in memory and the bytes that it looks into.
class ToyPack {
 public:
  explicit ToyPack(const ToyObjects& toys);
  explicit ToyPack(const ToyRobot& toy);

  [[nodiscard]] const PackFile& operator*() const { return *pack_; }

 private:
  /// Fails the test where they are no pack.
  explicit ToyPack(AlignedBytes bytes);

  AlignedBytes bytes_;
  std::optional<PackFile> pack_;
};

}  // namespace galactic::test
