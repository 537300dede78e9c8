#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/shapes.h"

namespace galactic {

/// One movable rigid body, in its own frame (Y up, meters): views into the pack.
struct ObjectModel {
  std::string_view name;
  /// What it is when it rests.
  OrientedBox box;
  /// What it is when it is held. Radius descending.
  std::span<const SetSphere> spheres;
  /// Likeliest first, at least one.
  std::span<const StablePose> stable_poses;
  /// Planes around its convex hull, which cut off corners and edges of the box. Empty where the
  /// hull fills the box, and in packs that are older than the field.
  std::span<const HullPlane> hull_planes{};
};

/// The objects of an object pack, ready to use.
class ObjectSet {
 public:
  /// The objects in `pack`, which must outlive the result. Fails with kInvalidInput on another kind
  /// of pack.
  [[nodiscard]] static Result<ObjectSet> from(const PackFile& pack);
  static Result<ObjectSet> from(const PackFile&& pack) = delete;

  /// The working set, meters, ascending: SetSphere::radius_index counts in it.
  [[nodiscard]] std::span<const float> radii() const { return radii_; }

  /// Ascending names.
  [[nodiscard]] const std::vector<ObjectModel>& objects() const { return objects_; }

  /// Index of the object of this name.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

 private:
  ObjectSet() = default;

  std::span<const float> radii_;
  std::vector<ObjectModel> objects_;
};

}  // namespace galactic
