#pragma once
#include <string>
#include <vector>

#include "pack_tool/diff/grid_diff.h"

namespace galactic::pack_tool {

/// Everything in which two packs of one kind differ.
struct PackDifference {
  std::string a;
  std::string b;
  /// All bytes are the same.
  bool identical = false;
  /// Provenance, the statistics of import and bake, and meshes for pictures; empty when not
  /// compared.
  std::vector<FieldDifference> provenance;
  /// What the runtime reads, but for grids.
  std::vector<FieldDifference> content;
  // Of scenes: radii of grids that only one side has, and one difference per radius that both have.
  std::vector<float> radii_only_in_a;
  std::vector<float> radii_only_in_b;
  std::vector<GridDifference> grids;

  [[nodiscard]] bool differs() const;
};

/// The difference as text for people.
[[nodiscard]] std::string diffText(const PackDifference& difference);

/// The difference as JSON; pack_tool/README.md describes it.
[[nodiscard]] Json diffJson(const PackDifference& difference);

}  // namespace galactic::pack_tool
