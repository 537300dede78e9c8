#pragma once
#include <string>
#include <vector>

#include "pack_tool/pack_diff.h"

namespace galactic::pack_tool {

/// Everything in which two scene packs differ.
struct PackDifference {
  std::string a;
  std::string b;
  /// All bytes are the same.
  bool identical = false;
  /// Provenance and the statistics of import and bake; empty when not compared.
  std::vector<FieldDifference> provenance;
  /// Name, bounds and the grids' coverage.
  std::vector<FieldDifference> content;
  /// Radii of grids that only one side has.
  std::vector<float> radii_only_in_a;
  std::vector<float> radii_only_in_b;
  /// One per radius that both sides have.
  std::vector<GridDifference> grids;

  [[nodiscard]] bool differs() const;
};

/// The difference as text for people.
[[nodiscard]] std::string diffText(const PackDifference& difference);

/// The difference as JSON; pack_tool/README.md describes it.
[[nodiscard]] Json diffJson(const PackDifference& difference);

}  // namespace galactic::pack_tool
