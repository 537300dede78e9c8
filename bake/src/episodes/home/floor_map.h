#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/robot.h"
#include "galactic/scene.h"

namespace galactic::bake {

/// Number of headings in which the base is tried at each place, evenly spaced; heading n is a yaw
/// of n * 2 pi / kHeadings.
inline constexpr std::uint32_t kHeadings = 16;

/// A place on the floor under the center of a column of the largest radius.
struct FloorPlace {
  std::uint32_t i = 0;
  std::uint32_t k = 0;
  /// Meters.
  float height = 0;
  /// Bit n: in heading n the robot is free in its start pose, and can drive here from anywhere else
  /// in the same part of the map.
  std::uint16_t headings = 0;
  /// Number of the part; 0 is the largest.
  std::uint32_t part = 0;
};

/// Where the robot can stand and drive: the large connected parts of the floor, such as storeys.
/// The robot cannot drive from one part to another.
class FloorMap {
 public:
  /// Takes the floor from the columns of the largest radius and tests all spheres of the robot in
  /// its start pose against the scene. In each heading, places in neighboring columns are connected
  /// if their heights differ by no more than the run's GroundOptions allow; at each place, adjacent
  /// headings are connected. Empty if the robot can stand nowhere.
  FloorMap(const Scene& scene, const Robot& robot);

  /// Row by row, the lower place of a column first; each has at least one heading. A place whose
  /// headings belong to several parts occurs once for each part.
  [[nodiscard]] const std::vector<FloorPlace>& places() const { return places_; }
  /// Number of places with a floor at which the robot was tried.
  [[nodiscard]] std::size_t tried() const { return tried_; }
  /// Number of parts that the robot can drive in.
  [[nodiscard]] std::size_t parts() const { return parts_; }

  /// Point on the floor at the center of the place's column, meters.
  [[nodiscard]] Vec3 position(const FloorPlace& place) const;
  /// Edge of a column's cell, meters.
  [[nodiscard]] float spacing() const { return grid_.spacing(); }

  /// The height of the floor directly under (x, z), meters: of the floors in the column of the
  /// smallest radius there that are within a step of `height`, the nearest. None if there is no
  /// such floor.
  [[nodiscard]] std::optional<float> heightAt(float x, float z, float height) const;

  /// The places of the column that contains (x, z); empty outside the grid.
  [[nodiscard]] std::span<const FloorPlace> placesAt(float x, float z) const;

 private:
  void addPlaces(std::uint32_t i, std::uint32_t k);
  [[nodiscard]] std::optional<float> floorUnder(const Vec3& free_center) const;
  void indexColumns();
  void keepLargeParts();

  ColumnGrid grid_;
  /// The grid of the smallest radius.
  ColumnGrid fine_grid_;
  std::vector<FloorPlace> places_;
  /// Index of each column's first place, then the number of places.
  std::vector<std::uint32_t> first_;
  std::size_t tried_ = 0;
  std::size_t parts_ = 0;
};

/// The heading that is nearest to a yaw in radians.
[[nodiscard]] std::uint32_t nearestHeading(float yaw);
/// Radians.
[[nodiscard]] float yawOf(std::uint32_t heading);

}  // namespace galactic::bake
