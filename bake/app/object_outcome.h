#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bake_run.h"
#include "galactic/bake/object_baker.h"

namespace galactic::bake {

/// What became of one object.
struct ObjectOutcome {
  std::filesystem::path input;
  double import_seconds = 0;
};

/// What became of an object pack: one outcome per object of the set.
struct ObjectSetOutcome {
  std::filesystem::path output;
  std::vector<float> radii;
  /// Of the collection.
  std::vector<std::string> warnings;
  /// Size of the pack; 0 for a dry run.
  std::uint64_t pack_bytes = 0;
  double seconds = 0;
};

/// A line per object: triangles, box, spheres per radius, gap, protrusion, seconds.
void printObjectTable(const ObjectSetOutcome& outcome, const std::vector<BakedObject>& objects,
                      Verbosity verbosity);

/// The object's entry of the report.
[[nodiscard]] Json objectReport(const BakedObject& object, const ObjectOutcome& outcome,
                                const ObjectSetOutcome& set);

/// Spheres of each radius, largest radius first, as "2+5+0".
[[nodiscard]] std::string sphereCounts(const std::vector<SetSphere>& spheres, std::size_t radii);

/// A length's mean, 95th percentile and maximum in millimetres.
[[nodiscard]] std::string millimetres(const LengthStatistics& lengths);

/// The figures of a sphere set for a report.
[[nodiscard]] Json sphereSetReport(const SphereSet& set, std::size_t radii);

}  // namespace galactic::bake
