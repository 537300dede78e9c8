#include "check/common_check.h"

#include <algorithm>
#include <tuple>

#include "check/offence.h"
#include "galactic/scene.h"

namespace galactic::detail {
namespace {

/// Spheres are ordered by descending radius, then by ascending x, y, z.
auto sphereKey(const schema::SetSphere& sphere) {
  const schema::Vec3& center = sphere.center();
  return std::tuple(~sphere.radius_index(), center.x(), center.y(), center.z());
}

Result<void> checkLengths(const schema::LengthStatistics* lengths, const std::string& where) {
  Offence offence(where);
  offence.require(lengths != nullptr, "mean", "is missing, expected the lengths measured");
  if (offence.found()) return offence.result();
  offence.require(isAmount(lengths->mean()), "mean",
                  "is {} m, expected a finite length of 0 or more", lengths->mean());
  offence.require(isAmount(lengths->max()), "max", "is {} m, expected a finite length of 0 or more",
                  lengths->max());
  offence.require(lengths->p95() >= 0 && lengths->p95() <= lengths->max(), "p95",
                  "is {} m, expected 0 to the maximum of {} m", lengths->p95(), lengths->max());
  return offence.result();
}

}  // namespace

Result<void> checkBounds(const schema::Bounds* bounds, const std::string& where) {
  Offence offence(where);
  offence.require(bounds != nullptr, "bounds", "are missing, expected the mesh's bounds");
  if (offence.found()) return offence.result();
  const schema::Vec3& min = bounds->min();
  const schema::Vec3& max = bounds->max();
  offence.require(isPlace(min) && isPlace(max), "bounds",
                  "reach farther than {} m or are not finite, expected coordinates", kFarthest);
  offence.require(min.x() <= max.x() && min.y() <= max.y() && min.z() <= max.z(), "bounds",
                  "have a minimum ({}, {}, {}) above the maximum ({}, {}, {})", min.x(), min.y(),
                  min.z(), max.x(), max.y(), max.z());
  return offence.result();
}

Result<void> checkImport(const schema::ImportStatistics& counts, const std::string& where) {
  Offence offence(where + ".import_statistics");
  offence.require(!isEmpty(counts.format()), "format", "is empty, expected a format's name");
  // Subtract one by one: a sum of hostile counts could wrap around.
  const bool plausible =
      counts.triangles_degenerate() <= counts.triangles_read() &&
      counts.triangles_duplicate() <= counts.triangles_read() - counts.triangles_degenerate();
  offence.require(plausible, "triangles_read",
                  "is {}, expected at least the {} degenerate and {} duplicate triangles dropped",
                  counts.triangles_read(), counts.triangles_degenerate(),
                  counts.triangles_duplicate());
  const std::uint64_t remaining =
      counts.triangles_read() - counts.triangles_degenerate() - counts.triangles_duplicate();
  offence.require(counts.triangles() == remaining, "triangles",
                  "is {}, expected the {} that remain of those read", counts.triangles(),
                  remaining);
  return offence.result();
}

Result<void> checkRadii(const flatbuffers::Vector<float>& radii, const std::string& where) {
  Offence offence(where);
  offence.require(radii.size() >= 1 && radii.size() <= kMostRadii, "radii",
                  "has {} elements, expected 1 to {}", radii.size(), kMostRadii);
  float previous = 0;
  for (flatbuffers::uoffset_t n = 0; n < radii.size() && !offence.found(); ++n) {
    const float radius = radii.Get(n);
    offence.require(isLength(radius) && radius > previous, fmt::format("radii[{}]", n),
                    "is {} m after {} m, expected ascending radii of up to {} m", radius, previous,
                    kFarthest);
    previous = radius;
  }
  return offence.result();
}

Result<void> checkSpheres(const flatbuffers::Vector<const schema::SetSphere*>& spheres,
                          const SphereRange& range, std::size_t radii, const std::string& where) {
  Offence offence(where);
  for (std::size_t n = range.begin; n < range.end && !offence.found(); ++n) {
    const schema::SetSphere& sphere = *spheres.Get(static_cast<flatbuffers::uoffset_t>(n));
    const std::string field = fmt::format("spheres[{}]", n);
    offence.require(isPlace(sphere.center()), field + ".center",
                    "is farther than {} m or not finite, expected coordinates", kFarthest);
    offence.require(sphere.radius_index() < radii, field + ".radius_index",
                    "is {}, expected less than the number of radii {}", sphere.radius_index(),
                    radii);
    if (n == range.begin || offence.found()) continue;
    const schema::SetSphere& before = *spheres.Get(static_cast<flatbuffers::uoffset_t>(n - 1));
    offence.require(
        sphereKey(before) <= sphereKey(sphere), field,
        "comes before its predecessor, expected descending radii, then ascending centers");
  }
  return offence.result();
}

Result<void> checkSphereStatistics(const schema::SphereSetStatistics& statistics,
                                   const std::string& where) {
  constexpr const char* kWanted = "is {}, expected a finite number of 0 or more";
  Offence offence(where);
  offence.require(isAmount(static_cast<double>(statistics.eps())), "eps", kWanted,
                  statistics.eps());
  offence.require(isAmount(static_cast<double>(statistics.tau())), "tau", kWanted,
                  statistics.tau());
  offence.require(checkLengths(statistics.gap(), where + ".gap"));
  offence.require(checkLengths(statistics.protrusion(), where + ".protrusion"));
  offence.require(isAmount(statistics.volume_ratio()), "volume_ratio", kWanted,
                  statistics.volume_ratio());
  offence.require(isAmount(statistics.guaranteed_gap()), "guaranteed_gap", kWanted,
                  statistics.guaranteed_gap());
  offence.require(isAmount(statistics.guaranteed_protrusion()), "guaranteed_protrusion", kWanted,
                  statistics.guaranteed_protrusion());
  return offence.result();
}

Result<void> checkSurface(const schema::Surface& surface, const std::string& where) {
  const auto& positions = *surface.positions();
  const auto& corners = *surface.triangles();
  Offence offence(where);
  // Format messages only for the first offender: surfaces are the bulk of a pack.
  const auto broken = std::find_if(positions.begin(), positions.end(),
                                   [](const schema::Vec3* p) { return !isPlace(*p); });
  offence.require(broken == positions.end(),
                  fmt::format("positions[{}]", std::distance(positions.begin(), broken)),
                  "is farther than {} m or not finite, expected coordinates", kFarthest);
  offence.require(corners.size() % 3 == 0, "triangles",
                  "has {} elements, expected three per triangle", corners.size());
  const auto beyond = std::find_if(corners.begin(), corners.end(),
                                   [&](std::uint32_t n) { return n >= positions.size(); });
  offence.require(beyond == corners.end(),
                  fmt::format("triangles[{}]", std::distance(corners.begin(), beyond)),
                  "is not the index of one of the {} positions", positions.size());
  offence.require(surface.colors()->size() == 0 || surface.colors()->size() == positions.size(),
                  "colors", "has {} elements, expected none or {}, one per position",
                  surface.colors()->size(), positions.size());
  return offence.result();
}

}  // namespace galactic::detail
