#pragma once
#include <string>
#include <vector>

#include "galactic/object_set.h"
#include "galactic/pack.h"
#include "galactic/robot.h"
#include "pack_tool/figure/figure.h"
#include "pack_tool/figure/joint_positions.h"

namespace galactic::pack_tool {

/// What of a figure is shown.
enum class FigureLayer : unsigned { kMesh = 1, kSpheres = 2, kBoxes = 4 };

/// A choice of layers.
class LayerSet {
 public:
  static constexpr LayerSet all() { return LayerSet(7); }
  static constexpr LayerSet none() { return LayerSet(0); }

  friend constexpr bool operator==(LayerSet, LayerSet) = default;

  constexpr void add(FigureLayer layer) { bits_ |= static_cast<unsigned>(layer); }
  [[nodiscard]] constexpr bool has(FigureLayer layer) const {
    return (bits_ & static_cast<unsigned>(layer)) != 0;
  }

 private:
  explicit constexpr LayerSet(unsigned bits) : bits_(bits) {}

  unsigned bits_;
};

/// Which figures of a pack are wanted, and how.
struct FigureOptions {
  /// Only the object of this name; empty: all.
  std::string object = {};
  /// Of a robot.
  JointChoice joints = {};
  LayerSet layers = LayerSet::all();
};

/// The objects of a set, each in its own frame, by ascending name; the robot in a pose, its root
/// above the ground as its base says: visual surfaces, where a link has none that of collisions; or
/// the scene, which has render meshes only. The result looks into `pack`. Fails with kInvalidInput
/// on another kind of pack, on a scene without render meshes, on an object or joint that is not
/// there, and on options that are not for this kind.
[[nodiscard]] Result<std::vector<Figure>> figuresOf(const PackFile& pack,
                                                    const FigureOptions& options);

/// The counts of `spheres` by radius, largest first, as "1+4+2".
[[nodiscard]] std::string sphereCounts(std::span<const SetSphere> spheres, std::size_t radii);

/// Puts objects in a row along X, on the ground, a tenth of their mean width apart.
void layOutInARow(std::vector<Figure>& figures);

}  // namespace galactic::pack_tool
